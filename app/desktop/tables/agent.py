"""What the agent does beside the person."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from app.desktop.action import Action, can_run, is_active
from app.searching import COMPLETE_SECONDS, Effort

if TYPE_CHECKING:
    from app.desktop.window import MainWindow

BEST_OF = 10
"""Rollouts of *Best of*, as in the paper's tables."""
SEARCHES = ((10, ("Ctrl+Shift+Return",)), (60, ()))
"""Seconds of the searches on offer, and their keys."""


def _search_for(seconds: float, window: MainWindow) -> None:
    window.assistant.search(Effort(seconds=seconds))


ACTIONS: tuple[Action, ...] = (
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
        f"Best of {BEST_OF}",
        f"Run the policy {BEST_OF} times, and go to the best state found",
        lambda window: window.assistant.search(Effort(rollouts=BEST_OF, seconds=None)),
        ("Ctrl+B",),
        can_run,
        menu="Agent",
    ),
    *(
        Action(
            f"agent.search_{seconds}",
            f"Search for {seconds} seconds",
            "Search that long for the optimum, then for fewer elements and operations",
            partial(_search_for, seconds),
            keys,
            can_run,
            menu="Agent",
        )
        for seconds, keys in SEARCHES
    ),
    Action(
        "agent.stop",
        "Stop",
        "Stop the policy; what it has done stays. A search still goes to the best it has found",
        lambda window: window.assistant.stop(),
        ("Esc",),
        is_active,
        menu="Agent",
    ),
)
