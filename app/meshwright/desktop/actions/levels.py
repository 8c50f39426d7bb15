"""Actions of the menu Levels: puzzles with a goal, a par and stars."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action, needing
from meshwright.desktop.actions.context import ActionContext
from meshwright.desktop.levels.level_controller import is_last


@needing("No level is being played.")
def in_level(context: ActionContext) -> bool:
    """A level is being played."""
    return context.levels.level is not None


@needing("There is no level after this one.")
def has_next(context: ActionContext) -> bool:
    """There is a level after the one that is being played."""
    return not is_last(context.levels.level)


ACTIONS: tuple[Action, ...] = (
    Action(
        "levels",
        "Levels\u2026",
        "Puzzles with a goal, a par and stars, from very easy to hard",
        run=lambda context: context.levels.choose(),
        shortcuts=("Ctrl+Shift+L",),
        menu="Levels",
    ),
    Action(
        "level.again",
        "Restart",
        "Restart the level",
        run=lambda context: context.levels.again(),
        enabled=in_level,
        menu="Levels",
    ),
    Action(
        "level.next",
        "Next level",
        "Start the next level",
        run=lambda context: context.levels.next(),
        enabled=has_next,
        menu="Levels",
    ),
    Action(
        "level.answer",
        "Play against the agent",
        "Let the agent solve a copy of the level; once it is solved, show the solution",
        run=lambda context: context.levels.answer(),
        enabled=in_level,
        menu="Levels",
    ),
    Action(
        "level.way",
        "Show a solution",
        "Restart with a solution to step through: the agent's, or the shortest known",
        run=lambda context: context.levels.show_way(),
        enabled=in_level,
        menu="Levels",
    ),
    Action(
        "level.leave",
        "Leave the level",
        "Keep the mesh, and stop counting operations",
        run=lambda context: context.levels.leave(),
        enabled=in_level,
        menu="Levels",
    ),
)
