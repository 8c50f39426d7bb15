"""Hints in the window: asked for, shown as numbered ghosts, taken by key or click."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QPointF, Qt

from meshwright.desktop.canvas.layers.hints import Hint, HintsLayer
from meshwright.desktop.editing.edit_controller import told
from meshwright.document.document import title_of
from meshwright.document.operation_preview import ghost
from meshwright_core import HalfEdgeMesh, MeshError, OperationRefused

if TYPE_CHECKING:
    from meshwright.desktop.canvas.mouse import Click
    from meshwright.desktop.main_window.window import MainWindow
    from meshwright_agent.policy.explanation_types import PolicyAction


class Hints:
    """The policy's hints in one window."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.layer: HintsLayer | None = None
        self.shown: tuple[Hint, ...] = ()
        self._choices: tuple[PolicyAction, ...] = ()
        self._mouse: QPointF | None = None

    def connect(self) -> None:
        """Follow the assistant and the mouse."""
        window = self._window
        overlay = window.canvas.overlay
        self.layer = HintsLayer(window.theme, overlay.font())
        overlay.add(self.layer, below=overlay.markers)
        overlay.add(self.layer.badges, below=overlay.card)
        window.assistant.hinting.changed.connect(self._on_changed)
        window.canvas.pointed.connect(self._on_pointed)
        window.editing.takers.append(self.clicked)
        window.agent_panel.hints.taken.connect(self.take)
        window.agent_panel.hints.pointed.connect(self.layer.mean)

    def release(self) -> None:
        """Let go of the assistant."""
        self._window.assistant.hinting.changed.disconnect(self._on_changed)

    # What a person does

    def ask_or_hide(self) -> None:
        """Ask for hints in the part that is seen; hide those that are shown."""
        if self.shown or self._window.assistant.hinting.asking:
            self.hide()
        else:
            self.ask()

    def ask(self) -> None:
        """Ask for hints in the part that is seen, the nearest to the mouse first."""
        self._window.assistant.hint(self._near())

    def hide(self) -> None:
        """Take the hints away."""
        if self.shown:
            self._window.say("")
        self._window.assistant.hinting.forget()
        self._window.refresh()

    def take(self, index: int) -> None:
        """Do what a hint says, and ask for the next ones."""
        if not 0 <= index < len(self.shown):
            return
        choice, document = self._choices[index], self._window.document
        try:
            document.submit(choice.operation, choice.halfedge)
        except MeshError as error:
            self._window.notice.tell(str(error))
            return
        self._window.say(told(document.history.last))
        if not document.at_optimum:
            self.ask()

    def clicked(self, click: Click) -> bool:
        """Take the hint whose badge is clicked; False if there is none."""
        if self.layer is None or click.button != Qt.MouseButton.LeftButton:
            return False
        index = self.layer.at(click.at)
        self.take(index)
        return index >= 0

    # Inside

    def _near(self) -> np.ndarray | None:
        """The irregular vertices in view, those near the mouse first; None if there are none."""
        mesh, canvas = self._window.document.mesh, self._window.canvas
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
        mesh, window = self._window.document.mesh, self._window
        choices = window.assistant.hinting.hints
        pairs = [(c, shown) for c in choices if mesh and (shown := self._hint(mesh, c))]
        self._choices = tuple(choice for choice, _ in pairs)
        self.shown = tuple(
            Hint(number, hint.title, hint.probability, hint.ghost, hint.place)
            for number, (_, hint) in enumerate(pairs, 1)
        )
        if self.layer is not None:
            irregular = mesh.arrays.irregular[: mesh.irregular_count] if mesh else []
            self.layer.show(self.shown, mesh.points[irregular, :2] if mesh else None)
        window.agent_panel.hints.show_hints(self.shown)
        window.refresh()
        if self.shown:
            count = len(self.shown)
            keys = "1" if count == 1 else f"1 to {count}"
            window.say(f"Take a hint by its number ({keys}) or with a click; Esc hides them.")

    def _hint(self, mesh: HalfEdgeMesh, choice: PolicyAction) -> Hint | None:
        try:
            seen = ghost(mesh, choice.operation, choice.halfedge)
        except OperationRefused:
            return None  # the person's mesh has a degree cap that the policy does not know
        ends = [mesh.origin(choice.halfedge), mesh.target(choice.halfedge)]
        place = mesh.points[ends, :2].mean(axis=0)
        title = title_of(choice.operation, mesh.kind)
        return Hint(0, title, choice.probability, seen, place)

    def _on_pointed(self, at: QPointF | None) -> None:
        self._mouse = at
        if self.shown and at is not None and self.layer is not None:
            self.layer.mean(self.layer.at(at))
