"""Messages with a preview of the operations at the half-edge under the pointer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from meshwright.document.operation_preview import OperationOffer, best, choices, ghost
from meshwright.notebook.protocol.mesh_sync import CoordinateFrame, Packet
from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.edge_parts import EdgeParts, segments

COARSE, FINEST = 1e-4, 1e-7
"""Default and smallest tolerance of curved edges, in the browser's frame."""


def ghost_packet(
    mesh: HalfEdgeMesh,
    frame: CoordinateFrame,
    halfedge: int,
    operation: str | None,
    bar: Callable[[str], str] | None = None,
    tolerance: float = COARSE,
) -> Packet:
    """All operations at a live half-edge, and the preview of one of them.

    The preview is of ``operation``, or where that is None of the best one that is allowed. There is
    none where the operation is refused, by the mesh or by the document's ``bar``. Edges along
    curves are polylines within ``tolerance``, in the browser's frame.
    """
    offered = choices(mesh, halfedge, bar)
    if operation is None:
        meant = best(offered)
    else:
        meant = next((c for c in offered if c.operation == operation and c.allowed), None)
    content = {
        "type": "ghost",
        "halfedge": halfedge,
        "offers": [_offer(offer) for offer in offered],
        "operation": str(meant.operation) if meant is not None else None,
        "change": meant.change if meant is not None else None,
    }
    if meant is None:
        return Packet(content, [b""] * 5)
    seen = ghost(mesh, meant.operation, halfedge)
    fine = max(tolerance, FINEST) * frame.scale
    edges = [_segments(part, fine) for part in (seen.added_edges, seen.removed_edges)]
    places = (*edges, seen.gone, seen.places)
    buffers = [frame.normalised(np.asarray(part)).tobytes() for part in places]
    delta = np.clip(seen.delta, -127, 127).astype(np.int8)
    return Packet(content, [*buffers, delta.tobytes()])


def no_ghost() -> Packet:
    """The message for a pointer over no half-edge."""
    content: dict[str, Any] = {
        "type": "ghost",
        "halfedge": -1,
        "offers": [],
        "operation": None,
        "change": None,
    }
    return Packet(content, [b""] * 5)


def _segments(edges: EdgeParts, tolerance: float) -> np.ndarray:
    """(n, 2, 2) edges as segments; those of one edge follow each other."""
    if (edges.curve < 0).all():
        return edges.ends[:, :, :2]
    points, first = edges.polylines(tolerance)
    return segments(points[:, :2], first)


def _offer(offer: OperationOffer) -> dict[str, Any]:
    return {
        "operation": str(offer.operation),
        "allowed": offer.allowed,
        "reason": offer.verdict.reason,
        "change": offer.change,
    }
