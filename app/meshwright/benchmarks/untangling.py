"""Untangling against averaging on meshes that random operations have reached.

Two walks: over any allowed operations, which soon reach meshes that have no valid
embedding (a doublet, a flat corner, an edge between two corners that do not see each other); and
one that takes back every operation after which :func:`drawable` sees such an obstacle. What passes
that test need not be drawable either: it looks at single corners and edges.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np

from meshwright.console import Update, no_update
from meshwright_core import HalfEdgeMesh
from meshwright_core.analysis.drawability import Obstacles
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry import quality, smoothing, untangling
from meshwright_core.geometry.unfixable import unfixable

SUMMARY = "share of randomly edited meshes without inverted elements: as is, averaged, untangled"

MESHES = 200
QUICK = 6
LARGEST = 300
"""Elements beyond which no more operations are applied."""


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Compare on the meshes of the suite, half of them triangles."""
    return compare(QUICK if quick else MESHES, seed, update)


def compare(meshes: int = MESHES, seed: int = 0, update: Update = no_update) -> dict[str, Any]:
    """Shares of meshes without inverted elements and times, by walk and kind of mesh."""
    walks: dict[str, Any] = {}
    for walk in ("drawable", "any"):
        rng = np.random.default_rng(seed)
        rows: dict[str, list[dict[str, Any]]] = {"tri": [], "quad": []}
        for number in range(meshes):
            kind = "quad" if number % 2 else "tri"
            mesh = edited(_start(kind, number % 4 < 2, rng), rng, walk == "drawable")
            rows[kind].append(_measured(mesh))
            update(number + 1, f"{walk} {kind}")
        walks[walk] = {kind: _summary(found) for kind, found in rows.items() if found}
    return walks


def _start(kind: str, polygon: bool, rng: np.random.Generator) -> HalfEdgeMesh:
    """A mesh of a random polygon or of a shape from the gallery."""
    if polygon:
        return meshing.benchmark_mesh(kind, int(rng.integers(6, 31)), rng)
    names = list(gallery.gallery())
    return meshing.mesh_domain(gallery.shape(names[int(rng.integers(len(names)))]), kind)


def edited(start: HalfEdgeMesh, rng: np.random.Generator, careful: bool) -> HalfEdgeMesh:
    """A copy of `start` after 30 to 100 random operations, without smoothing.

    `careful`: operations whose result is not :func:`drawable` are taken back, and degrees are
    capped as the agent caps them.
    """
    mesh = start.copy()
    mesh.degree_cap = (9 if mesh.k == 3 else 7) if careful else 0
    obstacles = Obstacles(mesh)
    names = list(mesh.allowed(-1))
    left = int(rng.integers(30, 101))
    for _ in range(30 * left):
        if not left or mesh.n_elements > LARGEST:
            break
        ids = mesh.element_ids()
        h = int(ids[rng.integers(len(ids))]) * mesh.k + int(rng.integers(mesh.k))
        operation = names[int(rng.integers(len(names)))]
        if not mesh.check(operation, h):
            continue
        mesh.apply(operation, h)
        if careful and not drawable(mesh, obstacles):
            mesh.undo()
        else:
            left -= 1
    return mesh


def drawable(mesh: HalfEdgeMesh, obstacles: Obstacles) -> bool:
    """Whether no simple obstacle to a drawing is found, and no unfixable corner."""
    return not len(unfixable(mesh)) and not obstacles.count(mesh)


Moves = tuple[np.ndarray, np.ndarray, np.ndarray]
Method = Callable[[HalfEdgeMesh], Moves]


def _untangled(mesh: HalfEdgeMesh) -> Moves:
    found = untangling.untangle(mesh)
    return found.vertices, found.positions, found.parameters


METHODS: dict[str, Method] = {
    "averaging": smoothing.average,
    "guarded averaging": smoothing.smooth,
    "untangling": _untangled,
}


def _measured(mesh: HalfEdgeMesh) -> dict[str, Any]:
    row: dict[str, Any] = {
        "elements": mesh.n_elements,
        "obstacle": not drawable(mesh, Obstacles(mesh)),
        "as is": not len(quality.inverted(mesh)),
    }
    for name, method in METHODS.items():
        work = mesh.copy()
        begin = time.perf_counter()
        moves = method(work)
        row[name + " ms"] = 1e3 * (time.perf_counter() - begin)
        work.move(*moves)
        row[name] = not len(quality.inverted(work))
    return row


def _summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "meshes": len(rows),
        "with_a_plain_obstacle": sum(row["obstacle"] for row in rows) / len(rows),
        "elements_median": median(row["elements"] for row in rows),
        "without_inverted": {
            name: sum(row[name] for row in rows) / len(rows) for name in ("as is", *METHODS)
        },
        "milliseconds_median": {
            name: median(row[name + " ms"] for row in rows) for name in METHODS
        },
        "milliseconds_longest": {name: max(row[name + " ms"] for row in rows) for name in METHODS},
    }
