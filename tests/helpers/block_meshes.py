"""Small block structures with curved and named sides, without a search."""

import math

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.mesh_boundary import Seats
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.loops.side_curves import mesh_boundary, side_curves


def on_domain(
    domain: Domain, points: list, quads: list, regions: list | None = None
) -> HalfEdgeMesh:
    """A mesh with its boundary on the curves of a domain, by projection."""
    curves = side_curves(domain.sides)
    places = np.array(points, float)
    curve, parameter = np.full(len(places), -1), np.zeros(len(places))
    for number, side in enumerate(domain.sides.all_sides):
        start = 0.0
        for piece in side.curves:
            t, away = piece.project(places)
            near = (np.asarray(away) < 1e-9) & (curve < 0)
            curve[near], parameter[near] = number, (start + np.asarray(t))[near]
            start += piece.length
        length = start
        here = curve == number
        parameter[here] = np.where(parameter[here] >= length - 1e-12, 0.0, parameter[here])
    boundary = mesh_boundary(domain.sides, curves)
    return HalfEdgeMesh.from_elements(
        places, quads, boundary=boundary, seats=Seats(curve, parameter)
    )


def quarter_ring(
    turn: float = 0.5 * math.pi, names: tuple[str, ...] = ("start", "outer", "end", "inner")
) -> HalfEdgeMesh:
    """One block between two arcs that turn so far, radii 1 and 2, and two segments; its four sides
    have names.
    """
    x, y = math.cos(turn), math.sin(turn)
    outline = [
        Curve.line((1, 0), (2, 0)), Curve.arc((0, 0), 2, 0, turn),
        Curve.line((2 * x, 2 * y), (x, y)), Curve.arc((0, 0), 1, turn, -turn),
    ]  # fmt: skip
    domain = Domain.from_curves([outline], names=[list(names)])
    return on_domain(domain, [(1, 0), (2, 0), (2 * x, 2 * y), (x, y)], [[0, 1, 2, 3]])


def annulus() -> HalfEdgeMesh:
    """Four blocks around a hole, radii 1 and 2."""
    circles = [Curve.arc((0, 0), radius, 0, 2 * math.pi) for radius in (2, 1)]
    domain = Domain.from_curves([[one] for one in circles], names=[["far"], ["wall"]])
    unit = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    points = [*unit, *((2 * x, 2 * y) for x, y in unit)]
    quads = [[i, i + 4, (i + 1) % 4 + 4, (i + 1) % 4] for i in range(4)]
    return on_domain(domain, points, quads)


def corner_blocks() -> HalfEdgeMesh:
    """Three square blocks around the inner corner of an L."""
    points = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2), (0, 1)]
    return HalfEdgeMesh.from_elements(points, [[0, 1, 4, 7], [1, 2, 3, 4], [7, 4, 5, 6]])


def two_regions() -> HalfEdgeMesh:
    """Two squares of different regions side by side."""
    points = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)]
    return HalfEdgeMesh.from_elements(points, [[0, 1, 4, 3], [1, 2, 5, 4]], regions=[0, 1])
