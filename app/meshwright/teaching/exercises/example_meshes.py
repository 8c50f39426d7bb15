"""The small example meshes of the lessons, by name."""

from __future__ import annotations

import difflib
from collections.abc import Callable

import numpy as np

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.geometry import smoothing


def patch(name: str) -> HalfEdgeMesh:
    """A new copy of the small mesh called ``name``, one of :data:`PATCHES`.

    Raises MeshError for an unknown name.
    """
    if name not in PATCHES:
        near = difflib.get_close_matches(str(name), PATCHES, 3, 0.5)
        hint = f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(PATCHES)}."
        raise MeshError(f"There is no patch named {name!r}; {hint}")
    return PATCHES[name]()


def grid(columns: int, rows: int) -> HalfEdgeMesh:
    """A grid of unit squares; its corners are geometric, s is 0."""
    points = [(x, y) for y in range(rows + 1) for x in range(columns + 1)]
    return HalfEdgeMesh.from_elements(np.array(points, dtype=float), _squares(columns, rows))


def _squares(columns: int, rows: int) -> np.ndarray:
    wide = columns + 1
    first = [y * wide + x for y in range(rows) for x in range(columns)]
    return np.array([(i, i + 1, i + wide + 1, i + wide) for i in first])


def fan() -> HalfEdgeMesh:
    """Six triangles around a vertex, s 0."""
    return _hexagon(1)


def hexagon() -> HalfEdgeMesh:
    """Twenty-four triangles in two rings around a vertex, s 0."""
    return _hexagon(2)


def _hexagon(rings: int) -> HalfEdgeMesh:
    reach = range(-rings, rings + 1)
    places = [(i, j) for j in reach for i in reach if abs(i + j) <= rings]
    number = {place: n for n, place in enumerate(places)}
    rows = []
    for i, j in places:
        right, above, left = (i + 1, j), (i, j + 1), (i - 1, j + 1)
        for corners in ([(i, j), right, above], [(i, j), above, left]):
            if all(corner in number for corner in corners):
                rows.append([number[corner] for corner in corners])
    points = np.array([(i + 0.5 * j, np.sqrt(0.75) * j) for i, j in places])
    return HalfEdgeMesh.from_elements(points, np.array(rows))


def trap() -> HalfEdgeMesh:
    """A hexagon with two more vertices inside the triangle 9, 10, 14. The link condition forbids
    the collapse of its sides: their ends share the third corner besides the opposite vertices.
    """
    mesh = hexagon()
    rows = [row for row in mesh.elements().tolist() if set(row) != {9, 10, 14}]
    points = np.vstack([mesh.points, (0.3, 0.26, 0.0), (0.64, 0.34, 0.0)])
    rows += [(9, 10, 19), (19, 10, 20), (20, 10, 14), (19, 20, 14), (9, 19, 14)]
    return HalfEdgeMesh.from_elements(points, np.array(rows))


def flipped_grid() -> HalfEdgeMesh:
    """A grid of 3 by 3 after one flip to the left: s 4, s* 0."""
    return _edited(grid(3, 3), ("flip_left", 5, 6))


def split_hexagon() -> HalfEdgeMesh:
    """A hexagon after the split of an edge: s 4, s* 0."""
    return _edited(hexagon(), ("split", 9, 10))


def knot() -> HalfEdgeMesh:
    """A hexagon after two adjacent flips: s 4, s* 0; no single operation lowers s."""
    return _edited(hexagon(), ("flip", 5, 9), ("flip", 10, 14))


def doublet() -> HalfEdgeMesh:
    """A grid of 3 by 3 whose middle quad is cut by a vertex with two edges: s 4, s* 0."""
    mesh = grid(3, 3)
    rows = [row for row in mesh.elements().tolist() if row != [5, 6, 10, 9]]
    points = np.vstack([mesh.points, (1.6, 1.4, 0.0)])
    rows += [(5, 6, 10, 16), (5, 16, 10, 9)]
    return HalfEdgeMesh.from_elements(points, np.array(rows))


def three_to_one() -> HalfEdgeMesh:
    """A rectangle with three edges at the bottom and one at the top: s 4, s* 0."""
    points = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 2), (0, 2), (1, 1), (2, 1)]
    rows = [(0, 1, 6, 5), (1, 2, 7, 6), (2, 3, 4, 7), (6, 7, 4, 5)]
    return HalfEdgeMesh.from_elements(np.array(points, dtype=float), np.array(rows))


def fine_l() -> HalfEdgeMesh:
    """An L of 5 by 5 squares without 2 by 3 of them: s 0, three blocks."""
    wide, tall, low = 5, 5, 2
    kept = [(x, y) for y in range(tall) for x in range(wide) if x < 3 or y < low]
    squares = [((x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)) for x, y in kept]
    points = sorted({corner for square in squares for corner in square}, key=lambda p: p[::-1])
    number = {point: i for i, point in enumerate(points)}
    rows = [[number[corner] for corner in square] for square in squares]
    return HalfEdgeMesh.from_elements(np.array(points, dtype=float), np.array(rows))


def _edited(mesh: HalfEdgeMesh, *edits: tuple[str, int, int]) -> HalfEdgeMesh:
    """The smoothed mesh after edits (operation, origin, target), without a history."""
    for operation, a, b in edits:
        mesh.apply(operation, mesh.halfedge(a, b))
    smoothing.relax(mesh)
    return mesh.copy()


PATCHES: dict[str, Callable[[], HalfEdgeMesh]] = {
    "grid": lambda: grid(3, 3),
    "wide grid": lambda: grid(4, 3),
    "fine l": fine_l,
    "flipped grid": flipped_grid,
    "doublet": doublet,
    "three to one": three_to_one,
    "fan": fan,
    "hexagon": hexagon,
    "split hexagon": split_hexagon,
    "knot": knot,
    "trap": trap,
}
"""The function that makes each mesh."""
