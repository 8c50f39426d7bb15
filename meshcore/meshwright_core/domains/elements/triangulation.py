"""Calls Triangle: constrained Delaunay triangulations with bounds on edges, areas and angles."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import shapely
import triangle
from numpy.typing import NDArray

from meshwright_core.core.time_limit import SECONDS, check_time, refuse_longer, time_left
from meshwright_core.domains.elements import triangle_process
from meshwright_core.errors import MeshError

Points = NDArray[np.float64]
Elements = NDArray[np.int64]

MAX_TRIANGLES = 4_000_000
"""What a mesh may need before the request is refused."""

_ROUNDS = 200
_FIRST_MARKER = 2
"""Triangle gives 0 and 1 a meaning of their own."""
_FEW, _NEAR = 20_000, 1e-5
"""Points, and their distance from each other and from sides as a share of the size: with more, or
less, Triangle runs in a process of its own."""
_PER_SECOND, _LEAST = 40_000, 1000
"""Points that Triangle inserts in a second at least, and what it may always insert."""
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
        not _is_tame(points, segments, size),
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


def _triangle(
    points: Points, segments: Elements, holes: Points, bounds: Bounds, apart: bool = False
) -> Triangulation:
    """Call Triangle, and again while an edge is too long; input points keep their numbers.

    A triangle with a long edge that is far above the area of the equilateral one is brought down
    to that; any other loses at least a tenth, so that Triangle must cut it.

    apart: in a process of its own, which can be ended.
    """
    markers = np.arange(len(segments))[:, None] + _FIRST_MARKER
    mesh: dict[str, Any] = {"vertices": points, "segments": segments, "segment_markers": markers}
    if len(holes):
        mesh["holes"] = holes
    quality = f"q{bounds.min_angle:.6f}" if bounds.min_angle > 0 else ""
    area = "" if bounds.max_area is None else f"a{bounds.max_area:.30f}"
    mesh = _call(mesh, f"p{quality}{area}", apart)
    if bounds.max_edge is None:
        return _result(mesh)
    target = math.sqrt(3) / 4 * bounds.max_edge**2
    for _ in range(_ROUNDS):
        check_time()
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
        mesh = _call(mesh, f"rp{quality}a", apart)
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


def _is_tame(points: Points, segments: Elements, size: float) -> bool:
    """Whether a call of Triangle is sure to end soon: a few points, none near another or a side."""
    if len(points) > _FEW:
        return False
    margin = _NEAR * size
    spots = shapely.points(points)
    tree = shapely.STRtree(spots)
    if len(tree.query(spots, predicate="dwithin", distance=margin)[0]) > len(points):
        return False
    sides = shapely.linestrings(points[segments])
    # each side is near its own two ends
    return len(tree.query(sides, predicate="dwithin", distance=margin)[0]) <= 2 * len(segments)


def _call(mesh: dict[str, Any], switches: str, apart: bool) -> dict[str, Any]:
    allowed = MAX_TRIANGLES // 2
    # Triangle cannot be interrupted, but it can be held to what it makes in the time that is left
    in_time = int(min(allowed, max(_LEAST, _PER_SECOND * time_left())))
    switches = f"{switches}S{in_time}"
    result: dict[str, Any]
    if apart:
        seconds = min(time_left(), SECONDS)
        try:
            result = triangle_process.triangulate(mesh, switches, max(seconds, 1.0))
        except triangle_process.TriangleStopped as error:
            raise MeshError(
                "The domain could not be triangulated within the time limit: some of its points "
                "or sides all but touch, or there are too many."
            ) from error
    else:
        result = triangle.triangulate(mesh, switches)
    inserted = len(result["vertices"]) - len(mesh["vertices"])
    # points that Triangle has deleted again count among those it makes
    if in_time < allowed and inserted >= 0.9 * in_time:
        refuse_longer()
    if inserted >= allowed:
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
