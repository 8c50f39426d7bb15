"""Films: all states of a document's history, as figures and as a GIF or MP4 file.

A film holds a copy of the mesh and its history. It is made in the thread of the document and may
then be used in another thread while the document changes.
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
from meshwright.graphics.mesh_figure import FigureOptions, HistoryMoment, figure, fitted
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh, MeshError, Operation
from meshwright_core.geometry.true_edges import TrueEdges

SAMPLES = 2
"""Frames are drawn at this many times their size and scaled down; single pictures at more."""
FIRST, LAST = 1.0, 2.5
"""The least duration of the first and of the last frame in seconds."""
FINENESS = 1e-4
"""Distance of drawn edges from their curves, relative to the extent of the mesh."""


class Film:
    """The states of a document's history: state 0 is the start, state i the one after row i - 1.

    Undone rows are included. Raises MeshError if the document has no mesh.
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
        """The film of ``operations`` on a copy of ``mesh``, smoothed as in the window."""
        document = Document(mesh.copy(), name)
        for operation, halfedge in operations:
            document.submit(operation, halfedge, by)
        document.smooth(by)
        return cls(document)

    def __len__(self) -> int:
        return len(self.rows) + 1

    @property
    def state(self) -> int:
        """The index of the present state."""
        return self._state

    @property
    def mesh(self) -> HalfEdgeMesh:
        """The mesh in the present state, for reading only."""
        return self._mesh

    def go_to(self, state: int) -> None:
        """Undo or redo up to ``state``, which is clipped to the first and last state."""
        state = min(max(state, 0), len(self.rows))
        while self._state > state:
            self._mesh.undo()
            self._state -= 1
        while self._state < state:
            self._mesh.redo()
            self._state += 1

    def stops(self, every: int = 1) -> list[int]:
        """Every ``every``-th state from 0 on, and the last one."""
        states = list(range(0, len(self), max(every, 1)))
        if states[-1] != len(self.rows):
            states.append(len(self.rows))
        return states

    def moment(self, state: int, since: int | None = None) -> HistoryMoment:
        """Go to ``state`` and compare it with state ``since``, by default the one before.

        This computes the edges of both states; for several frames use :meth:`moments`.
        """
        before = max(state - 1, 0) if since is None else since
        self.go_to(before)
        former = self._edges()
        self.go_to(state)
        return self._moment(former, before)[0]

    def moments(self, stops: Sequence[int]) -> Iterator[HistoryMoment]:
        """Go to each of ``stops`` in turn and compare it with the one before."""
        former, before = None, -1
        for state in stops:
            self.go_to(state)
            moment, former = self._moment(former, before)
            before = state
            yield moment

    def _edges(self) -> TrueEdges:
        """The edges of the present state."""
        extent = np.ptp(self._mesh.points[self._mesh.vertices(), :2], axis=0).max(initial=0.0)
        return TrueEdges(self._mesh, max(FINENESS * float(extent), 1e-300))

    def _moment(self, former: TrueEdges | None, before: int) -> tuple[HistoryMoment, TrueEdges]:
        """The present moment and the edges of the mesh."""
        state, present = self._state, self._edges()
        added, removed = np.empty((0, 2, 2)), np.empty((0, 2, 2))
        if former is not None and 0 <= before < state:
            here, there = present.once(), former.once()
            new, old = _keys(present.ends(here)), _keys(former.ends(there))
            added = present.pieces(here[~np.isin(new, old)])
            gone = there[~np.isin(old, new)]
            curved = former.curved(gone)
            removed = np.concatenate(
                [self._at_new_places(former, gone[~curved]), former.pieces(gone[curved])]
            )
        moment = HistoryMoment(
            title=self.title(state),
            detail=self._detail(state),
            added=added,
            removed=removed,
            scores=self.scores,
            optima=self.optima,
            state=state,
        )
        return moment, present

    def _at_new_places(self, former: TrueEdges, gone: np.ndarray) -> np.ndarray:
        """(n, 2, 2) ends of edges that were straight and are gone: vertices that still exist may
        have moved, so that the edges are drawn from where they are now.
        """
        ends, points = former.ends(gone), self._mesh.points
        alive = (self._mesh.degree()[np.minimum(ends, len(points) - 1)] > 0) & (ends < len(points))
        now = points[np.where(alive, ends, 0), :2]
        return np.where(alive[:, :, None], now, former.pieces(gone))

    def title(self, state: int) -> str:
        """The title of the step to ``state``, with its change of the score."""
        if state == 0:
            return "Start"
        row = self.rows[state - 1]
        return f"{row.title} ({label(row.change)})" if row.halfedge >= 0 else row.title

    def _detail(self, state: int) -> str:
        by = self.rows[state - 1].by if state else ""
        who = "by hand" if by == YOU else f"by {by}" if by else ""
        return ", ".join(words for words in (self.name, who) if words)

    # Pictures and files

    def viewport(self, options: FigureOptions) -> Viewport:
        """The viewport of all frames, fitted to the first state."""
        self.go_to(0)
        return fitted(self._mesh, options, HistoryMoment(scores=self.scores, optima=self.optima))

    def images(self, stops: Sequence[int], options: FigureOptions) -> Iterator[object]:
        """A Pillow image for each of ``stops``."""
        view = self.viewport(options)
        for moment in self.moments(stops):
            yield raster(figure(self._mesh, options, moment, view), SAMPLES)

    def save(
        self,
        path: Path,
        options: FigureOptions | None = None,
        seconds: float = 0.25,
        every: int = 1,
        progress: video.ReportProgress | None = None,
    ) -> int:
        """Write the film as GIF or MP4, by the ending; returns the number of frames.

        ``seconds`` is how long one frame stays, ``every`` how many steps it stands for. Raises,
        and calls ``progress``, as :func:`meshwright.graphics.export.video.save` does.
        """
        options = options or FigureOptions()
        stops = self.stops(every)
        times = [seconds] * len(stops)
        times[0] = max(seconds, FIRST if len(stops) > 1 else LAST)
        times[-1] = max(seconds, LAST)
        frames = zip(self.images(stops, options), times, strict=True)
        video.save(path, frames, len(stops), options, progress)
        return len(stops)


def _keys(pairs: np.ndarray) -> np.ndarray:
    """One number for each edge (n, 2), the same in both directions."""
    low, high = np.minimum(pairs[:, 0], pairs[:, 1]), np.maximum(pairs[:, 0], pairs[:, 1])
    return low * np.int64(1 << 32) + high
