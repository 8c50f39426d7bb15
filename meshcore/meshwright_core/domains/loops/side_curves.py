"""The sides of a domain as the composite curves of its meshes."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from meshwright_core.core.composite_curves import Curves
from meshwright_core.core.mesh_boundary import CurvePiece, Interface, MeshBoundary
from meshwright_core.curves.many_curves import flattened
from meshwright_core.domains.loops.planar_graph import Side
from meshwright_core.domains.loops.region_loops import RegionLoops


def side_curves(sides: RegionLoops) -> Curves:
    """The composite curves of all sides, in their order; the lengths of spans are those that the
    pieces know.
    """
    every = sides.all_sides
    flat = flattened([curve for side in every for curve in side.curves])
    spans = [sum(len(curve.spans) for curve in side.curves) for side in every]
    first = np.concatenate([[0], np.cumsum(spans)]).astype(np.int64)
    lengths = flat.stop - flat.start
    start, stop = np.zeros(len(lengths)), np.zeros(len(lengths))
    for a, b in pairwise(first.tolist()):
        stop[a:b] = np.cumsum(lengths[a:b])
        start[a + 1 : b] = stop[a : b - 1]
    closed = np.array([side.closed for side in every], np.bool_)
    return flat._replace(start=start, stop=stop, first_span=first, closed=closed)


def piece_starts(curves: Curves, number: int, side: Side) -> list[float]:
    """Parameters where the pieces of a side, curve `number`, begin; and its length."""
    counts = [len(piece.curve.spans) for piece in side.pieces]
    spans = curves.first_span[number] + np.cumsum([0, *counts])
    starts: list[float] = curves.start[spans[:-1]].tolist()
    return [*starts, float(curves.stop[spans[-1] - 1])]


def mesh_boundary(
    sides: RegionLoops, curves: Curves, vertex_at: Mapping[int, int] | None = None
) -> MeshBoundary:
    """The sides for a mesh.

    Args:
        sides: of the domain.
        curves: as :func:`side_curves` makes them.
        vertex_at: the vertex at each geometric point; None: interfaces have no junctions yet.
    """
    vertices = vertex_at or {}
    interfaces, pieces = [], []
    for number, side in enumerate(sides.all_sides):
        rows = zip(side.pieces, pairwise(piece_starts(curves, number, side)), strict=True)
        pieces.append(
            tuple(
                CurvePiece(start, stop, piece.curve.kind, piece.name, piece.curve.to_json())
                for piece, (start, stop) in rows
            )
        )
        if not side.boundary:
            ends = (-1, -1) if side.closed else (side.nodes[0], side.nodes[-1])
            start, end = (vertices.get(node, -1) for node in ends)
            first = side.pieces[0]
            interfaces.append(Interface(number, first.left, first.right, start, end))
    return MeshBoundary(
        curves,
        tuple(range(len(sides.loop_sides))),
        tuple(interfaces),
        sides.region_names,
        tuple(pieces),
    )
