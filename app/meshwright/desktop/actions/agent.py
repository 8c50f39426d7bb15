"""Actions of the menu Agent: hints, runs and searches."""

from __future__ import annotations

from functools import partial

from meshwright.assistant.assistant import State
from meshwright.desktop.actions.action import Action, can_run, needing
from meshwright.desktop.actions.context import ActionContext

HINTS = 5
"""Hints that can be applied by a number key."""


@needing("Needs a mesh and a policy that is ready: see the panel Agent.")
def _can_hint(context: ActionContext) -> bool:
    return can_run(context) and context.assistant.state not in (State.SEARCHING, State.GOING)


@needing("Nothing is on the way to a result.")
def _is_going(context: ActionContext) -> bool:
    return context.assistant.state is State.GOING


def _has_region(context: ActionContext) -> bool:
    return can_run(context) and len(context.document.selection.elements) > 0


def _is_busy(context: ActionContext) -> bool:
    """A run is under way or paused, or hints are shown."""
    return context.agent.busy


def _has_hint(index: int, context: ActionContext) -> bool:
    return index < len(context.hints.shown)


def _take(index: int, context: ActionContext) -> None:
    context.hints.take(index)


ACTIONS: tuple[Action, ...] = (
    Action(
        "agent.hint",
        "Hint",
        "Show or hide the policy's most probable operations",
        run=lambda context: context.hints.ask_or_hide(),
        shortcuts=("H",),
        enabled=_can_hint,
        menu="Agent",
        repeats=False,
    ),
    Action(
        "agent.step",
        "Step",
        "Apply one operation of the policy",
        run=lambda context: context.assistant.step(),
        shortcuts=(".",),
        enabled=can_run,
        menu="Agent",
    ),
    Action(
        "agent.play",
        "Play or pause",
        "Run the policy at the chosen speed, or pause it",
        run=lambda context: context.agent.play_or_pause(),
        shortcuts=("Space",),
        enabled=can_run,
        menu="Agent",
        repeats=False,
    ),
    Action(
        "agent.complete",
        "Complete",
        "Search until the optimum and a good shape are reached, and apply the best result",
        run=lambda context: context.agent.complete(),
        shortcuts=("Ctrl+Return",),
        enabled=can_run,
        menu="Agent",
    ),
    Action(
        "agent.skip",
        "Skip",
        "Go to the result of a search at once; its operations are in the history",
        run=lambda context: context.assistant.skip(),
        enabled=_is_going,
        menu="Agent",
    ),
    Action(
        "agent.best_of",
        "Best of several runs",
        "Run the policy as often as set in the panel, and apply the best result",
        run=lambda context: context.agent.best_of(),
        shortcuts=("Ctrl+B",),
        enabled=can_run,
        menu="Agent",
    ),
    Action(
        "agent.search",
        "Search",
        "Search for the optimum, then for fewer elements and operations; the panel sets the time",
        run=lambda context: context.agent.search(),
        shortcuts=("Ctrl+Shift+Return",),
        enabled=can_run,
        menu="Agent",
    ),
    Action(
        "agent.region",
        "Finish only this region",
        "Search within the selected region; nothing outside it changes",
        run=lambda context: context.agent.finish_region(),
        shortcuts=("Ctrl+R",),
        enabled=_has_region,
        menu="Agent",
        needs="Needs a selected region: select vertices with Shift+drag.",
    ),
    Action(
        "agent.watch",
        "Show what the policy sees",
        "Show the policy's template, field of view and probabilities",
        run=lambda context: context.agent.toggle_watch(),
        shortcuts=("W",),
        enabled=can_run,
        menu="Agent",
        checked=lambda context: context.assistant.watch,
    ),
    Action(
        "agent.policy",
        "Load policy file\u2026",
        "Use a policy from a file that training has written",
        run=lambda context: context.agent.choose_policy(),
        menu="Agent",
    ),
    Action(
        "agent.stop",
        "Stop",
        "Stop, and keep what was done; a search applies its best result so far",
        run=lambda context: context.agent.stop(),
        shortcuts=("Esc",),
        enabled=_is_busy,
        menu="Agent",
        needs="Nothing is running.",
    ),
    *(
        Action(
            f"agent.take_{index + 1}",
            f"Apply hint {index + 1}",
            f"Apply the operation of hint {index + 1}",
            run=partial(_take, index),
            shortcuts=(str(index + 1),),
            enabled=partial(_has_hint, index),
            menu="Agent",
            repeats=False,
            needs="No hints are shown: press H to show them.",
        )
        for index in range(HINTS)
    ),
)
