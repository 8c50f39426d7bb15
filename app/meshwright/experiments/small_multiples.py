"""Small multiples: a grid of small figures of meshes, with s and s* below each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from meshwright.experiments.mesh_thumbnail import given_mesh, thumbnail
from meshwright.experiments.picture import Picture, shifted
from meshwright.graphics.drawing import Drawing, Text, text_width
from meshwright.graphics.export.film import Film
from meshwright.graphics.theme import LIGHT, Theme
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.arguments import whole_number

CELL, GAP, FOOT = 208, 16, 40
MOST = 400
"""The most figures in one grid."""


def small_multiples(
    items: Iterable[Any] | Film,
    columns: int = 4,
    titles: Sequence[str] | None = None,
    every: int = 1,
) -> Multiples:
    """Draw many meshes in a grid.

    Args:
        items: meshes, documents, widgets, films (in their present state) or names of gallery
            shapes; or one film, of which every ``every``-th state and the last are shown.
        columns: the number of figures in a row.
        titles: one for each mesh; None: none, or for a film the number of the state.
        every: for a film, the number of states from one figure to the next.

    The meshes are copied. Raises MeshError for other items or a wrong number of them.
    """
    width = whole_number(columns, 1, "columns")
    if isinstance(items, Film):
        meshes, names = _states(items, whole_number(every, 1, "every"))
    elif isinstance(items, str) or not isinstance(items, Iterable):
        raise MeshError("Small multiples are made of a list of meshes, or of one film.")
    else:
        meshes = [given_mesh(item) for item in items]
        names = [""] * len(meshes)
    if not 0 < len(meshes) <= MOST:
        raise MeshError(f"Small multiples show 1 to {MOST} meshes, not {len(meshes)}.")
    if titles is not None:
        names = [str(title) for title in titles]
        if len(names) != len(meshes):
            raise MeshError(f"There are {len(meshes)} meshes, but {len(names)} titles.")
    return Multiples(meshes, names, width)


def _states(film: Film, every: int) -> tuple[list[HalfEdgeMesh], list[str]]:
    """Copies of every ``every``-th state and its title; the film returns to its present state."""
    stood, meshes, names = film.state, [], []
    for state in film.stops(every):
        film.go_to(state)
        meshes.append(film.mesh.copy())
        names.append("start" if state == 0 else f"step {state}")
    film.go_to(stood)
    return meshes, names


class Multiples(Picture):
    """Meshes in a grid."""

    def __init__(self, meshes: list[HalfEdgeMesh], titles: list[str], columns: int) -> None:
        self.meshes = meshes
        self.titles = titles
        self.columns = min(columns, len(meshes))

    def __len__(self) -> int:
        return len(self.meshes)

    def __repr__(self) -> str:
        return f"{len(self)} meshes, s {self.scores.tolist()}, optima {self.optima.tolist()}"

    @property
    def scores(self) -> np.ndarray:
        """(n,) s of each mesh."""
        return np.array([mesh.score for mesh in self.meshes])

    @property
    def optima(self) -> np.ndarray:
        """(n,) s* of each mesh."""
        return np.array([mesh.optimum for mesh in self.meshes])

    @property
    def elements(self) -> np.ndarray:
        """(n,) elements of each mesh."""
        return np.array([mesh.n_elements for mesh in self.meshes])

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One dictionary for each mesh."""
        return [
            {
                "title": title,
                "score": mesh.score,
                "optimum": mesh.optimum,
                "elements": mesh.n_elements,
                "vertices": mesh.n_vertices,
                "irregular": mesh.irregular_count,
            }
            for title, mesh in zip(self.titles, self.meshes, strict=True)
        ]

    def drawing(self, theme: Theme = LIGHT) -> Drawing:
        """The grid."""
        head = 24 if any(self.titles) else 0
        tall = head + CELL + FOOT
        rows = -(-len(self) // self.columns)
        size = (self.columns * (CELL + GAP) + GAP, rows * (tall + GAP) + GAP)
        drawing = Drawing(size, theme.background, repr(self))
        for i, (mesh, title) in enumerate(zip(self.meshes, self.titles, strict=True)):
            row, column = divmod(i, self.columns)
            x, y = GAP + column * (CELL + GAP), GAP + row * (tall + GAP)
            if title:
                drawing.add(Text(title, (x + 8.0, y + 12.0), 12.0, theme.text, "left", True))
            picture = thumbnail(mesh, (CELL, CELL), theme)
            drawing.add(*(shifted(shape, x, y + head) for shape in picture.shapes))
            _add_score(drawing, theme, mesh, x + 8.0, y + head + CELL + 12.0)
        return drawing


def _add_score(drawing: Drawing, theme: Theme, mesh: HalfEdgeMesh, x: float, y: float) -> None:
    solved = mesh.score == mesh.optimum
    text = f"s {mesh.score}"
    words = "at the optimum" if solved else f"s* {mesh.optimum}"
    colour = theme.accent if solved else theme.muted
    drawing.add(
        Text(text, (x, y), 14.0, theme.text, "left", True),
        Text(words, (x + text_width(text, 14.0, True) + 8.0, y), 12.0, colour, "left", solved),
    )
