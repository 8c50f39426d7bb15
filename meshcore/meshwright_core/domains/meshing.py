"""Meshes from domains: triangles by Triangle, quads by Catmull-Clark splits or by pairing.

The functions that end in `_arrays` return ``(points (n, 2), elements (m, 3 or 4),
geometric (n,))``: numpy arrays, corners of the domain flagged as geometric; the others wrap them
in a half-edge mesh.
"""

from __future__ import annotations

import itertools
import math
from typing import Any, Literal

import numpy as np
import shapely
import triangle
from numpy.typing import NDArray

from meshwright_core.core.irregularity import QUAD_STRAIGHT, TRIANGLE_STRAIGHT
from meshwright_core.domains import quadrangulation
from meshwright_core.domains.domain import Domain, Flags, Points
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

MAX_TRIANGLES = 4_000_000
"""What a mesh may need before the request is refused."""

CURVED_ANGLE = 18.5
"""Degrees that Triangle aims at before Catmull-Clark splits of a domain with curved sides: just
above what a fan of twenty triangles in a circle has, which makes a centre of degree twenty."""

_EDGE_SHARE = 0.2
"""The longest edge by default, as a share of the diameter; 0.4 for the benchmark's 2."""

_ROUNDS = 200


def mesh_domain(
    domain: Domain,
    kind: str,
    max_edge: float | None = None,
    min_angle: float | None = None,
    max_area: float | None = None,
    seed: int = 0,
    quads: Quads = "catmull-clark",
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
            domain with straight sides have no points but its corners, as in the benchmark.
            "pairing" joins triangles in pairs, and cuts everything once more
            if some triangle stays alone.

    Raises:
        MeshError: an argument out of range, or a mesh that would need too many triangles.
    """
    arrays = mesh_arrays(domain, kind, max_edge, min_angle, max_area, seed, quads)
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
    _refuse_kind(kind)
    if quads not in ("catmull-clark", "pairing"):
        raise MeshError(f'Quads are made by "catmull-clark" or "pairing", not by {quads!r}.')
    if kind == "quad" and quads == "catmull-clark":
        # a quad's edges are halves of a triangle's edges and thirds of its medians
        bound = None if max_edge is None else 2 * _positive(max_edge, "longest edge")
        if min_angle is None:
            curved = not all(corners.all() for corners in domain.loop_corners)
            bounded = max_edge is not None or max_area is not None
            min_angle = MIN_ANGLE if bounded else CURVED_ANGLE if curved else 0.0
        points, triangles, geometric = triangle_arrays(domain, bound, min_angle, max_area, seed)
        return quadrangulation.catmull_clark(points, [triangles], geometric)
    bound = _EDGE_SHARE * domain.diameter if max_edge is None else max_edge
    angle = MIN_ANGLE if min_angle is None else min_angle
    points, triangles, geometric = triangle_arrays(domain, bound, angle, max_area, seed)
    if kind == "tri":
        return points, triangles, geometric
    paired, alone = quadrangulation.pair(points, triangles)
    if len(alone) == 0:
        return quadrangulation.without_doublets(points, paired, geometric)
    points, triangles, geometric = triangle_arrays(domain, 2 * bound, angle, max_area, seed)
    paired, alone = quadrangulation.pair(points, triangles)
    arrays = quadrangulation.catmull_clark(points, [paired, alone], geometric)
    return quadrangulation.without_doublets(*arrays)


def triangle_arrays(
    domain: Domain,
    max_edge: float | None = None,
    min_angle: float = MIN_ANGLE,
    max_area: float | None = None,
    seed: int = 0,
) -> Arrays:
    """Triangulate a domain by Triangle; arguments and errors as in `mesh_domain`.

    With neither `max_edge` nor `max_area` and `min_angle` 0 no points are inserted. The domain's
    points come first, the outline's before the holes', at exactly their places.
    """
    if max_edge is not None:
        _positive(max_edge, "longest edge")
    if max_area is not None:
        _positive(max_area, "largest area")
    if not 0 <= min_angle <= MAX_ANGLE:
        raise MeshError(f"The smallest angle must lie between 0 and {MAX_ANGLE:g} degrees.")
    target = min(
        math.inf if max_edge is None else math.sqrt(3) / 4 * max_edge**2,
        math.inf if max_area is None else max_area,
    )
    if domain.area > target * MAX_TRIANGLES:
        raise MeshError(
            f"Elements this small would take about {domain.area / target:.2g} triangles; "
            f"no more than {MAX_TRIANGLES:,} are made."
        )
    loops = domain.loops
    # exact, and keeps the areas that go to Triangle in plain decimals
    scale = 2.0 ** -math.frexp(domain.diameter)[1]
    turn, order = _shuffle(sum(len(loop) for loop in loops), seed)
    place = np.argsort(order)
    points = np.concatenate(loops)
    starts = np.cumsum([0, *(len(loop) for loop in loops)])
    segments = np.concatenate([_ring(a, b) for a, b in itertools.pairwise(starts)])
    spots = [shapely.Polygon(hole).representative_point() for hole in domain.holes]
    raw_points, raw_triangles = _triangle(
        scale * points[order] @ turn,
        place[segments],
        scale * np.array([[spot.x, spot.y] for spot in spots]).reshape(-1, 2) @ turn,
        min_angle,
        None if max_edge is None else scale * max_edge,
        None if max_area is None else scale**2 * max_area,
    )
    if np.linalg.det(turn) < 0:
        raw_triangles = raw_triangles[:, ::-1]
    result = raw_points @ turn.T / scale
    renumbered = np.arange(len(result))
    renumbered[: len(points)] = order
    result[: len(points)] = points
    triangles = renumbered[raw_triangles]
    if abs(_areas(result, triangles).sum() - domain.area) > 1e-9 * domain.diameter**2:
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
    no_holes = np.empty((0, 2))
    if kind == "tri":
        points, elements = _triangle(corners, segments, no_holes, MIN_ANGLE, BENCHMARK_EDGE, None)
    else:
        points, elements = _triangle(corners, segments, no_holes, 0.0, None, None)
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


def _triangle(
    points: Points,
    segments: Elements,
    holes: Points,
    min_angle: float,
    max_edge: float | None,
    max_area: float | None,
) -> tuple[Points, Elements]:
    """Call Triangle, and again while an edge is too long; input points keep their numbers.

    A triangle with a long edge that is far above the area of the equilateral one is brought down
    to that; any other loses at least a tenth, so that Triangle must cut it.
    """
    mesh: dict[str, Any] = {"vertices": points, "segments": segments}
    if len(holes):
        mesh["holes"] = holes
    quality = f"q{min_angle:.6f}" if min_angle > 0 else ""
    area = "" if max_area is None else f"a{max_area:.30f}"
    mesh = _call(mesh, f"p{quality}{area}")
    if max_edge is None:
        return _result(mesh)
    target = math.sqrt(3) / 4 * max_edge**2
    for _ in range(_ROUNDS):
        vertices, triangles = _result(mesh)
        ends = vertices[triangles]
        sides = ends - ends[:, [1, 2, 0]]
        long = (np.einsum("ijk,ijk->ij", sides, sides) > max_edge**2).any(axis=1)
        if not long.any():
            return vertices, triangles
        now = _areas(vertices, triangles)
        limit = np.where(now > 2 * target, target, 0.9 * now)
        mesh = {name: mesh[name] for name in ("vertices", "triangles", "segments")}
        mesh["triangle_max_area"] = np.where(long, limit, -1.0)[:, None]
        mesh = _call(mesh, f"rp{quality}a")
    raise MeshError("Triangle did not bring all edges below the requested longest edge.")


def _call(mesh: dict[str, Any], switches: str) -> dict[str, Any]:
    allowed = MAX_TRIANGLES // 2
    result: dict[str, Any] = triangle.triangulate(mesh, f"{switches}S{allowed}")
    if len(result["vertices"]) - len(mesh["vertices"]) >= allowed:
        raise MeshError(
            f"The mesh would need more than {MAX_TRIANGLES:,} triangles: "
            "ask for longer edges or smaller angles, or widen the thin parts of the domain."
        )
    return result


def _result(mesh: dict[str, Any]) -> tuple[Points, Elements]:
    triangles = mesh.get("triangles")
    if triangles is None or len(triangles) == 0:
        raise MeshError("The domain could not be triangulated: it is too thin somewhere.")
    return np.asarray(mesh["vertices"], dtype=np.float64), triangles.astype(np.int64)


def _areas(points: Points, triangles: Elements) -> NDArray[np.float64]:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _ring(start: int, stop: int) -> Elements:
    index = np.arange(start, stop)
    return np.column_stack([index, np.roll(index, -1)])


def _shuffle(count: int, seed: int) -> tuple[Points, Elements]:
    """Return one of the eight exact turns of the plane and an order of `count` points."""
    if seed == 0:
        return np.eye(2), np.arange(count)
    rng = np.random.default_rng(seed)
    turn = np.diag(rng.choice([-1.0, 1.0], 2))
    if rng.random() < 0.5:
        turn = turn[::-1].copy()
    return turn, rng.permutation(count)


def _refuse_kind(kind: str) -> None:
    if kind not in ("tri", "quad"):
        raise MeshError(f'A mesh is of kind "tri" or "quad", not {kind!r}.')


def _positive(value: float, what: str) -> float:
    if not (value > 0 and math.isfinite(value)):
        raise MeshError(f"The {what} must be a positive number, not {value:g}.")
    return value
