"""Runs the actions of the table, and keeps their QActions enabled and checked as they should be."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action
from meshwright.desktop.actions.context import ActionContext
from meshwright.desktop.actions.registry import ACTIONS
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.graphics.theme import Theme


class ActionDispatcher(Controller):
    """Connects ``actions`` to the table's functions on ``context``.

    It connects to every signal that may change which actions are enabled or checked, so that other
    controllers need not refresh them. It is constructed after them, so their slots run first.
    """

    def __init__(self, actions: ActionSet, context: ActionContext, theme: Theme) -> None:
        super().__init__(theme)
        self._actions, self._context = actions, context
        self._by_id = {action.id: action for action in ACTIONS}
        actions.triggered.connect(self._on_triggered)
        document, assistant = context.document, context.assistant
        for signal in (
            document.replaced,
            document.history_changed,
            document.selection.changed,
            assistant.changed,
            assistant.hinting.changed,
            context.settings.changed,
            context.readiness.changed,
            context.levels.play.changed,
            context.selection_tools.tool_changed,
            context.blocks.changed,
        ):
            self._connections.add(signal, self.refresh)
        context.quality.monitor.measured.connect(self.refresh)
        self.refresh()

    def set_theme(self, theme: Theme) -> None:
        """Draw the icons in the colours of ``theme``."""
        super().set_theme(theme)
        self._actions.set_theme(theme)

    def close(self) -> None:
        """Disconnect from signals and actions."""
        super().close()
        self._actions.triggered.disconnect(self._on_triggered)

    def refresh(self, *_: object) -> None:
        """Enable what is possible now, and check what is switched on."""
        for action in ACTIONS:
            made = self._actions[action.id]
            made.setEnabled(action.enabled(self._context))
            if action.checked is not None:
                made.setChecked(action.checked(self._context))

    def _on_triggered(self, action_id: str) -> None:
        action: Action = self._by_id[action_id]
        action.run(self._context)
        if action.checked is not None:  # Qt has toggled the QAction, whether or not it was allowed
            self._actions[action_id].setChecked(action.checked(self._context))
