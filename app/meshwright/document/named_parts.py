"""The names of a mesh as a list, and the sides and regions that are selected."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import ORIGIN
from meshwright_core.core.names import groups
from meshwright_core.core.side_names import names_of, side_edges

MOST_SIDES = 100
"""More sides without a name are not listed: a boundary with a corner at every vertex."""


class NamedPart(NamedTuple):
    """A group of sides or of regions."""

    name: str
    """"" for those without one."""
    sides: bool
    """Whether it is one of sides, else of regions."""
    size: int
    """Its edges, or its elements."""
    regions: tuple[int, ...] = ()
    """The numbers of its regions."""
    halfedges: tuple[int, ...] = ()
    """Of a side without a name, from corner to corner."""


def named_parts(mesh: HalfEdgeMesh) -> list[NamedPart]:
    """The groups of a mesh: first sides, then regions, those without a name last of each."""
    edges: dict[str, int] = {}
    for name, ends in mesh.sides().items():
        for group in groups(name):
            edges[group] = edges.get(group, 0) + len(ends)
    found = [NamedPart(name, True, count) for name, count in edges.items()]
    sides = unnamed_sides(mesh)
    if len(sides) <= MOST_SIDES:
        found += [NamedPart("", True, len(side), (), tuple(side.tolist())) for side in sides]
    counts = np.bincount(mesh.regions(), minlength=len(mesh.region_names)).tolist()
    members: dict[str, list[int]] = {}
    for number, name in enumerate(mesh.region_names):
        for group in groups(name) or (f"\0{number}",):
            members.setdefault(group, []).append(number)
    for name, numbers in sorted(members.items(), key=lambda one: one[0].startswith("\0")):
        plain = "" if name.startswith("\0") else name
        total = sum(counts[number] for number in numbers)
        found.append(NamedPart(plain, False, total, tuple(numbers)))
    return found


def unnamed_sides(mesh: HalfEdgeMesh) -> list[np.ndarray]:
    """The side edges without a name as half-edges (n,), from one corner to the next along each
    curve; a closed curve without corners is one side.
    """
    found = side_edges(mesh.arrays)
    names = names_of(mesh.boundary_info, found.curve, found.span)
    order = np.lexsort((found.span[:, 0], found.curve))
    order = order[[not names[i] for i in order]]
    halfedges, curve = found.halfedges[order], found.curve[order]
    if not len(halfedges):
        return []
    origin = mesh.arrays.edge[:, ORIGIN]
    start = origin[halfedges]
    stop = origin[_ahead(mesh, halfedges)]
    corner = mesh.geometric()
    begins = np.append(True, (curve[1:] != curve[:-1]) | (start[1:] != stop[:-1]))
    begins |= corner[start]
    firsts = np.flatnonzero(begins)
    sides = np.split(np.arange(len(halfedges)), firsts[1:])
    for number in np.unique(curve):  # a closed curve may begin inside a side
        mine = [i for i, side in enumerate(sides) if curve[side[0]] == number]
        first, last = mine[0], mine[-1]
        meets = stop[sides[last][-1]] == start[sides[first][0]]
        if first != last and meets and not corner[start[sides[first][0]]]:
            sides[first] = np.append(sides[last], sides[first])
            del sides[last]
    return [halfedges[side] for side in sides]


def vertices_of(mesh: HalfEdgeMesh, part: NamedPart) -> np.ndarray:
    """(n,) the vertices of the sides or of the elements of a part, each once."""
    if not part.sides:
        chosen = np.isin(mesh.regions(), part.regions)
        return np.unique(mesh.corners(mesh.element_ids()[chosen]))
    halfedges = np.array(part.halfedges, np.int64)
    if not len(halfedges):
        found = side_edges(mesh.arrays)
        names = names_of(mesh.boundary_info, found.curve, found.span)
        halfedges = found.halfedges[[part.name in groups(name) for name in names]]
    origin = mesh.arrays.edge[:, ORIGIN]
    return np.unique(np.append(origin[halfedges], origin[_ahead(mesh, halfedges)]))


def _ahead(mesh: HalfEdgeMesh, halfedges: np.ndarray) -> np.ndarray:
    """The next half-edges in the same elements."""
    following: np.ndarray = halfedges - halfedges % mesh.k + (halfedges + 1) % mesh.k
    return following


def selected_sides(mesh: HalfEdgeMesh, vertices: np.ndarray) -> np.ndarray:
    """(n,) half-edges of the side edges between selected vertices (m,)."""
    inside = np.zeros(mesh.slots + 1, bool)
    inside[vertices] = True
    found = side_edges(mesh.arrays).halfedges
    origin = mesh.arrays.edge[:, ORIGIN]
    chosen: np.ndarray = found[inside[origin[found]] & inside[origin[_ahead(mesh, found)]]]
    return chosen


def selected_regions(mesh: HalfEdgeMesh, elements: np.ndarray) -> list[int]:
    """The regions of selected elements (m,)."""
    return np.unique(mesh.arrays.region[elements]).astype(int).tolist()
