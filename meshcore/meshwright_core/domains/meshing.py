"""Meshes from domains: triangles by Triangle, quads by Catmull-Clark splits or by pairing.

The functions that end in `_arrays` return ``(points (n, 2), elements (m, 3 or 4),
geometric (n,))``: numpy arrays, corners of the domain flagged as geometric; the others wrap them
in a half-edge mesh.
"""

from __future__ import annotations

import itertools
import math
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.irregularity import QUAD_STRAIGHT, TRIANGLE_STRAIGHT
from meshwright_core.core.time_limit import SECONDS, time_limit
from meshwright_core.domains.domain import Domain, Flags, Points
from meshwright_core.domains.elements import quadrangulation, triangulation
from meshwright_core.domains.elements.coarse_start import coarse, coarse_quads
from meshwright_core.domains.elements.refined_start import refined
from meshwright_core.domains.elements.side_edges import SideEdges
from meshwright_core.domains.elements.sided_elements import SidedElements
from meshwright_core.domains.elements.triangulation import (
    Bounds,
    plain_triangles,
    triangle_areas,
    triangulated,
)
from meshwright_core.domains.gallery import random_corners
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh

Elements = NDArray[np.int64]
Arrays = tuple[Points, Elements, Flags]
Quads = Literal["catmull-clark", "pairing"]

MIN_ANGLE = 28.6
"""Degrees that no angle of a triangle should be less than, as in the benchmark."""

BENCHMARK_EDGE = 0.4
"""Length that no edge of a benchmark triangle mesh exceeds."""

MAX_ANGLE = 34.0
"""Degrees; asking Triangle for more than this hardly ever ends."""

CURVED_ANGLE = 18.5
"""Degrees that Triangle aims at before Catmull-Clark splits of a domain with curved sides: just
above what a fan of twenty triangles in a circle has, which makes a centre of degree twenty."""

_HALVES = 0.99
"""Share of twice the longest edge that an edge on a curve has, so that its halves are shorter."""

_SECONDS_EACH = 1e-5
"""Seconds more for each triangle that the bounds ask for."""

_EDGE_SHARE = 0.2
"""The longest edge by default, as a share of the diameter; 0.4 for the benchmark's 2."""


def mesh_domain(
    domain: Domain,
    kind: str,
    max_edge: float | None = None,
    min_angle: float | None = None,
    max_area: float | None = None,
    seed: int = 0,
    quads: Quads = "catmull-clark",
    seconds: float | None = None,
) -> HalfEdgeMesh:
    """Mesh a domain.

    Boundary vertices that are no corners get the desired degree of a straight side, however the
    polyline turns there; all others that of equation 2 of the paper.

    Args:
        domain: what to mesh; its corners become the geometric vertices.
        kind: "tri" or "quad".
        max_edge: length that no edge of the result exceeds. Left out: a fifth of the domain's
            diameter for triangles and for pairing; no bound for Catmull-Clark.
        min_angle: degrees, the angle that Triangle aims at, 0 to 34 (0: no aim; small angles of
            the domain itself stay). Left out: 28.6 for triangles, for pairing, and with
            `max_edge` or `max_area`; else 18.5 if the domain has points that are no corners (its
            sides are curved, and without inserted points the triangles on them are flat), else 0.
        max_area: area that no triangle exceeds (for quads: no triangle before they are made).
        seed: 0 is the plain mesh. Any other value turns and renumbers the input of Triangle
            first, in a way that depends on the seed, so that it chooses otherwise where it can.
        quads: "catmull-clark" cuts each triangle into three quads; by default the triangles of a
            domain with straight sides have no points but its corners, as in the benchmark, and
            in a domain of curves or of regions well-shaped pairs of them are cut into four.
            "pairing" joins triangles in pairs, and cuts everything once more if some triangle
            stays alone.
        seconds: processor time that it may take. Left out: 30, and 10 more for each million
            triangles that the bounds ask for. A limit that holds already
            (:func:`meshwright_core.core.time_limit.time_limit`) stays.

    Raises:
        MeshError: an argument out of range, a mesh that would need too many triangles, or more
            time than it may take.
    """
    bounds = _bounds(domain, kind, max_edge, min_angle, max_area, quads)
    limit = SECONDS + _SECONDS_EACH * _expected(domain, bounds) if seconds is None else seconds
    with time_limit(limit):
        return _mesh(domain, kind, bounds, seed, quads)


