"""Small meshes whose sides are curves: a disc, a ring, a rounded plate with a hole, an insert."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.composite_curves import joined_curves, nearest_on
from meshwright_core.core.mesh_boundary import Interface, MeshBoundary
from meshwright_core.curves.curve import Curve

INSERT = ("plate", "insert")
"""The names of the regions of :func:`insert`."""


def circle(
    radius: float, centre: Sequence[float] = (0.0, 0.0), sweep: float = 2 * math.pi
) -> Curve:
    """A whole circle from angle 0; clockwise with a negative sweep, as holes are."""
    return Curve.arc(centre, radius, 0.0, sweep)


def meshed(
    points: np.ndarray,
    elements: np.ndarray,
    loops: Sequence[Sequence[Curve]],
    geometric: Sequence[int] = (),
    interface: Sequence[Curve] = (),
    regions: np.ndarray | None = None,
    names: tuple[str, ...] = ("",),
) -> HalfEdgeMesh:
    """A mesh whose boundary vertices lie on `loops`, and those between regions on a closed
    `interface` with region 1 on its left.
    """
    chains = [[span for piece in loop for span in piece.spans] for loop in loops]
    if interface:
        chains.append([span for piece in interface for span in piece.spans])
    curves = joined_curves(chains, [True] * len(chains))
    between = (Interface(len(loops), 1, 0),) if interface else ()
    boundary = MeshBoundary(curves, tuple(range(len(loops))), between, names)
    places = np.column_stack([points, np.zeros(len(points))])[:, :3]
    curve, parameter = np.full(len(points), -1), np.zeros(len(points))
    for v, place in enumerate(places):
        found = [nearest_on(curves, c, place) for c in range(len(chains))]
        away = [squared for _, squared in found]
        if min(away) < 1e-12:
            curve[v] = int(np.argmin(away))
            parameter[v] = found[curve[v]][0]
    flags = np.isin(np.arange(len(points)), geometric)
    return HalfEdgeMesh.from_elements(
        places, elements, flags, boundary=boundary, seats=(curve, parameter), regions=regions
    )


def _on_circle(radius: float, count: int, first: float = math.pi / 4) -> np.ndarray:
    angles = first + np.arange(count) * 2 * math.pi / count
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def disc() -> HalfEdgeMesh:
    """The unit disc: a square in the middle, four quads around it."""
    points = np.concatenate([_on_circle(0.5, 4), _on_circle(1.0, 4)])
    around = [(i, i + 4, (i + 1) % 4 + 4, (i + 1) % 4) for i in range(4)]
    return meshed(points, np.array([(0, 1, 2, 3), *around]), [[circle(1.0)]])


def ring() -> HalfEdgeMesh:
    """A ring of radii 1 and 2: four quads, both of whose long sides are arcs of 90 degrees."""
    points = np.concatenate([_on_circle(1.0, 4), _on_circle(2.0, 4)])
    quads = np.array([(i, i + 4, (i + 1) % 4 + 4, (i + 1) % 4) for i in range(4)])
    return meshed(points, quads, [[circle(2.0)], [circle(1.0, sweep=-2 * math.pi)]])


def plate(size: float = 4.0, fillet: float = 1.0, hole: float = 1.0) -> HalfEdgeMesh:
    """A square plate from -size to size with filleted corners and a round hole: two rings of twelve
    quads. Vertices 3 i and 3 i + 2, the tangent points of the fillets, are anchors; 3 i + 1 is the
    middle of a fillet, 24 + j opposite to j on the hole.
    """
    a, f = size, size - fillet
    sides, rim = [], []
    middle = f + fillet * math.sqrt(0.5)
    for turn in range(4):
        c, s = round(math.cos(turn * math.pi / 2)), round(math.sin(turn * math.pi / 2))
        matrix = np.array([[c, -s], [s, c]])
        sides += [
            Curve.line(matrix @ (a, -f), matrix @ (a, f)),
            Curve.arc(matrix @ (f, f), fillet, turn * math.pi / 2, math.pi / 2),
        ]
        rim += [matrix @ p for p in ((a, f), (middle, middle), (f, a))]
    outer = np.array(rim)
    inner = hole * outer / np.linalg.norm(outer, axis=1)[:, None]
    points = np.concatenate([outer, 0.5 * (outer + inner), inner])
    quads = [
        (i + ring, (i + 1) % 12 + ring, (i + 1) % 12 + ring + 12, i + ring + 12)
        for ring in (0, 12)
        for i in range(12)
    ]
    anchors = [3 * i + j for i in range(4) for j in (0, 2)]
    loops = [sides, [circle(hole, sweep=-2 * math.pi)]]
    return meshed(points, np.array(quads), loops, anchors)


def insert() -> HalfEdgeMesh:
    """A disc of radius 2, region 0, around one of radius 1, region 1."""
    points = np.concatenate([_on_circle(0.5, 4), _on_circle(1.0, 4), _on_circle(2.0, 4)])
    quads = [(0, 1, 2, 3)]
    for inner, outer in ((0, 4), (4, 8)):
        quads += [
            (inner + i, outer + i, outer + (i + 1) % 4, inner + (i + 1) % 4) for i in range(4)
        ]
    regions = np.array([1] * 5 + [0] * 4)
    return meshed(points, np.array(quads), [[circle(2.0)]], (), [circle(1.0)], regions, INSERT)
