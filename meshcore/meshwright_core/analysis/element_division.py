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

MOST = 200_000
"""Elements that a division may lead to."""


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
    # of the two opposite sides the one that makes the ratio worse counts
    pieces = np.ones(int(crossing.max(initial=0)) + 1, np.int64)
    sine = np.maximum(scaled_jacobian(mesh), 1e-6)
    wanted = np.minimum(least / sine, 0.98)
    # 2 sine / (r + 1 / r) >= least for the ratio r of the sides
    largest = 1.0 / wanted + np.sqrt(1.0 / wanted**2 - 1.0)
    while True:
        first = side[:, (0, 2)] / pieces[crossing[:, 0]][:, None]
        second = side[:, (1, 3)] / pieces[crossing[:, 1]][:, None]
        long_first = first.max(axis=1) / np.maximum(second.min(axis=1), 1e-300) / largest
        long_second = second.max(axis=1) / np.maximum(first.min(axis=1), 1e-300) / largest
        worst = np.maximum(long_first, long_second)
        # where both directions are too long in turn no division helps
        worst[(long_first > 1.0) & (long_second > 1.0)] = 0.0
        e = int(worst.argmax()) if len(worst) else 0
        if not len(worst) or worst[e] <= 1.0:
            return pieces
        pieces[crossing[e, 0 if long_first[e] >= long_second[e] else 1]] += 1
        if int(pieces[crossing].prod(axis=1).sum()) > MOST:
            raise MeshError(f"A shape of {least:g} takes more than {MOST:,} elements.")


def divided(mesh: HalfEdgeMesh, pieces: NDArray[np.int64]) -> HalfEdgeMesh:
    """The mesh with chord c divided into pieces[c], in the order of :func:`chords`.

    New vertices lie on the true edges and inside by transfinite interpolation. s, s*, corners,
    desired degrees, curves and regions stay.
    """
    crossing, ids, elements = chords(mesh), mesh.element_ids(), mesh.elements()
    live = mesh.vertices()
    row = np.full(mesh.slots, -1, np.int64)
    row[live] = np.arange(len(live))
    points = [*mesh.points[live]]
    curve, t = mesh.curve_ids()[live].tolist(), mesh.parameters()[live].tolist()
    lengths = mesh.boundary_info.lengths()
    edges: dict[tuple[int, int], list[int]] = {}
    twin = mesh.arrays.edge[:, TWIN]

    def edge(h: int, a: int, b: int, count: int) -> list[int]:
        """Vertices of a divided edge from a to b, along half-edge h."""
        if (a, b) not in edges:
            shares = np.arange(1, count) / count
            part = EdgeParts.of(mesh.arrays, np.array([h]), mesh.k)
            on = int(part.curve[0])
            places = part.points(np.zeros(count - 1, np.int64), shares)
            made = []
            for w, place in zip(shares, places, strict=True):
                made.append(len(points))
                points.append(place)
                low, high = part.span[0]
                along = low + w * (high - low)
                curve.append(on)
                t.append(float(along % lengths[on]) if on >= 0 else 0.0)
            edges[a, b] = [int(row[a]), *made, int(row[b])]
            edges[b, a] = edges[a, b][::-1]
        return edges[a, b]

    quads, regions = [], []
    region = mesh.arrays.region[ids]
    for e, corner in enumerate(elements.tolist()):
        n, m = (int(pieces[c]) for c in crossing[e])
        h = 4 * int(ids[e])
        sides = [edge(h + i, corner[i], corner[(i + 1) % 4], (n, m)[i % 2]) for i in range(4)]
        grid = np.full((m + 1, n + 1), -1, np.int64)
        grid[0], grid[:, n], grid[m], grid[:, 0] = (
            sides[0], sides[1], sides[2][::-1], sides[3][::-1],
        )  # fmt: skip
        for j in range(1, m):
            for i in range(1, n):
                u, v = i / n, j / m
                at = [points[k] for k in (grid[0, i], grid[m, i], grid[j, 0], grid[j, n])]
                c = [points[k] for k in (grid[0, 0], grid[0, n], grid[m, 0], grid[m, n])]
                place = (1 - v) * at[0] + v * at[1] + (1 - u) * at[2] + u * at[3]
                place = place - (1 - v) * ((1 - u) * c[0] + u * c[1])
                place = place - v * ((1 - u) * c[2] + u * c[3])
                grid[j, i] = len(points)
                points.append(place)
                curve.append(-1)
                t.append(0.0)
        cells = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=-1)
        quads.append(cells.reshape(-1, 4))
        regions += [int(region[e])] * (n * m)
    made = np.vstack(quads)
    geometric = np.zeros(len(points), bool)
    geometric[: len(live)] = mesh.geometric()[live]
    outer = np.zeros(len(points), bool)
    for (a, b), chain in edges.items():
        h = mesh.halfedge(a, b)
        if h >= 0 and twin[h] < 0:
            outer[chain] = True
    desired = np.where(outer, 3, 4)
    desired[: len(live)] = mesh.desired()[live]
    return HalfEdgeMesh.from_elements(
        np.array(points), made, geometric, desired,
        boundary=mesh.boundary_info.renumbered(row),
        seats=Seats(np.array(curve), np.array(t)), regions=np.array(regions),
    )  # fmt: skip


def divided_for_shape(mesh: HalfEdgeMesh, least: float) -> HalfEdgeMesh:
    """The mesh with chords divided until every element has a shape of `least` or more, see
    :func:`meshwright_core.geometry.element_shapes.element_shapes`, where its skewness permits.
    """
    return divided(mesh, divisions(mesh, least))
