"""Hints of the policy: numbered previews, applied by key or click."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QPointF, Qt

from meshwright.assistant.assistant import Assistant
from meshwright.desktop.agent.agent_panel import AgentPanel
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.hints import Hint, HintsLayer
from meshwright.desktop.canvas.mouse import Click
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.desktop.widgets.wording import step_message
from meshwright.document.document import Document, title_of
from meshwright.document.operation_preview import ghost
from meshwright.graphics.theme import Theme
from meshwright_core import HalfEdgeMesh, MeshError, OperationRefused
from meshwright_core.geometry.edge_curves import edge_points

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import PolicyAction


class HintsController(Controller):
    """Shows the policy's hints on the canvas and in the agent panel, and applies them."""

    def __init__(
        self,
        document: Document,
        assistant: Assistant,
        canvas: Canvas,
        panel: AgentPanel,
        status: StatusBar,
        notice: NoticeBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._assistant, self._canvas = document, assistant, canvas
        self._panel, self._status, self._notice = panel, status, notice
        self.shown: tuple[Hint, ...] = ()
        self._choices: tuple[PolicyAction, ...] = ()
        self._mouse: QPointF | None = None
        overlay = canvas.overlay
        self.layer = HintsLayer(theme, overlay.font())
        overlay.add(self.layer, below=overlay.markers)
        overlay.add(self.layer.badges, below=overlay.card)
        canvas.hovered.connect(self._on_hovered)
        panel.hints.taken.connect(self.take)
        panel.hints.hovered.connect(self.layer.make_current)
        self._connections.add(assistant.hinting.changed, self._on_changed)

    # Commands

    def ask_or_hide(self) -> None:
        """Request hints for the visible part of the mesh, or hide those that are shown."""
        if self.shown or self._assistant.hinting.asking:
            self.hide()
        else:
            self.ask()

    def ask(self) -> None:
        """Request hints for the visible part of the mesh, those near the mouse first."""
        self._assistant.hint(self._near())

    def hide(self) -> None:
        """Hide the hints, and drop a request that is under way."""
        if self.shown:
            self._status.show_message("")
        self._assistant.hinting.forget()

    def take(self, index: int) -> None:
        """Apply a hint, and request the next ones."""
        if not 0 <= index < len(self.shown):
            return
        choice, document = self._choices[index], self._document
        try:
            document.submit(choice.operation, choice.halfedge)
        except MeshError as error:
            self._notice.show_message(str(error))
            return
        self._status.show_message(step_message(document.history.last))
        if not document.at_optimum:
            self.ask()

    def click(self, click: Click) -> bool:
        """Apply the hint whose badge is clicked; False if there is none."""
        if click.button != Qt.MouseButton.LeftButton:
            return False
        index = self.layer.at(click.at)
        self.take(index)
        return index >= 0

    # Implementation

    def _near(self) -> np.ndarray | None:
        """(n,) visible irregular vertices, those near the mouse first; None if there are none."""
        mesh, canvas = self._document.mesh, self._canvas
        if mesh is None:
            return None
        irregular = mesh.arrays.irregular[: mesh.irregular_count].astype(np.int64)
        at = canvas.viewport.to_screen(mesh.points[irregular])
        seen = ((at >= 0) & (at <= canvas.viewport.size)).all(axis=1)
        if not seen.any():
            return None
        centre = np.array(canvas.viewport.size) / 2.0
        if self._mouse is not None:
            centre = np.array([self._mouse.x(), self._mouse.y()])
        away = np.linalg.norm(at[seen] - centre, axis=1)
        return irregular[seen][np.argsort(away, kind="stable")]

    def _on_changed(self) -> None:
        mesh = self._document.mesh
        hinting = self._assistant.hinting
        choices = hinting.hints
        pairs = [(c, shown) for c in choices if mesh and (shown := self._hint(mesh, c))]
        self._choices = tuple(choice for choice, _ in pairs)
        self.shown = tuple(
            replace(
                hint,
                number=number,
                is_next=choice is hinting.next_step,
                is_known=choice is hinting.guided,
            )
            for number, (choice, hint) in enumerate(pairs, 1)
        )
        marks = None
        if mesh is not None:
            marks = mesh.points[mesh.arrays.irregular[: mesh.irregular_count], :2]
        self.layer.show(self.shown, marks)
        self._panel.hints.show_hints(self.shown)
        if self.shown:
            count = len(self.shown)
            keys = "1" if count == 1 else f"1 to {count}"
            self._status.show_message(
                f"Apply a hint by its number ({keys}) or with a click; Esc hides them."
            )

    def _hint(self, mesh: HalfEdgeMesh, choice: PolicyAction) -> Hint | None:
        try:
            seen = ghost(mesh, choice.operation, choice.halfedge)
        except OperationRefused:
            return None  # the mesh has a degree cap that the policy does not take into account
        place = edge_points(mesh, choice.halfedge, 0.5)[0, :2]
        title = title_of(choice.operation, mesh.kind)
        return Hint(0, title, choice.probability, seen, place)

    def _on_hovered(self, at: QPointF | None) -> None:
        self._mouse = at
        if self.shown and at is not None:
            self.layer.make_current(self.layer.at(at))
