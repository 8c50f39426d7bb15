"""The curves of a mesh as named arrays for files; see :mod:`meshwright_core.io.snapshot`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from meshwright_core.core.arrays import END, LEFT, RIGHT, START
from meshwright_core.core.composite_curves import Curves, polyline_curves
from meshwright_core.core.mesh_boundary import CurvePiece, Interface, MeshBoundary
from meshwright_core.errors import MeshError
from meshwright_core.io.stored_arrays import Arrays, stored

_FIELDS = (
    ("control", np.float64, (-1, 4)),
    ("first_control", np.int64, (-1,)),
    ("start", np.float64, (-1,)),
    ("stop", np.float64, (-1,)),
    ("first_span", np.int64, (-1,)),
    ("closed", np.bool_, (-1,)),
)


def boundary_arrays(boundary: MeshBoundary, recorded: bool) -> Arrays:
    """The curves and what is known of them, and whether the history holds seats on them."""
    known = {
        "recorded": recorded,
        "regions": list(boundary.region_names),
        "pieces": [
            [[one.start, one.stop, one.kind, one.name, one.data] for one in pieces]
            for pieces in boundary.pieces
        ],
    }
    text = json.dumps(known, separators=(",", ":")).encode()
    return {
        **{f"curves.{name}": getattr(boundary.curves, name) for name, _, _ in _FIELDS},
        "interface": boundary.table(),
        "boundary": np.frombuffer(text, np.uint8),
    }


def stored_boundary(arrays: Mapping[str, np.ndarray]) -> tuple[MeshBoundary, bool]:
    """What :func:`boundary_arrays` stored; MeshError if it is not sound.

    That the vertices fit the curves, and the ends of interfaces are junctions, is not checked.
    """
    curves = Curves(*(stored(arrays, f"curves.{name}", *form) for name, *form in _FIELDS))
    _require_curves(curves)
    count = len(curves.closed)
    table = stored(arrays, "interface", np.int32, (count, 4))
    interfaces = [
        Interface(
            curve,
            int(table[curve, LEFT]),
            int(table[curve, RIGHT]),
            int(table[curve, START]),
            int(table[curve, END]),
        )
        for curve in np.flatnonzero(table[:, LEFT] >= 0).tolist()
    ]
    loops = tuple(np.flatnonzero(table[:, LEFT] < 0).tolist())
    text = stored(arrays, "boundary", np.uint8, (-1,)).tobytes()
    try:
        known = json.loads(text)
        names, recorded = known["regions"], bool(known["recorded"])
        pieces = tuple(tuple(map(_piece, some)) for some in known["pieces"])
        if len(pieces) != count or not names or not all(isinstance(name, str) for name in names):
            raise MeshError("its curves have wrong names")
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise MeshError("its curves have wrong names") from error
    return MeshBoundary(curves, loops, tuple(interfaces), tuple(names), pieces), recorded


def _piece(record: Any) -> CurvePiece:
    start, stop, kind, name, data = record
    if not (isinstance(kind, str) and isinstance(name, str) and isinstance(data, dict)):
        raise TypeError("a piece of a curve is not as it should be")
    return CurvePiece(float(start), float(stop), kind, name, data)


def _require_curves(curves: Curves) -> None:
    """MeshError unless the arrays are composite curves that can be evaluated."""
    control, first, spans = curves.control, curves.first_control, curves.first_span
    count = len(curves.start)
    sound = len(first) == count + 1 and len(curves.stop) == count
    sound = sound and len(spans) == len(curves.closed) + 1
    for ends, total, least in ((first, len(control), 2), (spans, count, 1)):
        sound = sound and ends[0] == 0 and ends[-1] == total
        sound = sound and bool((np.diff(ends) >= least).all())
    if not sound:
        raise MeshError("its curves are cut off")
    begins = np.zeros(count, bool)
    begins[spans[:-1]] = True
    follows = np.append(0.0, curves.stop[:-1])[:count]
    finite = np.isfinite(control).all() and np.isfinite(curves.stop).all()
    rising = (curves.start == np.where(begins, 0.0, follows)) & (curves.stop > curves.start)
    if not (finite and (control[:, 3] > 0.0).all() and rising.all()):
        raise MeshError("its curves are not as they should be")


def outline_boundary(arrays: Mapping[str, np.ndarray], vertices: int) -> MeshBoundary:
    """The curves of a file from before meshes had some: the polylines of its outline."""
    lengths = stored(arrays, "outline.lengths", np.int64, (-1,))
    ids = stored(arrays, "outline.ids", np.int64, (-1,))
    points = stored(arrays, "outline.points", np.float64, (len(ids), 3))
    if (lengths < 3).any() or (lengths > len(ids)).any() or lengths.sum() != len(ids):
        raise MeshError("its outline is cut off")
    if (ids < -1).any() or (ids >= vertices).any() or not np.isfinite(points).all():
        raise MeshError("its outline is not the mesh's")
    polylines = np.split(points, np.cumsum(lengths)[:-1]) if len(lengths) else []
    curves = polyline_curves(polylines, [True] * len(polylines))
    loops = tuple(range(len(polylines)))
    ends = curves.stop[curves.first_span[1:] - 1]
    pieces = tuple((CurvePiece(0.0, float(end), "polyline"),) for end in ends)
    return MeshBoundary(curves, loops, (), ("",), pieces)
