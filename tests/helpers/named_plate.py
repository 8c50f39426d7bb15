"""A plate of two regions with named sides, what its names cover, and operations on it."""

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.names import groups
from meshwright_core.core.side_names import Names

SIDES = {"inlet": [(0, 5), (5, 10)], "wall; hot": [(0, 1), (1, 2)], "wall": [(2, 3), (3, 4)]}
JOINT = [(2, 7), (7, 12)]


def plate(kind: str = "quad") -> HalfEdgeMesh:
    """Four by two unit squares, the left half steel and the right one copper; vertex i + 5 j."""
    points = np.array([(i, j) for j in range(3) for i in range(5)], float)
    corners = [i + 5 * j for j in range(2) for i in range(4)]
    cells = [(c, c + 1, c + 6, c + 5) for c in corners]
    regions = [0, 0, 1, 1] * 2
    if kind == "tri":
        cells = [t for a, b, c, d in cells for t in ((a, b, c), (a, c, d))]
        regions = np.repeat(regions, 2)
    edges = [ends for some in SIDES.values() for ends in some] + JOINT
    sides = [name for name, some in SIDES.items() for _ in some] + ["joint"] * 2
    names = Names(("steel", "copper"), np.array(edges), sides, {(1, "inlet"): 7, (2, "steel"): 3})
    return HalfEdgeMesh.from_elements(points, cells, regions=regions, names=names)


def measures(mesh: HalfEdgeMesh) -> dict[str, tuple[float, ...]]:
    """By group of sides its length and box, by group of regions its area and box."""
    found: dict[str, list[np.ndarray]] = {}
    for name, ends in mesh.sides().items():
        for group in groups(name):
            found.setdefault(group, []).append(mesh.points[ends][:, :, :2])
    measured = {}
    for group, parts in found.items():
        lines = np.concatenate(parts)
        size = np.linalg.norm(np.diff(lines, axis=1), axis=2).sum()
        measured[group] = box_and(size, lines)
    shapes = mesh.points[mesh.elements()][:, :, :2]
    x, y = shapes[..., 0], shapes[..., 1]
    areas = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    for name in set(mesh.region_names) - {""}:
        rows = np.array(mesh.region_names)[mesh.regions()] == name
        measured[f"region {name}"] = box_and(areas[rows].sum(), shapes[rows])
    return measured


def box_and(size: float, places: np.ndarray) -> tuple[float, ...]:
    flat = places.reshape(-1, 2)
    return tuple(np.round([size, *flat.min(axis=0), *flat.max(axis=0)], 6).tolist())


EXPECTED = {
    "inlet": (2.0, 0.0, 0.0, 0.0, 2.0),
    "wall": (4.0, 0.0, 0.0, 4.0, 0.0),
    "hot": (2.0, 0.0, 0.0, 2.0, 0.0),
    "joint": (2.0, 2.0, 0.0, 2.0, 2.0),
    "region steel": (4.0, 0.0, 0.0, 2.0, 2.0),
    "region copper": (4.0, 2.0, 0.0, 4.0, 2.0),
}


def edit(mesh: HalfEdgeMesh, rng: np.random.Generator) -> None:
    """200 operations; positions of new boundary vertices lie on their side."""
    done = 0
    for _ in range(20_000):
        h = int(rng.integers(mesh.k * int(mesh.arrays.counters[1])))
        some = ["flip_left", "flip_right", "split", "global_split", "collapse"]
        name = "collapse" if mesh.n_elements > 60 else str(rng.choice(some))
        if mesh.live(h) and mesh.check(name, h):
            mesh.apply(name, h)
            done += 1
            if done == 200:
                return
    raise AssertionError(done)
