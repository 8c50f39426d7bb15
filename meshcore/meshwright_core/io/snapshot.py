"""A mesh and its history as named arrays for files, exact to the bit.

=================  =====================================================================
``sizes``          (4,) sides of an element; room for vertices and elements; degree cap
``counters``       (10,) the counters that an undo restores
``edge``           (h, 2) origin and twin of each half-edge in use
``vertex``         (v, 5) half-edge, degree, desired degree, flags, place among the irregular
``curve``          (v,) the curve of each vertex, -1 for none
``parameter``      (v,) where it lies there
``region``         (e,) the region of each element
``curves.*``       the composite curves: see :class:`meshwright_core.core.composite_curves.Curves`
``interface``      (n, 4) for each curve left and right region, start and end vertex; -1 for none
``boundary``       JSON as UTF-8 bytes: names of regions, drawn pieces of the curves, and the
                   other names that steps of the history put in force
``points``         (v, 3) coordinates
``irregular``      (room,) the irregular vertices, with what is left behind them
``done.*``         steps that can be undone: see :class:`meshwright_core.history.packed_steps.Steps`
``undone.*``       steps that can be done again
=================  =====================================================================

Files from before meshes had curves hold instead ``outline.*``, polylines of the first outline:
those are the curves then, and the vertices are seated on them by projection.

Arrays from a file may hold anything: :func:`from_arrays` checks every number before it is used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from meshwright_core.core.arrays import (
    CURVE,
    ELEMENT_SLOTS,
    MARK,
    NAMING,
    RESTORED,
    VERTEX_SLOTS,
    allocate,
)
from meshwright_core.core.curve_checks import require_seats
from meshwright_core.core.projected_seats import take_projected_seats
from meshwright_core.core.score_bound import bound_excess_of
from meshwright_core.errors import MeshError
from meshwright_core.history import step_archive
from meshwright_core.history.journal import WRITE_KINDS
from meshwright_core.history.packed_steps import (
    COLUMNS,
    Steps,
    divided,
    first_steps,
    joined,
    last_steps,
)
from meshwright_core.io.snapshot_checks import require_sound, require_within
from meshwright_core.io.snapshot_curves import boundary_arrays, outline_boundary, stored_boundary
from meshwright_core.io.stored_arrays import Arrays, stored
from meshwright_core.mesh import HalfEdgeMesh

_COLUMNS = MARK  # columns of a vertex before its mark
MOST = 1 << 25
"""Slots of vertices or elements: places of their writes fit 32 bits."""
_FREE_ROOM, _MOST_ROOM = 1 << 20, 64
"""Room for vertices and elements that a file may ask for, and for each row of its arrays."""
_OLD_WRITE_KINDS = 4
"""WRITE_KINDS in files from before meshes had curves."""
_PARTS = ("rows", "places", "whole", "coordinates", "parameters")


def to_arrays(mesh: HalfEdgeMesh, done: int | None = None, undone: int | None = None) -> Arrays:
    """The arrays of a mesh and its history; those of the mesh itself are not copied.

    done, undone: how many steps on each side of the present state to keep; None for all.
    """
    m = mesh.arrays
    halfedges = int(m.counters[ELEMENT_SLOTS]) * mesh.k
    past, future = mesh.packed_steps()
    if done is not None:
        past = last_steps(past, done)
    if undone is not None:
        future = first_steps(future, undone)
    return {
        "sizes": np.array([mesh.k, len(m.vertex), len(m.element_mark), mesh.degree_cap]),
        "counters": m.counters[:RESTORED],
        "edge": m.edge[:halfedges],
        "vertex": np.ascontiguousarray(m.vertex[: mesh.slots, :_COLUMNS]),
        "points": mesh.points,
        "irregular": m.irregular,
        "curve": mesh.curve_ids(),
        "parameter": mesh.parameters(),
        "region": m.region[: int(m.counters[ELEMENT_SLOTS])],
        **boundary_arrays(mesh.namings, mesh.naming, mesh.seats_recorded),
        **steps_arrays(past, "done"),
        **steps_arrays(future, "undone"),
    }


def from_arrays(arrays: Mapping[str, np.ndarray]) -> HalfEdgeMesh:
    """The mesh and history stored by :func:`to_arrays`.

    Raises MeshError, without the file's name, if the arrays are invalid.
    """
    sizes = stored(arrays, "sizes", np.int64, (4,))
    k, vertices, elements, cap = sizes.tolist()
    if k not in (3, 4) or not (0 < vertices <= MOST and 0 < elements <= MOST):
        raise MeshError("its sizes are not those of a mesh")
    if elements > 64 * (vertices + 64):
        raise MeshError("it has room for more elements than its vertices can have")
    if cap < 0:
        raise MeshError("its degree cap is negative")
    held = sum(len(array) for name, array in arrays.items() if array.ndim and name != "irregular")
    if max(vertices, elements) > _FREE_ROOM + _MOST_ROOM * held:
        raise MeshError("it has room for far more than it holds")
    counters = stored(arrays, "counters", np.int64, (RESTORED,))
    points = stored(arrays, "points", np.float64, (-1, 3))
    vertex = stored(arrays, "vertex", np.int32, (len(points), _COLUMNS))
    edge = stored(arrays, "edge", np.int32, (-1, 2))
    irregular = stored(arrays, "irregular", np.int32, (vertices,))
    if len(points) > vertices or len(edge) > k * elements or len(edge) % k:
        raise MeshError("its arrays are longer than their room")
    if counters[VERTEX_SLOTS] != len(points) or counters[ELEMENT_SLOTS] * k != len(edge):
        raise MeshError("its arrays are not as long as they should be")
    if (irregular < -1).any() or (irregular >= vertices).any():
        raise MeshError("its list of irregular vertices is wrong")
    m = allocate(k, vertices, elements)
    m.counters[:RESTORED] = counters
    m.edge[: len(edge)] = edge
    m.vertex[: len(vertex), :_COLUMNS] = vertex
    m.points[: len(points)] = points
    m.irregular[:] = irregular
    require_sound(m, k)
    old = _is_old(arrays)
    if old:
        namings, naming, recorded = {0: outline_boundary(arrays, vertices)}, 0, False
    else:
        namings, naming, recorded = stored_boundary(arrays)
    boundary = namings[naming]
    m.vertex[0, NAMING] = naming
    m = m._replace(curves=boundary.curves, interface=boundary.table())
    mesh = HalfEdgeMesh(m, boundary, cap, seats_recorded=recorded)
    for number, other in namings.items():
        mesh.add_naming(number, other)
    if old:
        take_projected_seats(m, mesh.boundary_loops(), boundary)
    else:
        m.vertex[: len(vertex), CURVE] = stored(arrays, "curve", np.int32, (len(points),))
        m.parameter[: len(points)] = stored(arrays, "parameter", np.float64, (len(points),))
        m.region[: len(edge) // k] = stored(arrays, "region", np.int32, (len(edge) // k,))
        require_seats(m, boundary)
        if boundary.bound_excess not in (0, bound_excess_of(m)):
            raise MeshError("its lower bound of s is not that of its regions")
    done, undone = (restored_steps(arrays, name, mesh) for name in ("done", "undone"))
    mesh.adopt_steps(done, undone)
    return mesh


def _is_old(arrays: Mapping[str, np.ndarray]) -> bool:
    """Whether the arrays are from before meshes had curves."""
    return "outline.lengths" in arrays and "curve" not in arrays


def steps_arrays(pieces: Sequence[Steps], name: str) -> Arrays:
    """Steps as arrays whose names begin with `name`."""
    whole = joined(pieces)
    return {f"{name}.{part}": getattr(whole, part) for part in _PARTS}


def restored_steps(
    arrays: Mapping[str, np.ndarray], name: str, mesh: HalfEdgeMesh
) -> tuple[Steps, ...]:
    """The steps stored by :func:`steps_arrays`; MeshError if they do not fit the mesh."""
    rows = stored(arrays, f"{name}.rows", np.int32, (-1, COLUMNS))
    places = stored(arrays, f"{name}.places", np.int32, (-1,))
    whole = stored(arrays, f"{name}.whole", np.int32, (-1,))
    deep = arrays.get(f"{name}.coordinates", places).shape[-1:] == (3,)
    coordinates = stored(arrays, f"{name}.coordinates", np.float64, (-1, 3 if deep else 2))
    if not _is_old(arrays):
        parameters = stored(arrays, f"{name}.parameters", np.float64, (-1,))
    else:
        parameters = np.zeros(0)
        index, kind = np.divmod(places, _OLD_WRITE_KINDS)
        if (index > MOST).any():
            raise MeshError("a step of the history points beyond the mesh")
        places = index * np.int32(WRITE_KINDS) + kind
    steps = Steps.of(rows, places, whole, coordinates, parameters)
    m = mesh.arrays
    require_within(steps, m, list(mesh.namings))
    return tuple(divided(steps, step_archive.PIECE))
