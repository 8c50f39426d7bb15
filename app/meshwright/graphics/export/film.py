"""The film: every state of a history, exact to the bit, as figures and as a file.

A film is a copy. It is taken from a document in the document's thread and may then be played and
written in any other, while the document goes on.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from meshwright.document.document import NO_MESH, Document
from meshwright.document.history import YOU, HistoryStep
from meshwright.document.score_series import ScoreSeries
from meshwright.graphics.drawing import raster
from meshwright.graphics.export import video
from meshwright.graphics.markers import label
from meshwright.graphics.mesh_figure import Look, Moment, edges, figure, fitted
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh, MeshError, Operation

SAMPLES = 2
"""Frames are drawn this many times larger: a still picture takes more care."""
FIRST, LAST = 1.0, 2.5
"""Seconds for which the first and the last frame stay, at least."""


class Film:
    """The states of a document's history: state 0 is the start, state i the one after row i - 1.

    Undone rows count too. Raises MeshError where the document has no mesh.
    """

    def __init__(self, document: Document) -> None:
        mesh = document.mesh
        if mesh is None:
            raise MeshError(NO_MESH)
        self.name = document.name
        self.rows: tuple[HistoryStep, ...] = tuple(document.history)
        self._mesh = mesh.copy(history=True)
        self._state = document.history.cursor
        track = ScoreSeries()
        track.follow(document.history)
        self.scores, self.optima = track.scores, track.optima

    @classmethod
    def of_run(
        cls,
        mesh: HalfEdgeMesh,
        operations: Sequence[tuple[Operation, int]],
        by: str,
        name: str = "",
    ) -> Film:
        """The film of ``operations`` done on a copy of ``mesh``, smoothed as in the window."""
        document = Document(mesh.copy(), name)
        for operation, halfedge in operations:
            document.submit(operation, halfedge, by)
        document.smooth(by)
        return cls(document)

    def __len__(self) -> int:
        return len(self.rows) + 1

    @property
    def state(self) -> int:
        """The state where the film stands."""
        return self._state

    @property
    def mesh(self) -> HalfEdgeMesh:
        """The mesh in the present state, for reading only."""
        return self._mesh

    def go_to(self, state: int) -> None:
        """Undo or redo until ``state``; beyond either end it stops there."""
        state = min(max(state, 0), len(self.rows))
        while self._state > state:
            self._mesh.undo()
            self._state -= 1
        while self._state < state:
            self._mesh.redo()
            self._state += 1

    def stops(self, every: int = 1) -> list[int]:
        """Every ``every``-th state, with the first and the last one."""
        states = list(range(0, len(self), max(every, 1)))
        if states[-1] != len(self.rows):
            states.append(len(self.rows))
        return states

    def moment(self, state: int, since: int | None = None) -> Moment:
        """Go to ``state`` and tell what differs from state ``since`` (by default the one before).

        The edges of a state are found anew: in a row of frames use :meth:`moments`.
        """
        before = max(state - 1, 0) if since is None else since
        self.go_to(before)
        former, places = edges(self._mesh), self._mesh.points.copy()
        self.go_to(state)
        return self._moment(former, places, before)[0]

    def moments(self, stops: Sequence[int]) -> Iterator[Moment]:
        """Go to each of ``stops`` in turn and tell what differs from the one before."""
        former, places, before = np.empty((0, 2), dtype=np.int64), np.empty((0, 3)), -1
        for state in stops:
            self.go_to(state)
            moment, former = self._moment(former, places, before)
            places, before = self._mesh.points.copy(), state
            yield moment

    def _moment(
        self, former: np.ndarray, places: np.ndarray, before: int
    ) -> tuple[Moment, np.ndarray]:
        """The present moment, and the edges of the mesh."""
        state, present = self._state, edges(self._mesh)
        points = self._mesh.points
        added, removed = np.empty((0, 2, 2)), np.empty((0, 2, 2))
        if 0 <= before < state:
            new, old = _keys(present), _keys(former)
            added = points[present[~np.isin(new, old)]][:, :, :2]
            gone = former[~np.isin(old, new)]
            # where a vertex is still there it may have moved a little: the ghost goes with it
            alive = self._mesh.degree()[np.minimum(gone, len(points) - 1)] > 0
            alive &= gone < len(points)
            here = points[np.where(alive, gone, 0)]
            removed = np.where(alive[:, :, None], here, places[gone])[:, :, :2]
        moment = Moment(
            title=self.title(state),
            detail=self._detail(state),
            added=added,
            removed=removed,
            scores=self.scores,
            optima=self.optima,
            state=state,
        )
        return moment, present

    def title(self, state: int) -> str:
        """What led to ``state``, with the change of the score."""
        if state == 0:
            return "Start"
        row = self.rows[state - 1]
        return f"{row.title} ({label(row.change)})" if row.halfedge >= 0 else row.title

    def _detail(self, state: int) -> str:
        by = self.rows[state - 1].by if state else ""
        who = "by hand" if by == YOU else f"by {by}" if by else ""
        return ", ".join(words for words in (self.name, who) if words)

    # Pictures and files

    def viewport(self, look: Look) -> Viewport:
        """One view for all frames: that of the first state."""
        self.go_to(0)
        return fitted(self._mesh, look, Moment(scores=self.scores, optima=self.optima))

    def images(self, stops: Sequence[int], look: Look) -> Iterator[object]:
        """A Pillow image for each of ``stops``."""
        view = self.viewport(look)
        for moment in self.moments(stops):
            yield raster(figure(self._mesh, look, moment, view), SAMPLES)

    def save(
        self,
        path: Path,
        look: Look | None = None,
        seconds: float = 0.25,
        every: int = 1,
        progress: video.Progress | None = None,
    ) -> int:
        """Write the film as GIF or MP4, as the ending says; returns the number of frames.

        ``seconds`` is how long one frame stays, ``every`` how many steps it stands for. Raises,
        and calls ``progress``, as :func:`meshwright.graphics.export.video.save` does.
        """
        look = look or Look()
        stops = self.stops(every)
        times = [seconds] * len(stops)
        times[0] = max(seconds, FIRST if len(stops) > 1 else LAST)
        times[-1] = max(seconds, LAST)
        frames = zip(self.images(stops, look), times, strict=True)
        video.save(path, frames, len(stops), look, progress)
        return len(stops)


def _keys(pairs: np.ndarray) -> np.ndarray:
    """One number for each edge (n, 2), the same in both directions."""
    low, high = np.minimum(pairs[:, 0], pairs[:, 1]), np.maximum(pairs[:, 0], pairs[:, 1])
    return low * np.int64(1 << 32) + high
