"""The faces of a network of curves: what it encloses, and which curves enclose nothing."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.components import components
from meshwright_core.core.time_limit import check_time
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.io.drawings.drawn import Points
from meshwright_core.io.drawings.tracing import measures
from meshwright_core.io.drawings.tracing.network import Edge, Network

_NEAR, _FAR = 0.01, 0.2
"""Shares of the shortest curve at a node that are followed to see in which order curves leave it:
the second one where directions differ by less than `_ALIKE`."""
_ALIKE = 0.05
"""Radians."""

Way = tuple[int, bool]
"""An edge by index, and whether it is run through backwards."""


@dataclass
class Face:
    """A part of the plane that the network encloses.

    Attributes:
        ways: the edges around it, counter-clockwise.
        area: inside of them, whatever else lies there.
        island: the connected part of the network that it belongs to.
    """

    ways: list[Way]
    area: float
    island: int


@dataclass
class Island:
    """A connected part of the network.

    Attributes:
        rim: the edges around it, clockwise: seen from outside.
        faces: by index.
        area: inside of the rim.
    """

    rim: list[Way]
    faces: list[int] = field(default_factory=list)
    area: float = 0.0


@dataclass
class Faces:
    """All faces and islands; the edges that enclose something, the others by index."""

    edges: list[Edge]
    faces: list[Face]
    islands: list[Island]
    stray: list[int]

    def outline(self, ways: Iterable[Way]) -> Points:
        """(n, 2) points along a closed way, without the last one, which is the first one."""
        rows = []
        for i, back in ways:
            points = self.edges[i].dense
            rows.append(points[::-1][:-1] if back else points[:-1])
        return np.concatenate(rows)

    @cached_property
    def polygons(self) -> NDArray[np.object_]:
        """Of each face the polygon through points along it, whatever else lies inside."""
        lines = [self.outline(face.ways) for face in self.faces]
        owner = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
        rings = shapely.linearrings(np.concatenate(lines), indices=owner)
        found: NDArray[np.object_] = shapely.polygons(rings)
        return found


def faces_of(network: Network) -> Faces:
    """Return the faces of a network. Edges that do not bound two different ones are strays."""
    edges = network.edges
    alive = _pruned(network)
    while True:
        check_time()
        cycles, of = _cycles(network, alive)
        bridges = [i for i in np.flatnonzero(alive).tolist() if of[2 * i] == of[2 * i + 1]]
        if not bridges:
            break
        alive[bridges] = False
    label = _labels(network, alive)
    origin = network.nodes.mean(axis=0) if len(network.nodes) else np.zeros(2)
    area = [measures.area_about(edge.curve, origin) if alive[i] else 0.0
            for i, edge in enumerate(edges)]  # fmt: skip
    faces: list[Face] = []
    islands: dict[int, Island] = {}
    for cycle in cycles:
        ways = [(h // 2, h % 2 == 1) for h in cycle]
        inside = sum(-area[i] if back else area[i] for i, back in ways)
        island = islands.setdefault(int(label[edges[ways[0][0]].a]), Island([]))
        if inside > 0.0:
            faces.append(Face(ways, inside, -1))
            island.faces.append(len(faces) - 1)
        elif not island.rim or inside < -island.area:
            island.rim, island.area = ways, -inside
    found = [island for island in islands.values() if island.rim and island.faces]
    for number, island in enumerate(found):
        for i in island.faces:
            faces[i].island = number
    stray = np.flatnonzero(~alive).tolist()
    return Faces(edges, faces, found, stray)


def _pruned(network: Network) -> NDArray[np.bool_]:
    """Flags of the edges that are left when loose ends are taken away again and again."""
    at: dict[int, set[int]] = {}
    for i, edge in enumerate(network.edges):
        at.setdefault(edge.a, set()).add(i)
        at.setdefault(edge.b, set()).add(i)
    alive = np.ones(len(network.edges), dtype=bool)
    degree = network.degrees()
    pending = np.flatnonzero(degree == 1).tolist()
    while pending:
        node = pending.pop()
        if not at[node] or degree[node] != 1:
            continue
        i = at[node].pop()
        alive[i] = False
        edge = network.edges[i]
        other = edge.b if edge.a == node else edge.a
        at[other].discard(i)
        degree[node] -= 1
        degree[other] -= 1
        if degree[other] == 1:
            pending.append(other)
    return alive


def _cycles(
    network: Network, alive: NDArray[np.bool_]
) -> tuple[list[list[int]], NDArray[np.int64]]:
    """Ways around faces as half-edges (2 edge, or 2 edge + 1 backwards), and the way of each."""
    edges = network.edges
    leaving: dict[int, list[int]] = {}
    for i in np.flatnonzero(alive).tolist():
        leaving.setdefault(edges[i].a, []).append(2 * i)
        leaving.setdefault(edges[i].b, []).append(2 * i + 1)
    before: dict[int, int] = {}
    for node, halves in leaving.items():
        ordered = halves if len(halves) < 3 else _around(network, node, halves)
        for one, other in zip(ordered, [*ordered[1:], ordered[0]], strict=True):
            before[other] = one
    cycles: list[list[int]] = []
    of = np.full(2 * len(edges), -1)
    for i in np.flatnonzero(alive).tolist():
        for half in (2 * i, 2 * i + 1):
            if of[half] >= 0:
                continue
            cycle = []
            while of[half] < 0:
                of[half] = len(cycles)
                cycle.append(half)
                # with the face on the left: at its end turn as far to the left as one can
                half = before[half ^ 1]
            cycles.append(cycle)
    return cycles, of


def _around(network: Network, node: int, halves: list[int]) -> list[int]:
    """Half-edges that leave a node, counter-clockwise.

    Curves that leave in nearly one direction, as an arc and its tangent do, are put in the order
    that they have further away.
    """
    shortest = min(network.edges[half // 2].curve.length for half in halves)
    place = network.nodes[node]

    def angles(share: float) -> dict[int, float]:
        found = {}
        for half in halves:
            curve = network.edges[half // 2].curve
            step = measures.near_ends(curve, share * shortest)[half % 2] - place
            found[half] = float(np.arctan2(step[1], step[0]))
        return found

    check_time()
    near = angles(_NEAR)
    ordered = sorted(halves, key=lambda half: near[half])
    before = [ordered[-1], *ordered[:-1]]
    turns = [(near[h] - near[g]) % (2 * np.pi) for g, h in zip(before, ordered, strict=True)]
    # begin after the widest free angle, so that no group of neighbours is cut
    begin = int(np.argmax(turns))
    ordered, turns = ordered[begin:] + ordered[:begin], turns[begin:] + turns[:begin]
    if min(turns[1:]) >= _ALIKE:
        return ordered
    far = angles(_FAR)
    groups: list[list[int]] = []
    for half, turn in zip(ordered, turns, strict=True):
        if turn < _ALIKE and groups:
            groups[-1].append(half)
        else:
            groups.append([half])
    for group in groups:
        base = far[group[0]]
        group.sort(key=lambda half: float(np.angle(np.exp(1j * (far[half] - base)))))
    return [half for group in groups for half in group]


def _labels(network: Network, alive: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The connected part of each node."""
    ends = np.array([(e.a, e.b) for e, is_alive in zip(network.edges, alive, strict=True)
                     if is_alive], dtype=np.int64).reshape(-1, 2)  # fmt: skip
    return components(ends[:, 0], ends[:, 1], len(network.nodes))[1]


def around(faces: Faces) -> NDArray[np.int64]:
    """The face that encloses each island most tightly, of another island; -1 for none."""
    found = np.full(len(faces.islands), -1)
    if len(faces.islands) < 2:
        return found
    shapes = faces.polygons
    shapely.prepare(shapes)
    spots = np.array([_middle(faces.edges[island.rim[0][0]]) for island in faces.islands])
    island, face = pairs_near(shapely.points(spots), "within", others=shapes)
    for i, j in zip(island.tolist(), face.tolist(), strict=True):
        if faces.faces[j].island == i or faces.islands[i].area > faces.faces[j].area:
            continue
        if found[i] < 0 or faces.faces[j].area < faces.faces[found[i]].area:
            found[i] = j
    return found


def _middle(edge: Edge) -> Points:
    return edge.dense[len(edge.dense) // 2]
