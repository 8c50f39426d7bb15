"""Small meshes whose sides are true arcs."""

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.composite_curves import joined_curves, nearest_parameters
from meshwright_core.core.mesh_boundary import Interface, MeshBoundary, Seats
from meshwright_core.curves.curve import Curve


def boundary_of(loops, interfaces=(), names=("",)):
    """A MeshBoundary of closed chains of pieces and of (chain, left, right, start, end)."""
    chains = [*loops, *(chain for chain, *_ in interfaces)]
    spans = [[span for piece in chain for span in piece.spans] for chain in chains]
    closed = [True] * len(loops) + [start < 0 for *_, start, _ in interfaces]
    count = len(loops)
    return MeshBoundary(
        curves=joined_curves(spans, closed),
        loops=tuple(range(count)),
        interfaces=tuple(Interface(count + i, *one[1:]) for i, one in enumerate(interfaces)),
        region_names=tuple(names),
        pieces=((),) * len(chains),
    )


def curved_mesh(points, elements, boundary, on, geometric, **more):
    """A mesh with the vertices on[c] on curve c of `boundary`, at their projections."""
    points = np.column_stack([np.asarray(points, float), np.zeros(len(points))])
    curve, t = np.full(len(points), -1), np.zeros(len(points))
    lengths = boundary.lengths()
    for c, vertices in enumerate(on):
        curve[vertices] = c
        places = nearest_parameters(boundary.curves, c, points[vertices])
        t[vertices] = np.where(places > lengths[c] - 1e-9, 0.0, places)
    flags = np.isin(np.arange(len(points)), geometric)
    return HalfEdgeMesh.from_elements(
        points, elements, flags, boundary=boundary, seats=Seats(curve, t), **more
    )


def polar(radius, degrees):
    """Points (n, 2) by radius and angle."""
    angle = np.radians(degrees)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def circle(radius, sign=1):
    """A whole circle around the origin, clockwise with sign -1."""
    return Curve.arc((0, 0), radius, 0.0, sign * 2.0 * np.pi)


def round_ring(pieces=3, inner=1.0, outer=2.0, rows=1):
    """`pieces` quads around, `rows` of them from the inner to the outer circle."""
    degrees = 360.0 * np.arange(pieces) / pieces
    points = np.vstack(
        [polar(outer + (inner - outer) * j / rows, degrees) for j in range(rows + 1)]
    )
    k = np.arange(pieces)
    quads = np.vstack(
        [
            np.column_stack([k + pieces, k, (k + 1) % pieces, (k + 1) % pieces + pieces])
            + pieces * j
            for j in range(rows)
        ]
    )
    on = [k, k + rows * pieces]
    return curved_mesh(points, quads, boundary_of([[circle(outer)], [circle(inner, -1)]]), on, [])


def annulus_sector(degrees=90.0, inner=1.0, outer=2.0):
    """One quad: a sector of an annulus, its four corners geometric; 0 and 1 inside."""
    turn = np.radians(degrees)
    points = np.vstack([polar(inner, [0.0]), polar(outer, [0.0, degrees]), polar(inner, [degrees])])
    loop = [
        Curve.line(points[0], points[1]),
        Curve.arc((0, 0), outer, 0.0, turn),
        Curve.line(points[2], points[3]),
        Curve.arc((0, 0), inner, turn, -turn),
    ]
    return curved_mesh(points, [[0, 1, 2, 3]], boundary_of([loop]), [[0, 1, 2, 3]], range(4))


def round_disc():
    """Five quads: a square in the middle, and four from its sides to the circle."""
    points = np.vstack([polar(0.5, [45, 135, 225, 315]), polar(1.0, [45, 135, 225, 315])])
    k = np.arange(4)
    quads = np.vstack([[[0, 1, 2, 3]], np.column_stack([k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4])])
    return curved_mesh(points, quads, boundary_of([[circle(1.0)]]), [k + 4], [])


def round_insert():
    """The square |x|, |y| <= 2 with a disc of another region in it; the interface is a circle."""
    mesh = round_disc()
    square = 2.0 * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    points = np.vstack([mesh.points[:, :2], square])
    k = np.arange(4)
    quads = np.vstack(
        [mesh.elements(), np.column_stack([k + 4, k + 8, (k + 1) % 4 + 8, (k + 1) % 4 + 4])]
    )
    boundary = boundary_of(
        [[Curve.polyline(np.vstack([square, square[:1]]))]],
        [([circle(1.0)], 1, 0, -1, -1)],
        ("plate", "insert"),
    )
    return curved_mesh(
        points, quads, boundary, [k + 8, k + 4], range(8, 12), regions=[1] * 5 + [0] * 4
    )


def fan(pieces=5):
    """Triangles from the centre of a circle to it."""
    points = np.vstack([polar(1.0, 360.0 * np.arange(pieces) / pieces), [[0.0, 0.0]]])
    k = np.arange(pieces)
    triangles = np.column_stack([k, (k + 1) % pieces, np.full(pieces, pieces)])
    return curved_mesh(points, triangles, boundary_of([[circle(1.0)]]), [k], [])


def dragged_plate(rows=3, columns=3):
    """A plate with an arc for its upper side, in quads; its upper right corner dragged outwards."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(columns + 1), np.arange(rows + 1)))
    points = np.column_stack([x, y]).astype(float)
    a = np.array([i + (columns + 1) * j for j in range(rows) for i in range(columns)])
    quads = np.column_stack([a, a + 1, a + columns + 2, a + columns + 1])
    corners = np.array([0, columns, len(points) - 1, len(points) - 1 - columns])
    low, right, top, left = points[corners]
    loop = [
        Curve.line(low, right),
        Curve.line(right, top),
        Curve.arc_by_bulge(top, left, 0.3),
        Curve.line(left, low),
    ]
    around = np.flatnonzero((x == 0) | (y == 0) | (x == columns) | (y == rows))
    mesh = curved_mesh(points, quads, boundary_of([loop]), [around], corners)
    mesh.move(corners[[2]], mesh.points[corners[[2]]] + [0.7, 0.4, 0.0])
    return mesh
