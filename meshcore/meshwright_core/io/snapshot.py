"""A mesh and its history as named arrays for files, exact to the bit.

=================  =====================================================================
``sizes``          (4,) sides of an element; room for vertices and elements; degree cap
``counters``       (10,) the counters that an undo restores
``edge``           (h, 2) origin and twin of each half-edge in use
``vertex``         (v, 5) half-edge, degree, desired degree, flags, place among the irregular
``points``         (v, 3) coordinates
``irregular``      (room,) the irregular vertices, with what is left behind them
``outline.*``      length of each loop of the first outline; vertex ids and points of all loops
``done.*``         steps that can be undone: see :class:`meshwright_core.history.packed_steps.Steps`
``undone.*``       steps that can be done again
=================  =====================================================================

Arrays from a file may hold anything: :func:`from_arrays` checks every number before it is used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from meshwright_core.core.arrays import ELEMENT_SLOTS, MARK, RESTORED, VERTEX_SLOTS, allocate
from meshwright_core.errors import MeshError
from meshwright_core.history import step_archive
from meshwright_core.history.packed_steps import COLUMNS, Steps, divided, joined
from meshwright_core.io.snapshot_checks import require_sound, require_within
from meshwright_core.mesh import HalfEdgeMesh

Arrays = dict[str, np.ndarray]

_COLUMNS = MARK  # columns of a vertex before its mark
MOST = 1 << 28
"""Slots of vertices or elements: places of their writes fit 32 bits."""
_PARTS = ("rows", "places", "whole", "coordinates")


def to_arrays(mesh: HalfEdgeMesh) -> Arrays:
    """The arrays of a mesh and its history; those of the mesh itself are not copied."""
    m = mesh.arrays
    halfedges = int(m.counters[ELEMENT_SLOTS]) * mesh.k
    loops = mesh.outline
    done, undone = mesh.packed_steps()
    return {
        "sizes": np.array([mesh.k, len(m.vertex), len(m.element_mark), mesh.degree_cap]),
        "counters": m.counters[:RESTORED],
        "edge": m.edge[:halfedges],
        "vertex": np.ascontiguousarray(m.vertex[: mesh.slots, :_COLUMNS]),
        "points": mesh.points,
        "irregular": m.irregular,
        "outline.lengths": np.array([len(ids) for ids, _ in loops], np.int64),
        "outline.ids": np.concatenate([np.zeros(0, np.int64), *(ids for ids, _ in loops)]),
        "outline.points": np.concatenate([np.zeros((0, 3)), *(points for _, points in loops)]),
        **steps_arrays(done, "done"),
        **steps_arrays(undone, "undone"),
    }


def from_arrays(arrays: Mapping[str, np.ndarray]) -> HalfEdgeMesh:
    """The mesh and history stored by :func:`to_arrays`.

    Raises MeshError, without the file's name, if the arrays are invalid.
    """
    sizes = _array(arrays, "sizes", np.int64, (4,))
    k, vertices, elements, cap = sizes.tolist()
    if k not in (3, 4) or not (0 < vertices <= MOST and 0 < elements <= MOST):
        raise MeshError("its sizes are not those of a mesh")
    if elements > 64 * (vertices + 64):
        raise MeshError("it has room for more elements than its vertices can have")
    if cap < 0:
        raise MeshError("its degree cap is negative")
    counters = _array(arrays, "counters", np.int64, (RESTORED,))
    points = _array(arrays, "points", np.float64, (-1, 3))
    vertex = _array(arrays, "vertex", np.int32, (len(points), _COLUMNS))
    edge = _array(arrays, "edge", np.int32, (-1, 2))
    irregular = _array(arrays, "irregular", np.int32, (vertices,))
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
    mesh = HalfEdgeMesh(m, _outline(arrays, vertices), cap)
    done, undone = (restored_steps(arrays, name, mesh) for name in ("done", "undone"))
    mesh.adopt_steps(done, undone)
    return mesh


def steps_arrays(pieces: Sequence[Steps], name: str) -> Arrays:
    """Steps as arrays whose names begin with `name`."""
    whole = joined(pieces)
    return {f"{name}.{part}": getattr(whole, part) for part in _PARTS}


def restored_steps(
    arrays: Mapping[str, np.ndarray], name: str, mesh: HalfEdgeMesh
) -> tuple[Steps, ...]:
    """The steps stored by :func:`steps_arrays`; MeshError if they do not fit the mesh."""
    rows = _array(arrays, f"{name}.rows", np.int32, (-1, COLUMNS))
    places = _array(arrays, f"{name}.places", np.int32, (-1,))
    whole = _array(arrays, f"{name}.whole", np.int32, (-1,))
    deep = arrays.get(f"{name}.coordinates", places).shape[-1:] == (3,)
    coordinates = _array(arrays, f"{name}.coordinates", np.float64, (-1, 3 if deep else 2))
    steps = Steps(rows, places, whole, coordinates)
    m = mesh.arrays
    require_within(steps, mesh.k, len(m.vertex), len(m.element_mark))
    return tuple(divided(steps, step_archive.PIECE))


def _array(
    arrays: Mapping[str, np.ndarray], name: str, kind: type, shape: tuple[int, ...]
) -> np.ndarray:
    """The array of that name as `kind`, -1 for any length; MeshError if it is another one."""
    found = arrays.get(name)
    if found is None:
        raise MeshError(f"it lacks its {name}")
    fits = found.ndim == len(shape) and all(
        wanted in (-1, length) for wanted, length in zip(shape, found.shape, strict=True)
    )
    if found.dtype != kind or not fits:
        raise MeshError(f"its {name} are not as they should be")
    return np.ascontiguousarray(found)


def _outline(
    arrays: Mapping[str, np.ndarray], vertices: int
) -> list[tuple[np.ndarray, np.ndarray]]:
    lengths = _array(arrays, "outline.lengths", np.int64, (-1,))
    ids = _array(arrays, "outline.ids", np.int64, (-1,))
    points = _array(arrays, "outline.points", np.float64, (len(ids), 3))
    if (lengths < 3).any() or (lengths > len(ids)).any() or lengths.sum() != len(ids):
        raise MeshError("its outline is cut off")
    if (ids < -1).any() or (ids >= vertices).any() or not np.isfinite(points).all():
        raise MeshError("its outline is not the mesh's")
    cuts = np.cumsum(lengths)[:-1]
    return list(zip(np.split(ids, cuts), np.split(points, cuts), strict=True))