def _mesh(domain: Domain, kind: str, bounds: Bounds, seed: int, quads: Quads) -> HalfEdgeMesh:
    if domain.sides is not None:
        return _sided(domain, kind, bounds, seed, quads).mesh(domain.sides)
    arrays = _polygon_arrays(domain, kind, bounds, seed, quads)
    mesh = HalfEdgeMesh.from_elements(*arrays)
    desired = mesh.desired()
    straight = TRIANGLE_STRAIGHT if kind == "tri" else QUAD_STRAIGHT
    desired[mesh.boundary() & ~arrays[2]] = straight
    if (desired == mesh.desired()).all():
        return mesh
    return HalfEdgeMesh.from_elements(*arrays, desired_degree=desired)


def mesh_arrays(
    domain: Domain,
    kind: str,
    max_edge: float | None = None,
    min_angle: float | None = None,
    max_area: float | None = None,
    seed: int = 0,
    quads: Quads = "catmull-clark",
) -> Arrays:
    """Return the arrays of `mesh_domain`."""
    bounds = _bounds(domain, kind, max_edge, min_angle, max_area, quads)
    if domain.sides is not None:
        found = _sided(domain, kind, bounds, seed, quads)
        return found.points, found.elements, found.node >= 0
    return _polygon_arrays(domain, kind, bounds, seed, quads)


def _polygon_arrays(domain: Domain, kind: str, bounds: Bounds, seed: int, quads: Quads) -> Arrays:
    """The arrays of a mesh of a polygon."""
    points, triangles, geometric = triangle_arrays(domain, *bounds, seed)
    if kind == "tri":
        return points, triangles, geometric
    if quads == "catmull-clark":
        return quadrangulation.catmull_clark(points, [triangles], geometric)
    paired, alone = quadrangulation.pair(points, triangles)
    if len(alone) == 0:
        return quadrangulation.without_doublets(points, paired, geometric)
    points, triangles, geometric = triangle_arrays(domain, *_doubled(bounds), seed)
    paired, alone = quadrangulation.pair(points, triangles)
    arrays = quadrangulation.catmull_clark(points, [paired, alone], geometric)
    return quadrangulation.without_doublets(*arrays)


def _sided(domain: Domain, kind: str, bounds: Bounds, seed: int, quads: Quads) -> SidedElements:
    """The elements of a domain of curves."""
    sides = domain.sides
    assert sides is not None
    edges = SideEdges(sides)
    if bounds == Bounds():
        if kind == "quad" and quads == "catmull-clark":
            return coarse_quads(edges, domain.diameter, seed)
        found = coarse(edges, domain.diameter, seed).elements()
    else:
        found = refined(edges, domain.diameter, bounds, seed)
    if kind == "tri":
        return found
    if quads == "catmull-clark":
        return found.catmull_clark([found.elements], [found.regions])
    blocks, regions = found.paired()
    if len(blocks[1]) == 0:
        return found.with_elements(blocks[0], regions[0]).without_doublets()
    found = refined(SideEdges(sides), domain.diameter, _doubled(bounds), seed)
    return found.catmull_clark(*found.paired()).without_doublets()


