"""The names of a mesh as a list, and the sides and regions that are selected."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import ORIGIN
from meshwright_core.core.names import groups
from meshwright_core.core.side_names import side_edges


class NamedPart(NamedTuple):
    """A group of sides or of regions."""

    name: str
    """"" for regions without one."""
    sides: bool
    """Whether it is one of sides, else of regions."""
    size: int
    """Its edges, or its elements."""
    regions: tuple[int, ...] = ()
    """The numbers of its regions."""


def named_parts(mesh: HalfEdgeMesh) -> list[NamedPart]:
    """The groups of a mesh: first sides, then regions; regions without a name if it has several."""
    edges: dict[str, int] = {}
    for name, ends in mesh.sides().items():
        for group in groups(name):
            edges[group] = edges.get(group, 0) + len(ends)
    found = [NamedPart(name, True, count) for name, count in edges.items()]
    counts = np.bincount(mesh.regions(), minlength=len(mesh.region_names)).tolist()
    members: dict[str, list[int]] = {}
    for number, name in enumerate(mesh.region_names):
        for group in groups(name) or ((f"\0{number}",) if len(counts) > 1 else ()):
            members.setdefault(group, []).append(number)
    for name, numbers in members.items():
        plain = "" if name.startswith("\0") else name
        total = sum(counts[number] for number in numbers)
        found.append(NamedPart(plain, False, total, tuple(numbers)))
    return found


def selected_sides(mesh: HalfEdgeMesh, vertices: np.ndarray) -> np.ndarray:
    """(n,) half-edges of the side edges between selected vertices (m,)."""
    inside = np.zeros(mesh.slots + 1, bool)
    inside[vertices] = True
    found = side_edges(mesh.arrays).halfedges
    origin = mesh.arrays.edge[:, ORIGIN]
    ahead = found - found % mesh.k + (found + 1) % mesh.k
    chosen: np.ndarray = found[inside[origin[found]] & inside[origin[ahead]]]
    return chosen


def selected_regions(mesh: HalfEdgeMesh, elements: np.ndarray) -> list[int]:
    """The regions of selected elements (m,)."""
    return np.unique(mesh.arrays.region[elements]).astype(int).tolist()
