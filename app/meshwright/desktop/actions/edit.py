"""Going back and forth, and what is selected."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action

ACTIONS: tuple[Action, ...] = (
    Action(
        "undo",
        "Undo",
        "Take back the last step",
        lambda window: window.editing.undo(),
        ("Ctrl+Z",),
        lambda window: window.document.can_undo,
        menu="Edit",
        icon="undo",
        needs="There is nothing to take back.",
    ),
    Action(
        "redo",
        "Redo",
        "Do again what was taken back",
        lambda window: window.editing.redo(),
        ("Ctrl+Shift+Z", "Ctrl+Y"),
        lambda window: window.document.can_redo,
        menu="Edit",
        icon="redo",
        needs="Nothing has been taken back.",
    ),
)
