"""All that a person can do, in one table that menus, toolbar, shortcuts, palette and help read."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from qtpy.QtCore import QObject, Qt
from qtpy.QtGui import QAction, QKeySequence

from meshwright.desktop.actions import (
    agent,
    edit,
    files,
    help,
    history,
    levels,
    mesh,
    navigate,
    select,
    view,
)
from meshwright.desktop.actions.action import Action, tooltip
from meshwright.desktop.actions.mesh import operation_id
from meshwright.desktop.widgets import icons
from meshwright.graphics.theme import Theme
from meshwright_core.operations.catalogue import CATALOGUE

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow

ACTIONS: tuple[Action, ...] = (
    *files.ACTIONS,
    *edit.ACTIONS,
    *select.ACTIONS,
    *mesh.ACTIONS,
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
    (),  # what follows stands at the right
    ("palette", "theme", "help"),
)


class ActionSet(QObject):
    """The table's actions as Qt's, by id, for one window."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._made: dict[str, QAction] = {}
        for action in ACTIONS:
            self._made[action.id] = self._make(action)

    def __getitem__(self, action_id: str) -> QAction:
        return self._made[action_id]

    def refresh(self) -> None:
        """Enable what makes sense now, and check what is switched on."""
        for action in ACTIONS:
            made = self._made[action.id]
            made.setEnabled(action.enabled(self._window))
            if action.checked is not None:
                made.setChecked(action.checked(self._window))

    def set_theme(self, theme: Theme) -> None:
        """Draw the icons again."""
        for action in ACTIONS:
            if action.icon:
                self._made[action.id].setIcon(icons.icon(action.icon, theme))

    def _make(self, action: Action) -> QAction:
        made = QAction(action.title, self._window)
        made.setIconText(f" {action.word}" if action.word else action.title.rstrip("\u2026"))
        made.setShortcuts([QKeySequence(keys) for keys in action.shortcuts])
        made.setAutoRepeat(action.repeats)
        made.setToolTip(tooltip(action))
        made.setIconVisibleInMenu(False)
        made.setCheckable(action.checked is not None)
        made.triggered.connect(partial(self._run, action))
        if action.on_canvas:
            made.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
            self._window.canvas.addAction(made)
        else:
            self._window.addAction(made)
        return made

    def _run(self, action: Action, checked: bool = False) -> None:
        action.run(self._window)
        if action.checked is not None:  # Qt has flipped the switch already; the truth is elsewhere
            self._made[action.id].setChecked(action.checked(self._window))


def groups(window: MainWindow) -> list[tuple[str, list[Action]]]:
    """Menus with the actions that this window's kind of mesh can use, in the table's order."""
    kind = window.document.kind or "quad"
    foreign = {operation_id(info) for info in CATALOGUE if info.kind != kind}
    listed = [
        (menu, [a for a in ACTIONS if a.menu == menu and a.id not in foreign]) for menu in MENUS
    ]
    return [(menu, members) for menu, members in listed if members]