def _bounds(
    domain: Domain,
    kind: str,
    max_edge: float | None,
    min_angle: float | None,
    max_area: float | None,
    quads: Quads,
) -> Bounds:
    """The bounds of the triangles for a request; MeshError for an argument out of range."""
    _refuse_kind(kind)
    if quads not in ("catmull-clark", "pairing"):
        raise MeshError(f'Quads are made by "catmull-clark" or "pairing", not by {quads!r}.')
    if kind == "quad" and quads == "catmull-clark":
        # a quad's edges are halves of a triangle's edges and thirds of its medians
        bound = None if max_edge is None else 2 * _positive(max_edge, "longest edge")
        if bound is not None and domain.has_curves and domain.sides is not None:
            bound *= _HALVES
        if min_angle is None:
            bent = domain.sides is None and domain.has_curves
            bounded = max_edge is not None or max_area is not None
            min_angle = MIN_ANGLE if bounded else CURVED_ANGLE if bent else 0.0
        bounds = Bounds(min_angle, bound, max_area)
    else:
        bound = _EDGE_SHARE * domain.diameter if max_edge is None else max_edge
        bounds = Bounds(MIN_ANGLE if min_angle is None else min_angle, bound, max_area)
    _check(domain, bounds)
    return bounds


def _doubled(bounds: Bounds) -> Bounds:
    """With edges twice as long, which are halved afterwards."""
    assert bounds.max_edge is not None
    return bounds._replace(max_edge=2 * bounds.max_edge)


def _check(domain: Domain, bounds: Bounds) -> None:
    """Raise MeshError for a bound out of range, or one that needs too many triangles."""
    if bounds.max_edge is not None:
        _positive(bounds.max_edge, "longest edge")
    if bounds.max_area is not None:
        _positive(bounds.max_area, "largest area")
    if not 0 <= bounds.min_angle <= MAX_ANGLE:
        raise MeshError(f"The smallest angle must lie between 0 and {MAX_ANGLE:g} degrees.")
    expected = _expected(domain, bounds)
    if expected > triangulation.MAX_TRIANGLES:
        raise MeshError(
            f"Elements this small would take about {expected:.2g} triangles; "
            f"no more than {triangulation.MAX_TRIANGLES:,} are made."
        )


def _expected(domain: Domain, bounds: Bounds) -> float:
    """About how many triangles the bounds ask for, by the area and by the length of the sides."""
    target = min(
        math.inf if bounds.max_edge is None else math.sqrt(3) / 4 * bounds.max_edge**2,
        math.inf if bounds.max_area is None else bounds.max_area,
    )
    # even where it is thin, a triangle lies on each edge of the sides
    length = sum(float(np.hypot(*np.diff(loop, axis=0).T).sum()) for loop in domain.loops)
    along = 0.0 if bounds.max_edge is None else length / bounds.max_edge
    return max(domain.area / target if target > 0.0 else math.inf, along)


def triangle_arrays(
    domain: Domain,
    min_angle: float = MIN_ANGLE,
    max_edge: float | None = None,
    max_area: float | None = None,
    seed: int = 0,
) -> Arrays:
    """Triangulate a polygon by Triangle; arguments and errors as in `mesh_domain`.

    With neither `max_edge` nor `max_area` and `min_angle` 0 no points are inserted. The domain's
    points come first, the outline's before the holes', at exactly their places.
    """
    bounds = Bounds(min_angle, max_edge, max_area)
    _check(domain, bounds)
    points = np.concatenate(domain.loops)
    starts = np.cumsum([0, *(len(loop) for loop in domain.loops)])
    segments = np.concatenate([_ring(a, b) for a, b in itertools.pairwise(starts)])
    spots = [shapely.Polygon(hole).representative_point() for hole in domain.holes]
    holes = np.array([[spot.x, spot.y] for spot in spots]).reshape(-1, 2)
    found = triangulated(points, segments, holes, domain.diameter, bounds, seed)
    result, triangles = found.points, found.triangles
    if abs(triangle_areas(result, triangles).sum() - domain.area) > 1e-9 * domain.diameter**2:
        raise MeshError("The domain could not be triangulated: it is too thin somewhere.")
    geometric = np.zeros(len(result), dtype=bool)
    geometric[: len(points)] = np.concatenate(domain.loop_corners)
    return result, triangles, geometric


