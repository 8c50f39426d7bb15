"""What the agent does beside the person."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from meshwright.assistant.assistant import State
from meshwright.assistant.search_runner import COMPLETE_SECONDS
from meshwright.desktop.actions.action import Action, can_run, needing

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow

HINTS = 5
"""Hints that have a key of their own."""


@needing("Needs a mesh, and an agent that is ready.")
def _can_hint(window: MainWindow) -> bool:
    return can_run(window) and window.assistant.state is not State.SEARCHING


def _has_region(window: MainWindow) -> bool:
    return can_run(window) and len(window.document.selection.elements) > 0


def _is_busy(window: MainWindow) -> bool:
    """Something is under way that can be ended."""
    return window.agent.busy


def _has_hint(index: int, window: MainWindow) -> bool:
    return index < len(window.agent.hints.shown)


def _take(index: int, window: MainWindow) -> None:
    window.agent.hints.take(index)


ACTIONS: tuple[Action, ...] = (
    Action(
        "agent.hint",
        "Hint",
        "Show the policy's best few operations, with their probabilities; again to hide them",
        lambda window: window.agent.hints.ask_or_hide(),
        ("H",),
        _can_hint,
        menu="Agent",
        repeats=False,
    ),
    Action(
        "agent.step",
        "Step",
        "Let the policy take one operation",
        lambda window: window.assistant.step(),
        (".",),
        can_run,
        menu="Agent",
    ),
    Action(
        "agent.play",
        "Play or pause",
        "Let the policy go on at the chosen speed, or hold it",
        lambda window: window.agent.play_or_pause(),
        ("Space",),
        can_run,
        menu="Agent",
        repeats=False,
    ),
    Action(
        "agent.complete",
        "Complete",
        f"Search for up to {COMPLETE_SECONDS:g} seconds, and go to the best state found",
        lambda window: window.assistant.search(),
        ("Ctrl+Return",),
        can_run,
        menu="Agent",
    ),
    Action(
        "agent.best_of",
        "Best of several runs",
        "Run the policy as often as the panel says, and go to the best state found",
        lambda window: window.agent.best_of(),
        ("Ctrl+B",),
        can_run,
        menu="Agent",
    ),
    Action(
        "agent.search",
        "Search",
        "Search as long as the panel says for the optimum, then for fewer elements and operations",
        lambda window: window.agent.search(),
        ("Ctrl+Shift+Return",),
        can_run,
        menu="Agent",
    ),
    Action(
        "agent.region",
        "Finish only this region",
        "Search among the elements whose corners are all selected; nothing outside changes",
        lambda window: window.agent.finish_region(),
        ("Ctrl+R",),
        _has_region,
        menu="Agent",
        needs="Needs a region: select vertices with Shift and a drag.",
    ),
    Action(
        "agent.watch",
        "Show what the policy sees",
        "Show its template, its field of view and its probabilities, also while it runs",
        lambda window: window.agent.toggle_watch(),
        ("W",),
        can_run,
        menu="Agent",
        checked=lambda window: window.assistant.watch,
    ),
    Action(
        "agent.policy",
        "Choose policy file\u2026",
        "Follow a policy of your own, from a file that training has written",
        lambda window: window.agent.choose_policy(),
        menu="Agent",
    ),
    Action(
        "agent.stop",
        "Stop",
        "Stop the policy; what it has done stays. A search still goes to the best it has found",
        lambda window: window.agent.stop(),
        ("Esc",),
        _is_busy,
        menu="Agent",
        needs="Nothing is running.",
    ),
    *(
        Action(
            f"agent.take_{index + 1}",
            f"Take hint {index + 1}",
            f"Do what hint {index + 1} says",
            partial(_take, index),
            (str(index + 1),),
            partial(_has_hint, index),
            menu="Agent",
            repeats=False,
            needs="Needs a hint: ask for some with H.",
        )
        for index in range(HINTS)
    ),
)
