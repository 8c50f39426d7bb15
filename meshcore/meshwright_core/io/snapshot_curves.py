"""The curves of a mesh as named arrays for files; see :mod:`meshwright_core.io.snapshot`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from meshwright_core.core.arrays import END, LEFT, RIGHT, START
from meshwright_core.core.composite_curves import Curves, polyline_curves
from meshwright_core.core.grid_plan import GridPlan
from meshwright_core.core.mesh_boundary import CurvePiece, Interface, MeshBoundary
from meshwright_core.core.planes import Plane
from meshwright_core.errors import MeshError
from meshwright_core.io.stored_arrays import Arrays, stored

_FIELDS: tuple[tuple[str, type, tuple[int, ...]], ...] = (
    ("control", np.float64, (-1, 4)),
    ("first_control", np.int64, (-1,)),
    ("start", np.float64, (-1,)),
    ("stop", np.float64, (-1,)),
    ("first_span", np.int64, (-1,)),
    ("closed", np.bool_, (-1,)),
)


def boundary_arrays(namings: Mapping[int, MeshBoundary], naming: int, recorded: bool) -> Arrays:
    """The curves and what is known of them, and whether the history holds seats on them.

    Args:
        namings: the names that the mesh has had, by number.
        naming: the number of those in force.
        recorded: whether the history holds seats.
    """
    boundary = namings[naming]
    known = {
        "recorded": recorded,
        **names_record(boundary),
        **({"plane": boundary.plane} if boundary.plane is not None else {}),
        "naming": naming,
        "others": [
            [number, _other_record(other, boundary)]
            for number, other in namings.items()
            if number != naming
        ],
    }
    text = json.dumps(known, separators=(",", ":")).encode()
    return {
        **{f"curves.{name}": getattr(boundary.curves, name) for name, _, _ in _FIELDS},
        "interface": boundary.table(),
        "boundary": np.frombuffer(text, np.uint8),
    }


def names_record(boundary: MeshBoundary) -> dict[str, Any]:
    """The names of regions and sides, and the wishes for a grid, as JSON can hold them."""
    return {
        **_plan_record(boundary),
        "regions": list(boundary.region_names),
        "pieces": [
            [[one.start, one.stop, one.kind, one.name, one.data] for one in pieces]
            for pieces in boundary.pieces
        ],
        "tags": [[dimension, name, tag] for (dimension, name), tag in boundary.tags.items()],
    }


def _plan_record(boundary: MeshBoundary) -> dict[str, Any]:
    record: dict[str, Any] = {} if boundary.plan.empty else {"plan": boundary.plan.record()}
    return record | ({"bound excess": boundary.bound_excess} if boundary.bound_excess else {})


def _other_record(other: MeshBoundary, boundary: MeshBoundary) -> dict[str, Any]:
    """The names that were in force before, or only the wishes if they alone differ."""
    same = other.pieces is boundary.pieces and other.region_names == boundary.region_names
    if same and other.tags == boundary.tags:
        return {"same names": True, **_plan_record(other)}
    return names_record(other)


def stored_names(record: Any, boundary: MeshBoundary) -> MeshBoundary:
    """The boundary with the names of a record, which may come from a damaged file.

    Raises MeshError unless there is a name for each of its regions, and pieces of its curves.
    """
    try:
        plan = GridPlan.of_record(record["plan"]) if "plan" in record else GridPlan()
        excess = int(record.get("bound excess", 0))
        if not 0 <= excess < 2**31 or excess % 2:
            raise ValueError("no bound exceeds another by that")
        boundary = replace(boundary, plan=plan, bound_excess=excess)
        if record.get("same names"):
            return boundary
        names = tuple(record["regions"])
        pieces = tuple(tuple(map(_piece, some)) for some in record["pieces"])
        tags = {(int(d), str(name)): int(tag) for d, name, tag in record.get("tags", ())}
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        RecursionError,
        OverflowError,
    ) as error:
        raise MeshError("its curves have wrong names") from error
    regions = len(boundary.region_names) if boundary.region_names != ("",) else len(names)
    sound = len(pieces) == boundary.count and len(names) == regions > 0
    if not sound or not all(isinstance(name, str) for name in names):
        raise MeshError("its curves have wrong names")
    return replace(boundary, region_names=names, pieces=pieces, tags=tags)


def stored_boundary(
    arrays: Mapping[str, np.ndarray],
) -> tuple[dict[int, MeshBoundary], int, bool]:
    """What :func:`boundary_arrays` stored; MeshError if it is not sound.

    That the vertices fit the curves, and the ends of interfaces are junctions, is not checked.
    """
    # copies: arrays that are views of a file's bytes cannot be written, which is another type to
    # numba, and so everything that takes curves would be compiled a second time
    curves = Curves(
        *(stored(arrays, f"curves.{name}", kind, shape).copy() for name, kind, shape in _FIELDS)
    )
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
        recorded, naming = bool(known["recorded"]), int(known.get("naming", 0))
        others = {int(number): record for number, record in known.get("others", ())}
    except (ValueError, KeyError, TypeError, RecursionError, OverflowError) as error:
        raise MeshError("its curves have wrong names") from error
    plain = MeshBoundary(curves, loops, tuple(interfaces), plane=_plane(known.get("plane")))
    boundary = stored_names(known, plain)
    namings = {naming: boundary}
    namings.update({number: stored_names(one, boundary) for number, one in others.items()})
    if not all(0 <= number < 2**31 for number in namings) or len(namings) != len(others) + 1:
        raise MeshError("its curves have wrong names")
    return namings, naming, recorded


def _plane(record: Any) -> Plane | None:
    if record is None:
        return None
    try:
        origin, u, v = ((float(x), float(y), float(z)) for x, y, z in record)
    except (ValueError, TypeError, OverflowError) as error:
        raise MeshError("its plane is not one") from error
    plane = Plane(origin, u, v)
    if not plane.sound:
        raise MeshError("its plane is not one")
    return plane


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
