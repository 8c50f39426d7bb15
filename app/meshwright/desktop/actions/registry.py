"""All user actions in one table, which menus, toolbar, shortcuts, palette and help share."""

from __future__ import annotations

from meshwright.desktop.actions import (
    agent,
    blocks,
    edit,
    files,
    help,
    history,
    levels,
    mesh,
    names,
    navigate,
    select,
    vertex,
    view,
)
from meshwright.desktop.actions.action import Action

ACTIONS: tuple[Action, ...] = (
    *files.ACTIONS,
    *edit.ACTIONS,
    *select.ACTIONS,
    *mesh.ACTIONS,
    *names.ACTIONS,
    *vertex.ACTIONS,
    *view.ACTIONS,
    *blocks.ACTIONS,
    *navigate.ACTIONS,
    *history.ACTIONS,
    *agent.ACTIONS,
    *levels.ACTIONS,
    *help.ACTIONS,
)

MENUS = (
    "File",
    "Edit",
    "Select",
    "Mesh",
    "Blocks",
    "View",
    "Go",
    "History",
    "Agent",
    "Levels",
    "Help",
)
DIVIDERS = frozenset(
    (
        "save", "blocks.export", "blocks.next", "blocks.count", "blocks.grading", "blocks.insert",
        "recover", "quit", "auto_smooth", "select.all", "select.irregular", "clean_all",
        "smooth", "zoom_selection", "ghosts", "colour.block", "theme", "walk.operation",
        "walk.turn", "walk.left", "history.back", "history.export", "history.list",
        "agent.complete", "agent.watch", "agent.stop", "agent.take_1", "level.again",
        "level.answer", "level.leave",
    )
)  # fmt: skip
"""Actions above which their menu has a line."""
TOOLBAR = (
    ("new", "open", "save"),
    ("undo", "redo"),
    ("tool.edit", "tool.box", "tool.lasso"),
    ("lines", "clean_all", "smooth", "blocks.view", "fit"),
    (),  # the groups after this one are aligned to the right
    ("palette", "theme", "help"),
)