def benchmark_arrays(kind: str, sides: int, rng: np.random.Generator) -> Arrays:
    """Return a random mesh of the benchmark distribution.

    A random polygon (`shapes.random_corners`; all its corners are geometric). Triangles: Triangle
    with ``pq28.6`` and no edge longer than 0.4. Quads: Triangle with ``p``, no inserted points,
    then Catmull-Clark.

    Args:
        kind: "tri" or "quad".
        sides: of the polygon, at least 3.
        rng: the only source of randomness; one draw of `sides` uniform numbers.
    """
    _refuse_kind(kind)
    corners = random_corners(sides, rng)
    segments = _ring(0, sides)
    bounds = Bounds(MIN_ANGLE, BENCHMARK_EDGE) if kind == "tri" else Bounds()
    points, elements = plain_triangles(corners, segments, bounds)
    geometric = np.arange(len(points)) < sides
    if kind == "tri":
        return points, elements, geometric
    return quadrangulation.catmull_clark(points, [elements], geometric)


def benchmark_mesh(kind: str, sides: int, rng: np.random.Generator) -> HalfEdgeMesh:
    """Return `benchmark_arrays` as a half-edge mesh."""
    return HalfEdgeMesh.from_elements(*benchmark_arrays(kind, sides, rng))


def grid_arrays(kind: str, n_elements: int, rng: np.random.Generator | None = None) -> Arrays:
    """Return a structured mesh of the unit square with about `n_elements` elements.

    Args:
        kind: "tri" (each square of the grid is cut along its rising diagonal) or "quad".
        n_elements: rounded to the nearest square number (triangles: twice one), at least one
            square.
        rng: if given, interior points move by up to a fifth of a square, and each diagonal rises
            or falls at random; no element turns over.
    """
    _refuse_kind(kind)
    if n_elements < 1:
        raise MeshError(f"A grid needs at least one element, not {n_elements}.")
    n = max(1, round(math.sqrt(n_elements / (2 if kind == "tri" else 1))))
    line = np.arange(n + 1)
    x, y = np.meshgrid(line.astype(float), line.astype(float))
    if rng is not None:
        x[1:-1, 1:-1] += rng.uniform(-0.2, 0.2, (n - 1, n - 1))
        y[1:-1, 1:-1] += rng.uniform(-0.2, 0.2, (n - 1, n - 1))
    points = np.column_stack([x.ravel(), y.ravel()]) / n
    a = (line[:-1, None] * (n + 1) + line[None, :-1]).ravel()
    squares = np.column_stack([a, a + 1, a + n + 2, a + n + 1])
    geometric = np.zeros(len(points), dtype=bool)
    geometric[[0, n, n * (n + 1), (n + 1) ** 2 - 1]] = True
    if kind == "quad":
        return points, squares, geometric
    if rng is not None:
        falls = rng.random(len(squares)) < 0.5
        squares[falls] = np.roll(squares[falls], -1, axis=1)
    return points, squares[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3), geometric


def grid(kind: str, n_elements: int, rng: np.random.Generator | None = None) -> HalfEdgeMesh:
    """Return `grid_arrays` as a half-edge mesh."""
    return HalfEdgeMesh.from_elements(*grid_arrays(kind, n_elements, rng))


def _ring(start: int, stop: int) -> Elements:
    index = np.arange(start, stop)
    return np.column_stack([index, np.roll(index, -1)])


def _refuse_kind(kind: str) -> None:
    if kind not in ("tri", "quad"):
        raise MeshError(f'A mesh is of kind "tri" or "quad", not {kind!r}.')


def _positive(value: float, what: str) -> float:
    if not (value > 0 and math.isfinite(value)):
        raise MeshError(f"The {what} must be a positive number, not {value:g}.")
    return value
