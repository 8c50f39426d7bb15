"""A naive reference implementation: a mesh as a set of faces, for tests and the fuzz benchmark.

Faces are tuples of vertex ids, a half-edge is a pair of vertices (a, b), and all that is known of a
mesh is kept in dictionaries of these. Nothing is shared with the half-edge mesh.
:func:`meshwright_core.testing.face_list_rewrites.apply` changes a mesh by an operation.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

Face = tuple[int, ...]
Edge = tuple[int, int]
Range = tuple[int, float, float]
"""A curve, and the parameters on it where an edge begins and ends, the first one smaller."""


class Refused(Exception):
    """The operation would not leave a simple oriented manifold mesh, or deletes what must stay."""


class Change(NamedTuple):
    """What an operation has changed."""

    removed: dict[Face, int]
    """Faces with the regions that they had."""
    added: dict[Face, int]
    vertices: set[int]
    """All vertices of these faces."""
    edges: set[Edge]
    """All edges of these faces, the smaller id first, and those whose range has changed."""


class FaceList:
    """A mesh of faces with the data of its vertices, changed in place.

    Attributes:
        k: number of sides of each face.
        regions: the region of each face; a face begins with its smallest vertex id.
        left: the face on the left of each pair of vertices that it holds in this order.
        desired: the desired degree of each vertex.
        geometric, locked: vertices that must stay.
        ranges: the range of each edge along a curve, which leads from the vertex with the smaller
            parameter to the other.
        degree: number of edges of each vertex.
        edges, vertices: their numbers.
    """

    def __init__(
        self,
        faces: Sequence[Face],
        desired: dict[int, int],
        geometric: set[int],
        locked: set[int] | None = None,
        regions: Sequence[int] | None = None,
        ranges: dict[Edge, Range] | None = None,
    ) -> None:
        """A mesh of one region without curves, unless they are given.

        faces: counter-clockwise vertex ids, all of 3 or all of 4. regions: of each face. ranges:
        for each edge along a curve, from the vertex with the smaller parameter to the other.
        Raises Refused where two faces are on the same side of an edge.
        """
        self.k = len(faces[0])
        self.desired = dict(desired)
        self.geometric = set(geometric)
        self.locked = set(locked or ())
        self.regions: dict[Face, int] = {}
        self.left: dict[Edge, Face] = {}
        self.ranges: dict[Edge, Range] = {}
        self.degree: dict[int, int] = defaultdict(int)
        self.edges = self.vertices = 0
        self._around: dict[int, set[Face]] = defaultdict(set)
        self._open: dict[int, int] = defaultdict(int)  # boundary edges at each vertex
        self._ranged: dict[int, set[Edge]] = defaultdict(set)  # edges along curves at each vertex
        self._sizes: dict[int, int] = defaultdict(int)  # faces by region
        self._several = len(set(regions or ())) > 1
        self._log: list[tuple[Callable[..., None], tuple[object, ...]]] = []
        self._faces_changed: list[tuple[Face, bool, int]] = []
        self._ranges_changed: list[Edge] = []
        for face, region in zip(faces, regions or [0] * len(faces), strict=True):
            self._add(turned(face), region)
        if ranges is None:
            ranges = {(a, b): (0, 0.0, 1.0) for a, b in self.left if (b, a) not in self.left}
        for edge, place in ranges.items():
            self._put_range(edge, place)
        self.begin()

    @property
    def faces(self) -> set[Face]:
        """All faces, each begun with its smallest vertex id."""
        return set(self.regions)

    def on_boundary(self, v: int) -> bool:
        """Whether an edge of v has a face on one side only."""
        return self._open[v] > 0

    def on_curve(self, v: int) -> bool:
        """Whether v lies on the boundary or on the interface of two regions."""
        return bool(self._ranged[v])

    def faces_at(self, v: int) -> list[Face]:
        """The faces with the vertex v."""
        return list(self._around[v])

    def ranges_at(self, v: int) -> list[Edge]:
        """The edges along curves with the vertex v."""
        return list(self._ranged[v])

    def euler(self) -> int:
        """V - E + F."""
        return self.vertices - self.edges + len(self.regions)

    def delta_sum(self) -> int:
        """Sum of degree - desired degree."""
        return 2 * self.edges - sum(self.desired.values())

    # Changes, each noted so that it can be taken back

    def replace(self, old: Iterable[Face], new: Sequence[Face], regions: Sequence[int]) -> None:
        """Replace faces by others of the given regions; Refused if two are on the same side of an
        edge.
        """
        for face in map(turned, old):
            region = self.regions[face]
            self._log.append((self._add, (face, region)))
            self._faces_changed.append((face, False, region))
            self._remove(face)
        for face, region in zip(map(turned, new), regions, strict=True):
            self._add(face, region)
            self._log.append((self._remove, (face,)))
            self._faces_changed.append((face, True, region))

    def put_range(self, edge: Edge, place: Range) -> None:
        """Give an edge a place on a curve, in place of the one that it has."""
        if edge in self.ranges:
            self.drop_range(edge)
        self._put_range(edge, place)
        self._note(self._drop_range, edge)
        self._ranges_changed.append(edge)

    def drop_range(self, edge: Edge) -> Range:
        """Take its place on a curve from an edge; returns the place."""
        place = self.ranges[edge]
        self._note(self._put_range, edge, place)
        self._ranges_changed.append(edge)
        self._drop_range(edge)
        return place

    def add_vertex(self, v: int, desired: int) -> None:
        """A new vertex, not yet in any face."""
        self._note(self.desired.__delitem__, v)
        self.desired[v] = desired

    def drop_vertex(self, v: int) -> None:
        """Forget a vertex, which is in no face any more."""
        self._note(self.desired.__setitem__, v, self.desired.pop(v))

    def _note(self, inverse: Callable[..., None], *arguments: object) -> None:
        self._log.append((inverse, arguments))

    def begin(self) -> None:
        """From here on changes can be taken back."""
        self._log.clear()
        self._faces_changed.clear()
        self._ranges_changed.clear()
        self._before = (self.euler(), self._sizes.copy())

    def take_back(self) -> None:
        """Take back all changes since :meth:`begin`."""
        for inverse, arguments in reversed(self._log):
            inverse(*arguments)
        self._log.clear()

    def change(self) -> Change:
        """What has changed since :meth:`begin`."""
        removed: dict[Face, int] = {}
        added: dict[Face, int] = {}
        for face, there, region in self._faces_changed:
            one, other = (added, removed) if there else (removed, added)
            if other.get(face) == region:
                del other[face]
            else:
                one[face] = region
        edges = {(min(e), max(e)) for e in self._ranges_changed}
        vertices: set[int] = set()
        for face in (*removed, *added):
            vertices.update(face)
            v = face[-1]
            for ahead in face:
                edges.add((v, ahead) if v < ahead else (ahead, v))
                v = ahead
        return Change(removed, added, vertices, edges)

    def _add(self, face: Face, region: int) -> None:
        left = self.left
        if len(set(face)) < self.k:
            raise Refused("a face repeats a vertex")
        a = face[-1]
        for b in face:
            if (a, b) in left:
                raise Refused("two edges join the same vertices")
            a = b
        self.regions[face] = region
        self._sizes[region] += 1
        for b in face:
            left[a, b] = face
            if (b, a) in left:
                self._open[a] -= 1
                self._open[b] -= 1
            else:
                self._open[a] += 1
                self._open[b] += 1
                self.degree[a] += 1
                self.degree[b] += 1
                self.edges += 1
            around = self._around[b]
            self.vertices += not around
            around.add(face)
            a = b

    def _remove(self, face: Face) -> None:
        left = self.left
        self._sizes[self.regions.pop(face)] -= 1
        a = face[-1]
        for b in face:
            del left[a, b]
            if (b, a) in left:
                self._open[a] += 1
                self._open[b] += 1
            else:
                self._open[a] -= 1
                self._open[b] -= 1
                self.degree[a] -= 1
                self.degree[b] -= 1
                self.edges -= 1
            around = self._around[b]
            around.remove(face)
            self.vertices -= not around
            a = b

    def _put_range(self, edge: Edge, place: Range) -> None:
        self.ranges[edge] = place
        for v in edge:
            self._ranged[v].add(edge)

    def _drop_range(self, edge: Edge) -> None:
        del self.ranges[edge]
        for v in edge:
            self._ranged[v].discard(edge)

    # Whether the mesh is still one

    def judge(self) -> Change:
        """Refuse unless this is a simple oriented manifold mesh of the same topology as at
        :meth:`begin`; returns what has changed since. What has not is not looked at again.
        """
        change = self.change()
        for v in change.vertices:
            self._judge_vertex(v)
        euler, sizes = self._before
        if self.euler() != euler:
            raise Refused("edges were glued together")
        if self._several:
            if any((size > 0) != (sizes[r] > 0) for r, size in self._sizes.items()):
                raise Refused("a region was deleted")
            self._judge_regions(change)
        for a, b in change.edges:
            self._judge_edge(a, b)
        return change

    def _judge_vertex(self, v: int) -> None:
        around = self._around[v]
        if (v in self.desired) != bool(around):
            raise Refused("a vertex has no element")
        if not around:
            return
        link = {}
        for face in around:
            i = face.index(v)
            link[face[i + 1 - self.k]] = face[i - 1]
        starts = link.keys() - link.values()
        if len(starts) > 1:
            raise Refused("a pinched vertex")
        inside = not starts
        start = next(iter(link)) if inside else starts.pop()
        at, count = link[start], 1
        while at != start and at in link and count < len(link):
            at, count = link[at], count + 1
        if count < len(link):
            raise Refused("a pinched vertex")
        if inside and self.degree[v] < (3 if self.k == 3 else 2):
            raise Refused("an interior vertex of too low degree")

    def _judge_regions(self, change: Change) -> None:
        """Refuse unless V - E + F of each region is what it was."""
        regions, left = self.regions, self.left
        were: dict[int | Edge, set[int]] = defaultdict(set)  # at vertices and edges
        euler: dict[int, int] = defaultdict(int)
        for face, region in change.removed.items():
            euler[region] -= 1
            a = face[-1]
            for b in face:
                were[b].add(region)
                were[(a, b) if a < b else (b, a)].add(region)
                a = b
        for region in change.added.values():
            euler[region] += 1
        at: list[tuple[int | Edge, Iterable[Face], int]]
        at = [(v, self._around[v], 1) for v in change.vertices]
        for a, b in change.edges:
            sides = [left[side] for side in ((a, b), (b, a)) if side in left]
            at.append(((a, b), sides, -1))
        for place, faces, sign in at:
            was, now = were[place], set()
            for face in faces:
                region = regions[face]
                now.add(region)
                if face not in change.added:
                    was.add(region)
            if now != was:
                for region in now - was:
                    euler[region] += sign
                for region in was - now:
                    euler[region] -= sign
        if any(euler.values()):
            raise Refused("a region was torn")

    def _judge_edge(self, a: int, b: int) -> None:
        """Refuse unless the edge has one range if it lies along a curve, and else none."""
        left, right = self.left.get((a, b)), self.left.get((b, a))
        one, other = (a, b) in self.ranges, (b, a) in self.ranges
        if left is None or right is None:
            # the boundary's curve has the domain on its left
            fits = one == (left is not None) and other == (right is not None)
        else:
            fits = one + other == (self.regions[left] != self.regions[right])
        if not fits:
            raise Refused("an edge between two regions came or went")


def turned(face: Face) -> Face:
    """The face rotated to begin with its smallest vertex id."""
    i = face.index(min(face))
    return face[i:] + face[:i]
