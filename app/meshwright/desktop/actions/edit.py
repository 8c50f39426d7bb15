"""Actions of the menu Edit: undo and redo."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action

ACTIONS: tuple[Action, ...] = (
    Action(
        "undo",
        "Undo",
        "Undo the last step",
        run=lambda context: context.editing.undo(),
        shortcuts=("Ctrl+Z",),
        enabled=lambda context: context.document.can_undo,
        menu="Edit",
        icon="undo",
        needs="There is nothing to undo.",
    ),
    Action(
        "redo",
        "Redo",
        "Redo the step that was undone last",
        run=lambda context: context.editing.redo(),
        shortcuts=("Ctrl+Shift+Z", "Ctrl+Y"),
        enabled=lambda context: context.document.can_redo,
        menu="Edit",
        icon="redo",
        needs="There is nothing to redo.",
    ),
)
