"""From blocks to elements: dividing chords until every element has a good shape.

All edges that lie across from one another in quads, a chord, are divided into the same number of
pieces. That adds regular vertices only, so s stays as it is. Chords are divided one at a time, each
time one that an element needs whose pieces are worst, until all pieces reach the wanted shape.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.core.arrays import TWIN
from meshwright_core.core.components import components
from meshwright_core.core.mesh_boundary import Seats
from meshwright_core.errors import MeshError
from meshwright_core.geometry.edge_parts import EdgeParts
from meshwright_core.geometry.quality import scaled_jacobian
from meshwright_core.mesh import HalfEdgeMesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from meshwright_core.geometry.size_field import SizeField

MOST = 200_000
"""Elements that a division may lead to."""
_FIRST, _SECOND = (0, 0, 2, 2), (3, 1, 1, 3)
"""Sides of each corner of an element that its first chord crosses, and that its second does."""
_SAMPLES = 33
"""Places at which the size along an edge is looked up."""


def chords(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m, 2) the chord that crosses sides 0 and 2, and the one that crosses sides 1 and 3, of each
    element, in the order of `mesh.elements()`; numbered from 0.
    """
    ids = mesh.element_ids()
    halfedges = (4 * ids[:, None] + np.arange(4)).ravel()
    row = np.full(4 * (int(ids.max(initial=0)) + 1), -1, np.int64)
    row[halfedges] = np.arange(len(halfedges))
    twin = mesh.arrays.edge[halfedges, TWIN]
    inner = np.flatnonzero(twin >= 0)
    a = np.concatenate([np.arange(len(halfedges)), inner])
    b = np.concatenate([np.arange(len(halfedges)) ^ 2, row[twin[inner]]])
    _, label = components(a, b, len(halfedges))
    found: np.ndarray = label.reshape(-1, 4)[:, :2].copy()
    return found


def divisions(mesh: HalfEdgeMesh, least: float) -> np.ndarray:
    """(chords,) into how many pieces each chord is divided so that, as far as parallelograms tell,
    every piece has a shape of `least` or as good a one as its skewness permits.

    Raises MeshError for triangles, or where more than :data:`MOST` elements would result.
    """
    if mesh.k != 4:
        raise MeshError("Only meshes of quads have chords that can be divided.")
    crossing = chords(mesh)
    corners = mesh.points[mesh.elements()]
    side = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    # the pieces at a corner have its angle and are as long as its own two sides permit
    ratio = side[:, _FIRST] / np.maximum(side[:, _SECOND], 1e-300)
    pieces = np.ones(int(crossing.max(initial=0)) + 1, np.int64)
    wanted = np.minimum(least / np.maximum(_corner_sines(mesh, corners, side), 1e-6), 0.98)
    # 2 sine / (r + 1 / r) >= least for the ratio r of the sides
    largest = 1.0 / wanted + np.sqrt(1.0 / wanted**2 - 1.0)
    high, low = (ratio / largest).max(axis=1), (ratio * largest).min(axis=1)
    while True:
        now = pieces[crossing[:, 1]] / pieces[crossing[:, 0]]
        long_first, long_second = high * now, 1.0 / np.maximum(low * now, 1e-300)
        worst = np.maximum(long_first, long_second)
        # where both directions are too long in turn no division helps
        worst[(long_first > 1.0) & (long_second > 1.0)] = 0.0
        e = int(worst.argmax()) if len(worst) else 0
        if not len(worst) or worst[e] <= 1.0:
            return pieces
        pieces[crossing[e, 0 if long_first[e] >= long_second[e] else 1]] += 1
        if int(pieces[crossing].prod(axis=1).sum()) > MOST:
            raise MeshError(f"A shape of {least:g} takes more than {MOST:,} elements.")


def _corner_sines(mesh: HalfEdgeMesh, corners: np.ndarray, side: np.ndarray) -> np.ndarray:
    """(m, 4) sine of each corner; where sides bend, the least one of the element for all four.

    corners: (m, 4, 3) places; side: (m, 4) lengths of the sides, each from its corner on.
    """
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(-ahead, 1, axis=1)
    area = np.linalg.norm(np.cross(ahead, back), axis=2)
    sines = area / np.maximum(side * np.roll(side, 1, axis=1), 1e-300)
    least = scaled_jacobian(mesh)[:, None]
    found: np.ndarray = np.where(np.abs(sines.min(axis=1)[:, None] - least) < 1e-9, sines, least)
    return found


