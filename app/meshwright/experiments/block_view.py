"""The blocks of a quad mesh, as a picture and as structured grids."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from meshwright.experiments.mesh_thumbnail import MARGIN, given_mesh
from meshwright.experiments.picture import Picture, ThemedFigureOptions
from meshwright.graphics.drawing import Disc, Drawing, Polygon, Segments, Text, text_width
from meshwright.graphics.mesh_figure import below_edges, figure
from meshwright.graphics.theme import LIGHT, Theme
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh
from meshwright_core.analysis.block_grids import Grid, grids
from meshwright_core.analysis.blocks import separatrices
from meshwright_core.core.arrays import TWIN
from meshwright_core.geometry.true_edges import TrueEdges

SIZE = 480
FOOT = 40.0


def block_view(mesh: Any, corners: bool = False) -> BlockView:
    """Decompose a quad mesh into its blocks.

    Args:
        mesh: a mesh or a source of one, as for :func:`meshwright.experiments.compare`; copied.
        corners: whether to cut also at corners of the outline that lie inside a side of a block.

    Raises MeshError for a triangle mesh.
    """
    shown = given_mesh(mesh)
    return BlockView(shown, grids(shown, corners), separatrices(shown, corners))


class BlockView(Picture):
    """The block decomposition of a quad mesh."""

    def __init__(self, mesh: HalfEdgeMesh, found: list[Grid], cut: np.ndarray) -> None:
        self.mesh = mesh
        self.grids = found
        """For each block its vertices and its elements as arrays of rows and columns."""
        self._cut = cut

    def __len__(self) -> int:
        return len(self.grids)

    def __repr__(self) -> str:
        sizes = Counter(_size(grid) for grid in self.grids)
        listed = ", ".join(f"{count} of {size}" for size, count in sizes.most_common())
        noun = "block" if len(self) == 1 else "blocks"
        return f"{len(self)} {noun}: {listed}"

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One dictionary for each block."""
        return [
            {
                "block": i,
                "rows": grid.shape[0],
                "columns": grid.shape[1],
                "elements": grid.elements.size,
                "closed": grid.closed,
            }
            for i, grid in enumerate(self.grids)
        ]

    def drawing(self, theme: Theme = LIGHT) -> Drawing:
        """Blocks tinted differently from their neighbours, with thick lines between them.

        Each is labelled with its size, or with its number from 1 on if all are single quads.
        """
        mesh = self.mesh
        extent = np.ptp(mesh.points[mesh.vertices(), :2], axis=0)
        tall = round(SIZE * float(np.clip(extent[1] / max(extent[0], 1e-12), 0.35, 1.0)))
        size = (SIZE, tall)
        options = ThemedFigureOptions(size=size, score=False, curve=False, unit=1.0, given=theme)
        view = Viewport(size=size).fitted(mesh.points[mesh.vertices()], MARGIN)
        picture = figure(mesh, options, None, view)
        drawing = Drawing((SIZE, round(tall + FOOT)), theme.background, repr(self))
        true = TrueEdges(mesh, view.tolerance)
        edges = below_edges(picture)
        drawing.add(*self._tints(theme, view, true), picture.shapes[edges])
        drawing.add(self._lines(theme, view, true), *picture.shapes[edges + 1 :])
        single = all(grid.elements.size == 1 for grid in self.grids)
        for i, grid in enumerate(self.grids, 1):
            words = str(i) if single else _size(grid)
            _add_words(drawing, theme, view.to_screen(self._middle(grid)), words)
        noun = "block" if len(self) == 1 else "blocks"
        quads = "quad" if mesh.n_elements == 1 else "quads"
        words = f"{len(self)} {noun}"
        drawing.add(
            Text(words, (MARGIN, tall + 16.0), 14.0, theme.text, "left", True),
            Text(f"{mesh.n_elements} {quads},  s {mesh.score},  s* {mesh.optimum}",
                 (MARGIN + text_width(words, 14.0, True) + 16.0, tall + 16.0), 12.0, theme.muted),
        )  # fmt: skip
        return drawing

    def _tints(self, theme: Theme, view: Viewport, true: TrueEdges) -> list[Polygon]:
        tints = theme.tints
        chosen = self._chosen(len(tints))
        return [
            Polygon(view.to_screen(outline), tints[tint])
            for grid, tint in zip(self.grids, chosen, strict=True)
            for outline in true.outlines(grid.elements.ravel())
        ]

    def _chosen(self, tints: int) -> list[int]:
        """The index of a tint for each block, different from its neighbours' where possible."""
        block = np.full(len(self.mesh.arrays.element_mark), -1)
        for i, grid in enumerate(self.grids):
            block[grid.elements.ravel()] = i
        h = np.flatnonzero(self._cut)
        meeting = np.column_stack([block[h // 4], block[self.mesh.arrays.edge[h, TWIN] // 4]])
        chosen: list[int] = []
        for i in range(len(self.grids)):
            near = {int(j) for j in meeting[meeting[:, 0] == i, 1] if j < i}
            taken = {chosen[j] for j in near}
            free = [tint for tint in range(tints) if tint not in taken]
            chosen.append(free[0] if free else i % tints)
        return chosen

    def _lines(self, theme: Theme, view: Viewport, true: TrueEdges) -> Segments:
        """The edges between blocks."""
        pieces = true.pieces(np.flatnonzero(self._cut))
        return Segments(view.to_screen(pieces), theme.accent, 3.0)

    def _middle(self, grid: Grid) -> np.ndarray:
        """Where the label goes, in the plane: near the middle of the block."""
        rows, columns = grid.shape
        i, j = rows // 2, columns // 2
        # in the middle is a line if the number of quads is even, a quad if it is odd
        some = grid.vertices[i : i + 1 + rows % 2, j : j + 1 + columns % 2]
        return self.mesh.points[some.ravel(), :2].mean(axis=0)


def _size(grid: Grid) -> str:
    rows, columns = grid.shape
    return f"{rows} \N{MULTIPLICATION SIGN} {columns}" + (" ring" if grid.closed else "")


def _add_words(drawing: Drawing, theme: Theme, at: np.ndarray, words: str) -> None:
    x, y = at.tolist()
    width = text_width(words, 11.5) / 2.0 + 6.0
    box = np.array([[-width, -9], [width, -9], [width, 9], [-width, 9]]) + (x, y)
    drawing.add(
        Disc((x - width, y), 9.0, theme.raised),
        Disc((x + width, y), 9.0, theme.raised),
        Polygon(box, theme.raised),
        Text(words, (x, y), 11.5, theme.text, "middle"),
    )
