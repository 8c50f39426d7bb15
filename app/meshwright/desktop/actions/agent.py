"""What the agent does beside the person."""

from __future__ import annotations

from functools import partial

from meshwright.assistant.assistant import State
from meshwright.assistant.search_runner import COMPLETE_SECONDS
from meshwright.desktop.actions.action import Action, can_run, needing
from meshwright.desktop.actions.context import ActionContext

HINTS = 5
"""Hints that have a key of their own."""


@needing("Needs a mesh, and an agent that is ready.")
def _can_hint(context: ActionContext) -> bool:
    return can_run(context) and context.assistant.state is not State.SEARCHING


def _has_region(context: ActionContext) -> bool:
    return can_run(context) and len(context.document.selection.elements) > 0


def _is_busy(context: ActionContext) -> bool:
    """Something is under way that can be ended."""
    return context.agent.busy


def _has_hint(index: int, context: ActionContext) -> bool:
    return index < len(context.hints.shown)


def _take(index: int, context: ActionContext) -> None:
    context.hints.take(index)


ACTIONS: tuple[Action, ...] = (
    Action(
        "agent.hint",
        "Hint",
        "Show the policy's best few operations, with their probabilities; again to hide them",
        run=lambda context: context.hints.ask_or_hide(),
        shortcuts=("H",),
        enabled=_can_hint,
        menu="Agent",
        repeats=False,
    ),
    Action(
        "agent.step",
        "Step",
        "Let the policy take one operation",
        run=lambda context: context.assistant.step(),
        shortcuts=(".",),
        enabled=can_run,
        menu="Agent",
    ),
    Action(
        "agent.play",
        "Play or pause",
        "Let the policy go on at the chosen speed, or hold it",
        run=lambda context: context.agent.play_or_pause(),
        shortcuts=("Space",),
        enabled=can_run,
        menu="Agent",
        repeats=False,
    ),
    Action(
        "agent.complete",
        "Complete",
        f"Search for up to {COMPLETE_SECONDS:g} seconds, and go to the best state found",
        run=lambda context: context.assistant.search(),
        shortcuts=("Ctrl+Return",),
        enabled=can_run,
        menu="Agent",
    ),
    Action(
        "agent.best_of",
        "Best of several runs",
        "Run the policy as often as the panel says, and go to the best state found",
        run=lambda context: context.agent.best_of(),
        shortcuts=("Ctrl+B",),
        enabled=can_run,
        menu="Agent",
    ),
    Action(
        "agent.search",
        "Search",
        "Search as long as the panel says for the optimum, then for fewer elements and operations",
        run=lambda context: context.agent.search(),
        shortcuts=("Ctrl+Shift+Return",),
        enabled=can_run,
        menu="Agent",
    ),
    Action(
        "agent.region",
        "Finish only this region",
        "Search among the elements whose corners are all selected; nothing outside changes",
        run=lambda context: context.agent.finish_region(),
        shortcuts=("Ctrl+R",),
        enabled=_has_region,
        menu="Agent",
        needs="Needs a region: select vertices with Shift and a drag.",
    ),
    Action(
        "agent.watch",
        "Show what the policy sees",
        "Show its template, its field of view and its probabilities, also while it runs",
        run=lambda context: context.agent.toggle_watch(),
        shortcuts=("W",),
        enabled=can_run,
        menu="Agent",
        checked=lambda context: context.assistant.watch,
    ),
    Action(
        "agent.policy",
        "Choose policy file\u2026",
        "Follow a policy of your own, from a file that training has written",
        run=lambda context: context.agent.choose_policy(),
        menu="Agent",
    ),
    Action(
        "agent.stop",
        "Stop",
        "Stop the policy; what it has done stays. A search still goes to the best it has found",
        run=lambda context: context.agent.stop(),
        shortcuts=("Esc",),
        enabled=_is_busy,
        menu="Agent",
        needs="Nothing is running.",
    ),
    *(
        Action(
            f"agent.take_{index + 1}",
            f"Take hint {index + 1}",
            f"Do what hint {index + 1} says",
            run=partial(_take, index),
            shortcuts=(str(index + 1),),
            enabled=partial(_has_hint, index),
            menu="Agent",
            repeats=False,
            needs="Needs a hint: ask for some with H.",
        )
        for index in range(HINTS)
    ),
)