def divided(
    mesh: HalfEdgeMesh, pieces: NDArray[np.int64], field: SizeField | None = None
) -> HalfEdgeMesh:
    """The mesh with chord c divided into pieces[c], in the order of :func:`chords`.

    New vertices lie on the true edges and inside by transfinite interpolation. s, s*, corners,
    desired degrees, curves and regions stay. field: edges are divided in proportion to the sizes
    that it has along them; by default evenly.
    """
    crossing, ids, elements = chords(mesh), mesh.element_ids(), mesh.elements()
    live = mesh.vertices()
    row = np.full(mesh.slots, -1, np.int64)
    row[live] = np.arange(len(live))
    edges = _DividedEdges(mesh, pieces[crossing], len(live), field)
    inner = (pieces[crossing] - 1).prod(axis=1)
    points = np.zeros((edges.stop + int(inner.sum()), 3))
    points[: len(live)], points[len(live) : edges.stop] = mesh.points[live], edges.points
    quads, first = [], edges.stop
    for e, corner in enumerate(row[elements].tolist()):
        n, m = (int(pieces[c]) for c in crossing[e])
        grid = np.full((m + 1, n + 1), -1, np.int64)
        share = []
        for i in range(4):
            made, shares = edges.along(4 * e + i)
            side = np.concatenate([[corner[i]], made, [corner[(i + 1) % 4]]])
            backwards = i >= 2
            share.append(1.0 - shares[::-1] if backwards else shares)
            _rim(grid, i)[:] = side[::-1] if backwards else side
        grid[1:-1, 1:-1] = first + np.arange((m - 1) * (n - 1)).reshape(m - 1, n - 1)
        first += (m - 1) * (n - 1)
        _interpolate(points, grid, share)
        cells = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1)
        quads.append(cells.reshape(-1, 4))
    count = len(points)
    curve, t = np.full(count, -1, np.int64), np.zeros(count)
    curve[: len(live)], t[: len(live)] = mesh.curve_ids()[live], mesh.parameters()[live]
    curve[len(live) : edges.stop], t[len(live) : edges.stop] = edges.curve, edges.parameter
    geometric, desired = np.zeros(count, bool), np.full(count, 4)
    geometric[: len(live)], desired[: len(live)] = mesh.geometric()[live], mesh.desired()[live]
    desired[len(live) : edges.stop][edges.outer] = 3
    return HalfEdgeMesh.from_elements(
        points, np.vstack(quads), geometric, desired,
        boundary=mesh.boundary_info.renumbered(row), seats=Seats(curve, t),
        regions=np.repeat(mesh.arrays.region[ids], pieces[crossing].prod(axis=1)),
    )  # fmt: skip


class _DividedEdges:
    """The new vertices on all edges of a mesh, each edge once.

    Args:
        mesh: of quads.
        pieces: (m, 2) of sides 0 and 2, and of sides 1 and 3, of each element.
        first: number of the first new vertex.
        field: see :func:`divided`.
    """

    def __init__(
        self, mesh: HalfEdgeMesh, pieces: np.ndarray, first: int, field: SizeField | None
    ) -> None:
        halfedges = (4 * mesh.element_ids()[:, None] + np.arange(4)).ravel()
        twin = mesh.arrays.edge[halfedges, TWIN]
        low = np.where(twin >= 0, np.minimum(twin, halfedges), halfedges)
        own, self._edge = np.unique(low, return_inverse=True)
        self._forward = low == halfedges
        number = np.zeros(len(own), np.int64)
        number[self._edge] = np.tile(pieces, (1, 2)).ravel()
        parts = EdgeParts.of(mesh.arrays, own, 4)
        self._start = np.concatenate([[0], np.cumsum(number - 1)])
        rows = np.repeat(np.arange(len(own)), number - 1)
        step = np.arange(len(rows)) - self._start[rows] + 1
        wanted = step / number[rows]
        self._shares = wanted if field is None else _graded(parts, rows, wanted, field)
        self._first, self.stop = first, first + len(rows)
        self.points = parts.points(rows, self._shares)
        self.curve = parts.curve[rows].astype(np.int64)
        self.outer = (twin[np.searchsorted(halfedges, own)] < 0)[rows]
        span = parts.span[rows]
        t = span[:, 0] + self._shares * (span[:, 1] - span[:, 0])
        lengths = np.append(mesh.boundary_info.lengths(), 1.0)
        closed = np.append(mesh.boundary_info.curves.closed.astype(bool), False)
        self.parameter = np.where(closed[self.curve], np.mod(t, lengths[self.curve]), t)
        self.parameter[self.curve < 0] = 0.0

    def along(self, place: int) -> tuple[np.ndarray, np.ndarray]:
        """New vertices along side `place` (4 e + i for the e-th element), and the shares of the
        side at which all its vertices lie, from 0 to 1.
        """
        edge = self._edge[place]
        part = slice(self._start[edge], self._start[edge + 1])
        made, shares = self._first + np.arange(part.start, part.stop), self._shares[part]
        if not self._forward[place]:
            made, shares = made[::-1], 1.0 - shares[::-1]
        return made, np.concatenate([[0.0], shares, [1.0]])


