"""Untangling against averaging on meshes that random operations have reached.

Two walks: over any allowed operations, which soon reach meshes that cannot be drawn with straight
edges (a doublet, a flat corner, an edge between two corners that do not see each other); and one
that takes back every operation after which :func:`drawable` sees such an obstacle. What passes that
test need not be drawable either: it looks at single corners and edges.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np
import shapely
from meshwright_core.geometry.sides import Sides

from meshwright.console import Update, no_update
from meshwright_core import HalfEdgeMesh
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
    inside = _domain(mesh)
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
        if careful and not drawable(mesh, inside):
            mesh.undo()
        else:
            left -= 1
    return mesh


def _domain(mesh: HalfEdgeMesh) -> shapely.Geometry:
    """The domain of a mesh, slightly enlarged: segments along its boundary count as inside."""
    loops = sorted(
        (shapely.Polygon(points[:, :2]) for _, points in mesh.outline), key=lambda loop: -loop.area
    )
    domain = shapely.Polygon(loops[0].exterior, [loop.exterior for loop in loops[1:]]).buffer(1e-9)
    shapely.prepare(domain)
    return domain


def drawable(mesh: HalfEdgeMesh, domain: shapely.Geometry) -> bool:
    """Whether no simple obstacle to a drawing with straight edges is found.

    No unfixable corner; no edge between corners that leaves the domain; no edge inside that joins
    two vertices of one straight side.
    """
    if len(unfixable(mesh)):
        return False
    elements = mesh.elements()
    a, b = elements.ravel(), np.roll(elements, -1, axis=1).ravel()
    boundary, fixed = mesh.boundary(), mesh.geometric()
    ends = {
        (x, y) for x, y in zip(a.tolist(), b.tolist(), strict=True) if boundary[x] & boundary[y]
    }
    chords = [(x, y) for x, y in ends if (y, x) in ends and x < y]
    seen = [(x, y) for x, y in chords if fixed[x] and fixed[y]]
    if seen and not shapely.covers(domain, shapely.linestrings(mesh.points[seen][..., :2])).all():
        return False
    where = Sides(mesh)
    straight: dict[int, set[int]] = {}
    for number, chain in enumerate(where.chains):
        if where.polylines.first[number + 1] - where.polylines.first[number] == 2:
            for v in chain.tolist():
                straight.setdefault(v, set()).add(number)
    return not any(straight.get(x, set()) & straight.get(y, set()) for x, y in chords)


Method = Callable[[HalfEdgeMesh], tuple[np.ndarray, np.ndarray]]


def _untangled(mesh: HalfEdgeMesh) -> tuple[np.ndarray, np.ndarray]:
    found = untangling.untangle(mesh)
    return found.vertices, found.positions


METHODS: dict[str, Method] = {
    "averaging": smoothing.average,
    "guarded averaging": smoothing.smooth,
    "untangling": _untangled,
}


def _measured(mesh: HalfEdgeMesh) -> dict[str, Any]:
    row: dict[str, Any] = {
        "elements": mesh.n_elements,
        "obstacle": not drawable(mesh, _domain(mesh)),
        "as is": not len(quality.inverted(mesh)),
    }
    for name, method in METHODS.items():
        work = mesh.copy()
        begin = time.perf_counter()
        vertices, positions = method(work)
        row[name + " ms"] = 1e3 * (time.perf_counter() - begin)
        work.move(vertices, positions)
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
