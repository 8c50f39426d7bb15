"""Levels: puzzles with a goal, a par and stars."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshwright.desktop.actions.action import Action, needing
from meshwright.desktop.levels.level_controller import is_last

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


@needing("No level is being played.")
def in_level(window: MainWindow) -> bool:
    """A level is being played."""
    return window.levels.level is not None


@needing("There is no level after this one.")
def has_next(window: MainWindow) -> bool:
    """There is a level after the one that is being played."""
    return not is_last(window.levels.level)


ACTIONS: tuple[Action, ...] = (
    Action(
        "levels",
        "Levels\u2026",
        "Puzzles with a goal, a par and stars, from very easy to hard",
        lambda window: window.levels.choose(),
        ("Ctrl+Shift+L",),
        menu="Levels",
    ),
    Action(
        "level.again",
        "Begin again",
        "Begin the level again",
        lambda window: window.levels.again(),
        (),
        in_level,
        menu="Levels",
    ),
    Action(
        "level.next",
        "Next level",
        "Go on to the next level",
        lambda window: window.levels.next(),
        (),
        has_next,
        menu="Levels",
    ),
    Action(
        "level.answer",
        "Play against the agent",
        "Let the agent solve the level on a mesh of its own; once it has, show its way",
        lambda window: window.levels.answer(),
        (),
        in_level,
        menu="Levels",
    ),
    Action(
        "level.way",
        "Show a way",
        "Begin again with a way ahead: the agent's, or the shortest known",
        lambda window: window.levels.show_way(),
        (),
        in_level,
        menu="Levels",
    ),
    Action(
        "level.leave",
        "Leave the level",
        "Go on with the mesh as it is, without counting",
        lambda window: window.levels.leave(),
        (),
        in_level,
        menu="Levels",
    ),
)
