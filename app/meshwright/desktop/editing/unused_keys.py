"""Why a key has no effect now."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtGui import QKeyEvent, QKeySequence

from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.action_set import ActionEntry, ActionSet
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme

INACTIVE = "works while the window is active: click it first."
ON_CANVAS = "works while the mesh has the keyboard focus: click it, or press Escape."
_SILENT = (
    Qt.Key.Key_Shift,
    Qt.Key.Key_Control,
    Qt.Key.Key_Alt,
    Qt.Key.Key_AltGr,
    Qt.Key.Key_Meta,
    Qt.Key.Key_CapsLock,
    Qt.Key.Key_NumLock,
    Qt.Key.Key_Super_L,
    Qt.Key.Key_Super_R,
    Qt.Key.Key_Menu,
    Qt.Key.Key_Tab,
    Qt.Key.Key_Backtab,
)


class UnusedKeys(Controller):
    """Shows why a key that reached the canvas or the window had no effect: its action is disabled,
    or there is none.
    """

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        actions: ActionSet,
        status: StatusBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas = document, canvas
        self._actions, self._status = actions, status
        canvas.unused.connect(self.explain)

    def explain(self, event: QKeyEvent) -> None:
        """Show why the key had no effect."""
        if event.isAutoRepeat() or event.key() in _SILENT or event.key() == Qt.Key.Key_unknown:
            return
        keys = QKeySequence(event.keyCombination())
        plain = QKeySequence(event.key())  # > is typed with Shift
        entry = self._entry(keys) or (self._entry(plain) if event.text() else None)
        if entry is None:
            name = keys.toString(QKeySequence.SequenceFormat.NativeText)
            self._status.show_message(f"{name} has no function here; F1 lists all keys.")
            return
        title = entry.title.rstrip("\u2026")
        if self._actions[entry.id].isEnabled():
            why = ON_CANVAS if entry.on_canvas else INACTIVE
            self._status.show_message(f"{title} {why}")
        else:
            self._status.show_message(f"{title}: {entry.requirement}")

    def _entry(self, keys: QKeySequence) -> ActionEntry | None:
        """The action with this shortcut, preferably one for the present kind of mesh."""
        found = [
            entry
            for entry in self._actions.entries
            if any(QKeySequence(one) == keys for one in entry.shortcuts)
        ]
        kind = self._document.kind or "quad"
        found.sort(key=lambda entry: entry.kind not in ("", kind))
        return found[0] if found else None