def _graded(parts: EdgeParts, rows: np.ndarray, wanted: np.ndarray, field: SizeField) -> np.ndarray:
    """(p,) where edges `rows` (p,) are to be cut so that `wanted` (p,) of their length, measured
    in sizes of the field, lies before.
    """
    used = np.unique(rows)
    shares = wanted.copy()
    if not len(used):
        return shares
    stops = np.linspace(0.0, 1.0, _SAMPLES)
    grown = np.concatenate(
        [np.zeros((len(used), 1)), np.cumsum(_pieces_wanted(parts, used, field), axis=1)], axis=1
    )
    grown /= grown[:, -1:]
    for place, edge in enumerate(used.tolist()):
        mine = slice(*np.searchsorted(rows, [edge, edge + 1]))
        shares[mine] = np.interp(wanted[mine], grown[place], stops)
    return shares


def _pieces_wanted(parts: EdgeParts, edges: np.ndarray, field: SizeField) -> np.ndarray:
    """(n, _SAMPLES - 1) how many pieces of the field's size each short part of an edge takes."""
    w = np.linspace(0.0, 1.0, _SAMPLES)
    at = parts.points(np.repeat(edges, _SAMPLES), np.tile(w, len(edges)))
    at = at.reshape(len(edges), _SAMPLES, 3)
    middle = 0.5 * (at[:, 1:] + at[:, :-1])
    sizes = field.at(middle.reshape(-1, 3)).reshape(len(edges), -1)
    found: np.ndarray = np.linalg.norm(np.diff(at, axis=1), axis=2) / sizes
    return found


def wanted_pieces(mesh: HalfEdgeMesh, field: SizeField) -> np.ndarray:
    """(m, 4) how many pieces of the field's size each side of each element takes, real numbers."""
    halfedges = (4 * mesh.element_ids()[:, None] + np.arange(4)).ravel()
    parts = EdgeParts.of(mesh.arrays, halfedges, 4)
    found = _pieces_wanted(parts, np.arange(len(halfedges)), field).sum(axis=1)
    return np.maximum(found, 1e-9).reshape(-1, 4)


def _rim(grid: np.ndarray, side: int) -> np.ndarray:
    """A side of a grid, from left to right or from below."""
    rim: np.ndarray = (grid[0], grid[:, -1], grid[-1], grid[:, 0])[side]
    return rim


def _interpolate(points: np.ndarray, grid: np.ndarray, share: list[np.ndarray]) -> None:
    """Write the points inside a grid (m + 1, n + 1) by transfinite interpolation of its rim.

    share: where the vertices of the four sides lie on them; between opposite sides the parameters
    are interpolated linearly.
    """
    low, right, high, left = (one[1:-1] for one in share)
    if not len(low) or not len(right):
        return
    across, up = (high - low)[None, :], (right - left)[:, None]
    u = (low[None, :] + left[:, None] * across) / (1.0 - across * up)
    v = (left[:, None] + u * up)[..., None]
    u = u[..., None]
    below, above = points[grid[0, 1:-1]][None], points[grid[-1, 1:-1]][None]
    before, behind = points[grid[1:-1, 0]][:, None], points[grid[1:-1, -1]][:, None]
    c = points[grid[[0, 0, -1, -1], [0, -1, 0, -1]]]
    place = (1 - v) * below + v * above + (1 - u) * before + u * behind
    place -= (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[2] + u * c[3])
    points[grid[1:-1, 1:-1]] = place


def divided_for_shape(mesh: HalfEdgeMesh, least: float) -> HalfEdgeMesh:
    """The mesh with chords divided until every element has a shape of `least` or more, see
    :func:`meshwright_core.geometry.element_shapes.element_shapes`, where its skewness permits.
    """
    return divided(mesh, divisions(mesh, least))
