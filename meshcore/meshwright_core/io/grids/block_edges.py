"""The edges of blocks as formats with geometry describe them: segments, arcs, splines."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.blocks.grid import BlockGrid

_STRAIGHT = 1e-9
"""Distance from a chord, relative to its length, up to which an edge is a segment."""
_ROUND = 1e-9
"""Distance from a circle, relative to its radius, up to which an edge is an arc."""
_LARGEST_ARC = np.radians(170.0)
_SAMPLES = 17
MOST_KNOTS = 400
"""Points inside an edge that a spline goes through, at most."""


class EdgeShape(NamedTuple):
    """The shape of a block edge."""

    kind: str
    """"line", "arc" or "spline"."""
    middle: np.ndarray
    """(3,) the point at half the length."""
    centre: np.ndarray
    """(3,) of an arc."""
    knots: np.ndarray
    """(k, 3) points between the ends of a spline."""


def edge_shape(grid: BlockGrid, edge: int) -> EdgeShape:
    """The shape of an edge of the grid, from its start to its end."""
    vertices = grid.edge_vertices(edge)
    if grid.structure.parts.curve[edge] < 0:
        return line_shape(grid.points[vertices])
    return curve_shape(grid, edge, vertices, (0.0, 1.0))


def line_shape(line: np.ndarray) -> EdgeShape:
    """The shape of a line through points (k + 1, 3) of a grid, off all curves."""
    nothing = np.zeros(3)
    if _off_chord(line) <= _STRAIGHT:
        return EdgeShape("line", 0.5 * (line[0] + line[-1]), nothing, line[1:-1])
    return EdgeShape("spline", line[len(line) // 2], nothing, _thinned(line[1:-1]))


def curve_shape(
    grid: BlockGrid, edge: int, vertices: np.ndarray, share: tuple[float, float]
) -> EdgeShape:
    """The shape of a part of an edge on a curve: between two shares of its length, where these
    vertices (k + 1,) of the grid lie.
    """
    line = grid.points[vertices]
    nothing = np.zeros(3)
    at = grid.structure.edge_points(np.full(_SAMPLES, edge), np.linspace(*share, _SAMPLES))
    middle = at[_SAMPLES // 2]
    if _off_chord(at) <= _STRAIGHT:
        return EdgeShape("line", middle, nothing, line[1:-1])
    centre = _centre(at[0], middle, at[-1])
    radius = np.linalg.norm(at - centre, axis=1)
    a, b = (at[0] - centre) / radius[0], (middle - centre) / radius[0]
    turn = 2.0 * np.arccos(np.clip(a @ b, -1.0, 1.0))
    if np.ptp(radius) <= _ROUND * radius[0] and turn < _LARGEST_ARC:
        return EdgeShape("arc", middle, centre, line[1:-1])
    knots = _thinned(line[1:-1])
    if len(knots) < _SAMPLES - 2:
        knots = at[1:-1]
    return EdgeShape("spline", middle, nothing, knots)


def _off_chord(line: np.ndarray) -> float:
    chord = line[-1] - line[0]
    length = float(np.linalg.norm(chord))
    if length == 0.0:
        return np.inf
    along = (line - line[0]) @ chord / length
    away = np.linalg.norm(line - line[0] - along[:, None] * chord / length, axis=1)
    back = np.maximum(-along, along - length).max()
    return float(max(away.max(), back) / length)


def _centre(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """The centre of the circle through three points (3,)."""
    u, v = b - a, c - a
    normal = np.cross(u, v)
    square = float(normal @ normal)
    if square == 0.0:
        return np.full(3, np.inf)
    offset = np.cross((u @ u) * v - (v @ v) * u, normal) / (-2.0 * square)
    centre: np.ndarray = a - offset
    return centre


def _thinned(points: np.ndarray) -> np.ndarray:
    step = -(-len(points) // MOST_KNOTS) if len(points) else 1
    return points[::step]
