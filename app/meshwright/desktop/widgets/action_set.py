"""The user's actions as QActions by id, for menus, toolbar, panels and palette."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from qtpy.QtCore import QObject, Qt, Signal
from qtpy.QtGui import QAction, QKeySequence
from qtpy.QtWidgets import QWidget

from meshwright.desktop.widgets import icons
from meshwright.graphics.theme import Theme


@dataclass(frozen=True)
class ActionEntry:
    """How one action is listed.

    ``menu`` is the menu that lists it, ``kind`` the kind of mesh it applies to (empty: both);
    ``icon`` is its icon in the toolbar (empty: it has none there), ``word`` a text beside the icon.
    ``repeats``: a key held down repeats the action. The shortcuts of an ``on_canvas`` action work
    only while the canvas has the keyboard focus. ``needs`` is a sentence that names what is missing
    while the action is disabled.
    """

    id: str
    title: str
    tooltip: str
    shortcuts: tuple[str, ...] = ()
    menu: str = ""
    kind: str = ""
    icon: str = ""
    word: str = ""
    repeats: bool = True
    on_canvas: bool = False
    needs: str = ""

    @property
    def checkable(self) -> bool:
        """Whether the action is a switch."""
        return False

    @property
    def requirement(self) -> str:
        """What is missing while the action is disabled, as a sentence."""
        return self.needs or "Not possible now."


class ActionSet(QObject):
    """One QAction per entry. ``triggered(id)`` when one is triggered; the entries' meaning is
    given by :class:`meshwright.desktop.actions.dispatcher.ActionDispatcher`.
    """

    triggered = Signal(str)

    def __init__(
        self,
        entries: Sequence[ActionEntry],
        menus: Sequence[str],
        window: QWidget,
        canvas: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(window)
        self._entries, self._menus = tuple(entries), tuple(menus)
        self._made = {entry.id: self._make(entry, window, canvas) for entry in self._entries}
        self.set_theme(theme)

    def __getitem__(self, action_id: str) -> QAction:
        return self._made[action_id]

    def entry(self, action_id: str) -> ActionEntry:
        """How an action is listed; KeyError for an unknown id."""
        return next(entry for entry in self._entries if entry.id == action_id)

    @property
    def entries(self) -> tuple[ActionEntry, ...]:
        """All entries, in the table's order."""
        return self._entries

    def menus(self, kind: str) -> list[tuple[str, list[ActionEntry]]]:
        """The menus that are not empty, with the entries for meshes of ``kind`` ("" counts as
        "quad"), in the table's order.
        """
        kind = kind or "quad"
        listed = [
            (menu, [e for e in self._entries if e.menu == menu and e.kind in ("", kind)])
            for menu in self._menus
        ]
        return [(menu, members) for menu, members in listed if members]

    def set_theme(self, theme: Theme) -> None:
        """Draw the icons in the colours of ``theme``."""
        for entry in self._entries:
            if entry.icon:
                self._made[entry.id].setIcon(icons.icon(entry.icon, theme))

    def _make(self, entry: ActionEntry, window: QWidget, canvas: QWidget) -> QAction:
        made = QAction(entry.title, window)
        made.setIconText(f" {entry.word}" if entry.word else entry.title.rstrip("\u2026"))
        made.setShortcuts([QKeySequence(keys) for keys in entry.shortcuts])
        made.setAutoRepeat(entry.repeats)
        made.setToolTip(tooltip(entry))
        made.setIconVisibleInMenu(False)
        made.setCheckable(entry.checkable)
        made.triggered.connect(partial(self._on_triggered, entry.id))
        if entry.on_canvas:
            made.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
            canvas.addAction(made)
        else:
            window.addAction(made)
        return made

    def _on_triggered(self, action_id: str, checked: bool = False) -> None:
        self.triggered.emit(action_id)


def with_mnemonics(titles: Sequence[str]) -> list[str]:
    """The titles with ``&`` before one letter each, no letter twice: Alt and that letter opens the
    menu of this title. A title whose letters are all taken has none.
    """
    taken: set[str] = set()
    made = []
    for title in titles:
        at = next((i for i, c in enumerate(title) if c.isalpha() and c.lower() not in taken), -1)
        if at >= 0:
            taken.add(title[at].lower())
            made.append(f"{title[:at]}&{title[at:]}")
        else:
            made.append(title)
    return made


def tooltip(entry: ActionEntry) -> str:
    """What the action does, and its first shortcut."""
    if not entry.shortcuts:
        return entry.tooltip
    return f"{entry.tooltip}  ({key_text(entry.shortcuts[0])})"


def key_text(keys: str) -> str:
    """Keys as this platform writes them."""
    return QKeySequence(keys).toString(QKeySequence.SequenceFormat.NativeText)
