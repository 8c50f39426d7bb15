"""Calls Triangle: constrained Delaunay triangulations with bounds on edges, areas and angles."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import triangle
from numpy.typing import NDArray

from meshwright_core.errors import MeshError

Points = NDArray[np.float64]
Elements = NDArray[np.int64]

MAX_TRIANGLES = 4_000_000
"""What a mesh may need before the request is refused."""

_ROUNDS = 200
_FIRST_MARKER = 2
"""Triangle gives 0 and 1 a meaning of their own."""
_NOTHING = 1e-30
"""Coordinates below this share of the largest one are zero: squares of smaller distances
underflow, on which Triangle crashes."""


class Bounds(NamedTuple):
    """What the triangles must keep; points are inserted where they do not."""

    min_angle: float = 0.0
    """Degrees that Triangle aims at; 0: no aim."""
    max_edge: float | None = None
    max_area: float | None = None


class Triangulation(NamedTuple):
    """Triangles with the pieces of the segments between them."""

    points: Points
    """(n, 2), those that were given first."""
    triangles: Elements
    """(m, 3) counter-clockwise."""
    segments: Elements
    """(s, 2) the edges that the given segments consist of."""
    owners: Elements
    """(s,) the given segment of each."""


def triangulated(
    points: Points, segments: Elements, holes: Points, size: float, bounds: Bounds, seed: int = 0
) -> Triangulation:
    """Triangulate what segments enclose; MeshError if too many triangles would be needed.

    MeshError also for fewer than three points, two that coincide, or one that is not finite.

    Args:
        points: (n, 2).
        segments: (s, 2) that do not cross.
        holes: (h, 2) a point in each hole.
        size: diameter of the points.
        bounds: of edges, areas and angles.
        seed: 0 is the plain triangulation. Any other value turns and renumbers the input of
            Triangle first, so that it chooses otherwise where it can.
    """
    # exact, and keeps the areas that go to Triangle in plain decimals
    scale = 2.0 ** -math.frexp(size)[1]
    turn, order = _shuffle(len(points), seed)
    place = np.argsort(order)
    raw = _triangle(
        scale * _fit(points)[order] @ turn,
        place[segments],
        scale * holes @ turn,
        Bounds(
            bounds.min_angle,
            None if bounds.max_edge is None else scale * bounds.max_edge,
            None if bounds.max_area is None else scale**2 * bounds.max_area,
        ),
    )
    triangles = raw.triangles
    if np.linalg.det(turn) < 0:
        triangles = triangles[:, ::-1]
    result = raw.points @ turn.T / scale
    renumbered = np.arange(len(result))
    renumbered[: len(points)] = order
    result[: len(points)] = points
    return Triangulation(result, renumbered[triangles], renumbered[raw.segments], raw.owners)


def plain_triangles(points: Points, segments: Elements, bounds: Bounds) -> tuple[Points, Elements]:
    """Points and triangles of what segments enclose, without a shuffle; for benchmark meshes."""
    found = _triangle(_fit(points), segments, np.empty((0, 2)), bounds)
    return found.points, found.triangles


def _triangle(points: Points, segments: Elements, holes: Points, bounds: Bounds) -> Triangulation:
    """Call Triangle, and again while an edge is too long; input points keep their numbers.

    A triangle with a long edge that is far above the area of the equilateral one is brought down
    to that; any other loses at least a tenth, so that Triangle must cut it.
    """
    markers = np.arange(len(segments))[:, None] + _FIRST_MARKER
    mesh: dict[str, Any] = {"vertices": points, "segments": segments, "segment_markers": markers}
    if len(holes):
        mesh["holes"] = holes
    quality = f"q{bounds.min_angle:.6f}" if bounds.min_angle > 0 else ""
    area = "" if bounds.max_area is None else f"a{bounds.max_area:.30f}"
    mesh = _call(mesh, f"p{quality}{area}")
    if bounds.max_edge is None:
        return _result(mesh)
    target = math.sqrt(3) / 4 * bounds.max_edge**2
    for _ in range(_ROUNDS):
        found = _result(mesh)
        ends = found.points[found.triangles]
        sides = ends - ends[:, [1, 2, 0]]
        long = (np.einsum("ijk,ijk->ij", sides, sides) > bounds.max_edge**2).any(axis=1)
        if not long.any():
            return found
        now = triangle_areas(found.points, found.triangles)
        limit = np.where(now > 2 * target, target, 0.9 * now)
        kept = ("vertices", "triangles", "segments", "segment_markers")
        mesh = {name: mesh[name] for name in kept}
        mesh["triangle_max_area"] = np.where(long, limit, -1.0)[:, None]
        mesh = _call(mesh, f"rp{quality}a")
    raise MeshError("Triangle did not bring all edges below the requested longest edge.")


def _fit(points: Points) -> Points:
    """The points (n, 2), with coordinates that are next to nothing set to zero.

    Triangle is native code that crashes on numbers that are not finite, and on segments between
    points of which two are the same, so both are refused here with MeshError.
    """
    if not np.isfinite(points).all():
        raise MeshError("The domain could not be triangulated: a coordinate is not finite.")
    if len(points) < 3:
        raise MeshError("The domain could not be triangulated: it has fewer than three points.")
    kept = np.where(np.abs(points) < _NOTHING * np.abs(points).max(), 0.0, points)
    in_order = kept[np.lexsort(kept.T)]
    if (in_order[1:] == in_order[:-1]).all(axis=1).any():
        raise MeshError("The domain could not be triangulated: two of its points coincide.")
    return kept


def _call(mesh: dict[str, Any], switches: str) -> dict[str, Any]:
    allowed = MAX_TRIANGLES // 2
    result: dict[str, Any] = triangle.triangulate(mesh, f"{switches}S{allowed}")
    if len(result["vertices"]) - len(mesh["vertices"]) >= allowed:
        raise MeshError(
            f"The mesh would need more than {MAX_TRIANGLES:,} triangles: "
            "ask for longer edges or smaller angles, or widen the thin parts of the domain."
        )
    return result


def _result(mesh: dict[str, Any]) -> Triangulation:
    triangles = mesh.get("triangles")
    if triangles is None or len(triangles) == 0:
        raise MeshError("The domain could not be triangulated: it is too thin somewhere.")
    points = np.asarray(mesh["vertices"], dtype=np.float64)
    owners = np.asarray(mesh["segment_markers"], dtype=np.int64).ravel() - _FIRST_MARKER
    segments = np.asarray(mesh["segments"], dtype=np.int64)
    return Triangulation(points, triangles.astype(np.int64), segments, owners)


def triangle_areas(points: Points, triangles: Elements) -> NDArray[np.float64]:
    """(m,) signed areas of triangles (m, 3)."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _shuffle(count: int, seed: int) -> tuple[Points, Elements]:
    """Return one of the eight exact turns of the plane and an order of `count` points."""
    if seed == 0:
        return np.eye(2), np.arange(count)
    rng = np.random.default_rng(seed)
    turn = np.diag(rng.choice([-1.0, 1.0], 2))
    if rng.random() < 0.5:
        turn = turn[::-1].copy()
    return turn, rng.permutation(count)
