"""Random edits of a mesh, and everything that an undo must restore."""

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import ELEMENT_SLOTS, RESTORED
from meshwright_core.operations.catalogue import of_kind


def state(mesh: HalfEdgeMesh) -> list[bytes]:
    """The contents of all arrays that an undo restores."""
    arrays = mesh.arrays
    ends = (mesh.k * int(arrays.counters[ELEMENT_SLOTS]), mesh.slots)
    return [
        arrays.edge[: ends[0]].tobytes(),
        arrays.vertex[: ends[1]].tobytes(),
        mesh.points.tobytes(),
        mesh.parameters().tobytes(),
        arrays.region[: ends[0] // mesh.k].tobytes(),
        arrays.irregular[: mesh.irregular_count].tobytes(),
        arrays.counters[:RESTORED].tobytes(),
    ]


def wander(mesh: HalfEdgeMesh, steps: int, seed: int = 0) -> list[list[bytes]]:
    """Apply ``steps`` random operations and moves; returns the state after each."""
    rng = np.random.default_rng(seed)
    infos = of_kind(mesh.kind)
    states = []
    while len(states) < steps:
        h = int(rng.choice(mesh.element_ids())) * mesh.k + int(rng.integers(mesh.k))
        operation = infos[rng.integers(len(infos))].operation
        if rng.random() < 0.2:
            some = rng.choice(mesh.vertices(), 3, replace=False)
            mesh.move(some, mesh.points[some] + [1e-3, 1e-3, 0])
        elif mesh.check(operation, h):
            with mesh.transaction():
                mesh.apply(operation, h)
                some = mesh.vertices()[:2]
                mesh.move(some, mesh.points[some] * 1.001)
        else:
            continue
        states.append(state(mesh))
    return states
