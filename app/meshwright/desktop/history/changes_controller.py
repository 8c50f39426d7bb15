"""Marks what a step has changed: the last one of the agent or of playback, and the one under the
mouse in the history.
"""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QTimer

from meshwright.assistant.assistant import Assistant, State
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.changes import ChangesLayer
from meshwright.desktop.controller import Controller
from meshwright.desktop.history.playback_controller import PlaybackController
from meshwright.document.document import Document
from meshwright.document.history import YOU
from meshwright.graphics.export.film import Film
from meshwright.graphics.mesh_figure import edges
from meshwright.graphics.theme import Theme
from meshwright_core import HalfEdgeMesh

LARGEST = 5000
"""Elements up to which changes are marked; comparing larger meshes would delay the next frame."""
FARTHEST = 400
"""Steps between the present state and the one under the mouse at most."""
STAYS = 2500
"""Milliseconds for which the last step stays marked."""


class ChangesController(Controller):
    """Compares the mesh of each frame with that of the frame before."""

    def __init__(
        self,
        document: Document,
        assistant: Assistant,
        canvas: Canvas,
        playback: PlaybackController,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._assistant, self._canvas = document, assistant, canvas
        self._playback = playback
        self.layer = ChangesLayer(theme)
        canvas.overlay.add(self.layer, below=canvas.overlay.markers)
        self._before: tuple[HalfEdgeMesh | None, np.ndarray, np.ndarray] | None = None
        self._cursor = 0
        self._film: Film | None = None
        self._fade = QTimer(canvas, singleShot=True, interval=STAYS)
        self._fade.timeout.connect(self.layer.show)
        canvas.drawn.connect(self._on_drawn)
        playback.panel.list.setMouseTracking(True)
        playback.panel.state_hovered.connect(self._on_state_hovered)
        self._connections.add(document.replaced, self._on_replaced)
        self._connections.add(document.changed, self._on_changed)
        self._on_replaced()

    def close(self) -> None:
        """Disconnect, and stop the timer."""
        super().close()
        self._canvas.drawn.disconnect(self._on_drawn)
        self._playback.panel.state_hovered.disconnect(self._on_state_hovered)
        self._fade.stop()

    def _on_replaced(self) -> None:
        self._film = None
        self.layer.show()
        self._remember()

    def _on_changed(self) -> None:
        self._film = None

    def _remember(self) -> None:
        mesh = self._document.mesh
        self._cursor = self._document.history.cursor
        self._before = None
        if mesh is not None and mesh.n_elements <= LARGEST:
            self._before = mesh, edges(mesh), mesh.points.copy()

    @property
    def _watched(self) -> bool:
        """Whether the last change was made by the agent, or by moving through the history."""
        history = self._document.history
        if self._assistant.state in (State.SEARCHING, State.GOING):
            return False
        if history.cursor != self._cursor + 1:
            return False
        return self._playback.moving or (history.last is not None and history.last.by != YOU)

    def _on_drawn(self) -> None:
        mesh, before = self._document.mesh, self._before
        watched = self._watched
        self._remember()
        if not watched or before is None or self._before is None or before[0] is not mesh:
            self.layer.show()
            return
        _, old, points = before
        new, now = self._before[1], self._before[2]
        added = new[~np.isin(_keys(new), _keys(old))]
        gone = old[~np.isin(_keys(old), _keys(new))]
        alive = np.zeros(max(len(points), len(now)), bool)
        alive[self._document.need_mesh().vertices()] = True
        ends = np.where(alive[gone][:, :, None], now[np.minimum(gone, len(now) - 1)], points[gone])
        self.layer.show(now[added][..., :2], ends[..., :2])
        self._fade.start()

    def _on_state_hovered(self, state: int) -> None:
        """The mouse is over a line of the history; -1: it has left."""
        document, mesh = self._document, self._document.mesh
        self._fade.stop()
        near = abs(state - document.history.cursor) <= FARTHEST
        if state < 1 or mesh is None or mesh.n_elements > LARGEST or not near:
            self.layer.show()
            return
        if self._film is None:
            self._film = Film(document)
        moment = self._film.moment(state)
        self.layer.show(moment.added, moment.removed)


def _keys(pairs: np.ndarray) -> np.ndarray:
    """One number for each edge (n, 2), the same in both directions."""
    keys: np.ndarray = pairs.min(axis=1) * np.int64(1 << 32) + pairs.max(axis=1)
    return keys
