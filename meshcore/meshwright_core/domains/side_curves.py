"""The sides of a domain as the composite curves of its meshes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from meshwright_core.core.composite_curves import joined_curves
from meshwright_core.core.mesh_boundary import CurvePiece, Interface, MeshBoundary
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain import CORNER_ANGLE, Domain, turning_angles


def curved_domain(domain: Domain) -> Domain:
    """The domain with sides of curves: itself, or a polygon as polylines between its corners."""
    if domain.sides is not None:
        return domain
    loops, angle = [], CORNER_ANGLE
    for points, corners in zip(domain.loops, domain.loop_corners, strict=True):
        if not corners.all():
            angle = max(angle, float(turning_angles(points)[~corners].max()))
        cuts = np.flatnonzero(corners) if corners.any() else np.array([0])
        around = np.append(cuts, cuts[0] + len(points))
        loops.append(
            [
                Curve.polyline(np.take(points, np.arange(a, b + 1), axis=0, mode="wrap"))
                for a, b in pairwise(around.tolist())
            ]
        )
    return Domain.from_curves(loops, domain.name, angle)


def mesh_boundary(domain: Domain) -> MeshBoundary:
    """The curves of a domain with sides, for its meshes; no interface has its junctions yet."""
    assert domain.sides is not None
    sides = domain.sides.all_sides
    chains = [[span for piece in side.pieces for span in piece.curve.spans] for side in sides]
    curves = joined_curves(chains, [side.closed for side in sides])
    pieces = []
    for number, side in enumerate(sides):
        span, row = int(curves.first_span[number]), []
        for piece in side.pieces:
            last = span + len(piece.curve.spans) - 1
            start, stop = float(curves.start[span]), float(curves.stop[last])
            data = piece.curve.to_json()
            row.append(CurvePiece(start, stop, piece.curve.kind, piece.name, data))
            span = last + 1
        pieces.append(tuple(row))
    return MeshBoundary(
        curves,
        tuple(i for i, side in enumerate(sides) if side.boundary),
        tuple(
            Interface(i, side.pieces[0].left, side.pieces[0].right)
            for i, side in enumerate(sides)
            if not side.boundary
        ),
        domain.sides.region_names,
        tuple(pieces),
    )
