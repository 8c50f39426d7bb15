"""Removing clean-ups from a list of operations, for quad meshes that became too coarse to draw.

A clean-up changes no irregularity. Without the clean-ups the result therefore has the same s,
provided that the other operations can still be applied, but more elements.
"""

from __future__ import annotations

import numpy as np

from meshwright_agent.search.annealing import Operations, with_room
from meshwright_agent.search.shortening import (
    ReplayLimits,
    first_names,
    name_all,
    nothing_replayed,
    replay,
)
from meshwright_core.core.arrays import MeshArrays, copied
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import CLEANUP, CODES, NAMES

_UNLIMITED = 1 << 40


def without_cleanups(mesh: HalfEdgeMesh, operations: Operations) -> Operations:
    """The operations without clean-ups, and without those that then cannot be applied.

    They end at the first state whose s is as low as at the end of `operations`; if there is no such
    state, `operations` is returned.
    """
    codes = np.array([CODES[mesh.k][operation] for operation, _ in operations], np.int32)
    halfedges = np.array([h for _, h in operations], np.int64)
    if not (codes == CLEANUP).any():
        return operations
    start = with_room(mesh, 4 * mesh.n_elements)
    entries = np.zeros((len(codes), 5), np.int32)
    states = np.zeros((len(codes) + 1, 3), np.int64)
    names = int(name_all(_copy(start), codes, halfedges, mesh.slots, 0, entries, states))
    if names < 0:
        return operations
    left = entries[codes != CLEANUP]
    done = nothing_replayed(len(left))
    stop = replay(
        _copy(start), first_names(mesh.slots, len(start.vertex), names), left, 0, len(left),
        ReplayLimits(0, 0, int(states[-1, 1]), _UNLIMITED, 0, np.zeros((2, 0), np.uint64)), done,
    )  # fmt: skip
    if stop < 0:
        return operations
    kept = np.flatnonzero(done.kept[:stop])
    codes, halfedges = left[kept, 0], done.halfedges[kept]
    return [(NAMES[code], h) for code, h in zip(codes.tolist(), halfedges.tolist(), strict=True)]


def _copy(arrays: MeshArrays) -> MeshArrays:
    return copied(arrays)
