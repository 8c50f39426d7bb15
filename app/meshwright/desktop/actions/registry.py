"""All user actions in one table, which menus, toolbar, shortcuts, palette and help share."""

from __future__ import annotations

from meshwright.desktop.actions import (
    agent,
    edit,
    files,
    help,
    history,
    levels,
    mesh,
    names,
    navigate,
    select,
    view,
)
from meshwright.desktop.actions.action import Action

ACTIONS: tuple[Action, ...] = (
    *files.ACTIONS,
    *edit.ACTIONS,
    *select.ACTIONS,
    *mesh.ACTIONS,
    *names.ACTIONS,
    *view.ACTIONS,
    *navigate.ACTIONS,
    *history.ACTIONS,
    *agent.ACTIONS,
    *levels.ACTIONS,
    *help.ACTIONS,
)

MENUS = ("File", "Edit", "Select", "Mesh", "View", "Go", "History", "Agent", "Levels", "Help")
TOOLBAR = (
    ("new", "open", "save"),
    ("undo", "redo"),
    ("tool.edit", "tool.box", "tool.lasso"),
    ("lines", "clean_all", "smooth", "fit"),
    (),  # the groups after this one are aligned to the right
    ("palette", "theme", "help"),
)
