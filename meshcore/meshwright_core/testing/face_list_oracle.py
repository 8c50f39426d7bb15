"""A naive reference implementation: a mesh as a list of faces, for tests and the fuzz benchmark.

Every operation rewrites tuples of vertex ids directly, and the whole result is checked afterwards.
It shares no code with the half-edge mesh; a half-edge is a pair of vertices (a, b).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from itertools import pairwise

Face = tuple[int, ...]
Edge = tuple[int, int]
Range = tuple[int, float, float]
"""A curve, and the parameters on it where an edge begins and ends, the first one smaller."""


class Refused(Exception):
    """The operation would not leave a simple oriented manifold mesh, or deletes what must stay."""


class FaceList:
    """A mesh of faces with the data of its vertices."""

    def __init__(
        self,
        faces: list[Face],
        desired: dict[int, int],
        geometric: set[int],
        locked: set[int] | None = None,
        regions: Sequence[int] | None = None,
        ranges: dict[Edge, Range] | None = None,
    ) -> None:
        """A mesh of one region without curves, unless they are given.

        faces: counter-clockwise vertex ids, all of 3 or all of 4. regions: of each face. ranges:
        for each edge along a curve, from the vertex with the smaller parameter to the other.
        """
        self.regions = dict(zip(map(_turned, faces), regions or [0] * len(faces), strict=True))
        self.k = len(faces[0])
        self.desired = dict(desired)
        self.geometric = set(geometric)
        self.locked = set(locked or ())
        if ranges is None:
            ranges = {edge: (0, 0.0, 1.0) for edge in self.curve_edges()}
        self.ranges = dict(ranges)

    @property
    def faces(self) -> set[Face]:
        """All faces, each begun with its smallest vertex id."""
        return set(self.regions)

    def directed(self) -> dict[tuple[int, int], Face]:
        """The face on the left of each pair of vertices."""
        return {(f[i - 1], f[i]): f for f in self.regions for i in range(self.k)}

    def degrees(self) -> dict[int, int]:
        """Number of neighbours of each vertex."""
        around: dict[int, set[int]] = defaultdict(set)
        for a, b in self.directed():
            around[a].add(b)
            around[b].add(a)
        return {v: len(others) for v, others in around.items()}

    def boundary(self) -> set[int]:
        """Vertices on the boundary."""
        directed = self.directed()
        return {v for a, b in directed if (b, a) not in directed for v in (a, b)}

    def curve_edges(self) -> set[Edge]:
        """The edges on the boundary, one way, and those between two regions, both ways."""
        directed = self.directed()
        return {
            (a, b)
            for (a, b), f in directed.items()
            if (b, a) not in directed or self.regions[directed[b, a]] != self.regions[f]
        }

    def on_curve(self) -> set[int]:
        """Vertices on the boundary or on the interface of two regions."""
        return {v for edge in self.ranges for v in edge}

    def euler_of_regions(self) -> dict[int, int]:
        """V - E + F of each region."""
        vertices: dict[int, set[int]] = defaultdict(set)
        edges: dict[int, set[frozenset[int]]] = defaultdict(set)
        for f, region in self.regions.items():
            vertices[region] |= set(f)
            edges[region] |= {frozenset((f[i - 1], f[i])) for i in range(self.k)}
        count = Counter(self.regions.values())
        return {r: len(vertices[r]) - len(edges[r]) + count[r] for r in count}

    def euler(self) -> int:
        """V - E + F."""
        directed = self.directed()
        edges = {frozenset(pair) for pair in directed}
        return len({v for f in self.faces for v in f}) - len(edges) + len(self.faces)

    def delta_sum(self) -> int:
        """Sum of degree - desired degree."""
        return sum(d - self.desired[v] for v, d in self.degrees().items())

    def after(self, operation: str, a: int, b: int, fresh: list[int]) -> FaceList:
        """The mesh after `operation` on the half-edge a-b; Refused where it is not allowed.

        fresh: ids for new vertices in the order of their creation; further ones are generated.
        """
        result = FaceList(
            list(self.regions),
            self.desired,
            self.geometric,
            self.locked,
            list(self.regions.values()),
            self.ranges,
        )
        getattr(_Rewrite(result, fresh), operation)(a, b)
        result._judge(self)
        return result

    def _judge(self, before: FaceList) -> None:
        """Refuse unless this is a simple oriented manifold mesh of the same topology as
        `before`.
        """
        seen: set[tuple[int, int]] = set()
        links: dict[int, dict[int, int]] = defaultdict(dict)
        for f in self.faces:
            if len(set(f)) < self.k:
                raise Refused("a face repeats a vertex")
            for i in range(self.k):
                pair = (f[i - 1], f[i])
                if pair in seen:
                    raise Refused("two edges join the same vertices")
                seen.add(pair)
                links[f[i]][f[(i + 1) % self.k]] = f[i - 1]
        neighbours: dict[int, set[int]] = defaultdict(set)
        for a, b in seen:
            neighbours[a].add(b)
            neighbours[b].add(a)
        if set(self.desired) != set(links):
            raise Refused("a vertex has no element")
        for v, link in links.items():
            ends = set(link) - set(link.values())
            inside = not ends
            if len(ends) > 1:
                raise Refused("a pinched vertex")
            at = next(iter(ends)) if ends else next(iter(link))
            for _ in link:
                at = link.get(at, -1)
            if at == -1 or (inside and len(_orbit(link)) < len(link)):
                raise Refused("a pinched vertex")
            if inside and len(neighbours[v]) < (3 if self.k == 3 else 2):
                raise Refused("an interior vertex of too low degree")
        if self.euler() != before.euler():
            raise Refused("edges were glued together")
        several = len(set(before.regions.values())) > 1
        if several and self.euler_of_regions() != before.euler_of_regions():
            raise Refused("a region was deleted or torn")
        if {frozenset(edge) for edge in self.ranges} != set(map(frozenset, self.curve_edges())):
            raise Refused("an edge between two regions came or went")


def _orbit(link: dict[int, int]) -> set[int]:
    at = next(iter(link))
    met = set()
    while at not in met:
        met.add(at)
        at = link[at]
    return met


def _turned(face: Face) -> Face:
    """The face rotated to begin with its smallest vertex id."""
    i = face.index(min(face))
    return face[i:] + face[:i]


class _Rewrite:
    """The operations as the paper defines them, on a FaceList that may become invalid."""

    def __init__(self, mesh: FaceList, fresh: list[int]) -> None:
        self.mesh = mesh
        self.fresh = list(fresh)
        self.used = max(mesh.desired) + 1 + len(fresh)

    def _new(self, boundary: bool) -> int:
        v = self.fresh.pop(0) if self.fresh else self.used
        self.used += 1
        inside, straight = (6, 4) if self.mesh.k == 3 else (4, 3)
        self.mesh.desired[v] = straight if boundary else inside
        return v

    def _left(self, a: int, b: int) -> Face:
        """The face left of a-b, rotated to begin with a, b."""
        face = self.mesh.directed()[a, b]
        i = face.index(a)
        return face[i:] + face[:i]

    def _right(self, a: int, b: int) -> Face:
        if (b, a) not in self.mesh.directed():
            raise Refused("the edge lies on the boundary")
        return self._left(b, a)

    def _keep_interface(self, a: int, b: int) -> None:
        if (a, b) in self.mesh.ranges or (b, a) in self.mesh.ranges:
            raise Refused("the edge lies between two regions")

    def _swap(
        self, old: Sequence[Face], new: Sequence[Face], regions: Sequence[int] | None = None
    ) -> None:
        """Replace faces; the new ones get the region of the first old one unless it is given."""
        known = self.mesh.regions
        if regions is None:
            regions = [known[_turned(old[0])]] * len(new)
        for face in map(_turned, old):
            known.pop(face, None)
        for face, region in zip(map(_turned, new), regions, strict=True):
            if face in known:
                raise Refused("two equal faces")
            known[face] = region

    def _halve(self, a: int, b: int, v: int) -> None:
        """Put v in the middle of the range of the edge a-b, if it has one."""
        for x, y in ((a, b), (b, a)):
            if (x, y) in self.mesh.ranges:
                curve, start, stop = self.mesh.ranges.pop((x, y))
                middle = 0.5 * (start + stop)
                self.mesh.ranges[x, v] = (curve, start, middle)
                self.mesh.ranges[v, y] = (curve, middle, stop)

    def _close(self, loser: int, winner: int) -> None:
        """Shrink the edge between them, if it has a range; the next one along the curve grows."""
        ranges = self.mesh.ranges
        for x, y in ((loser, winner), (winner, loser)):
            if (x, y) not in ranges:
                continue
            curve, start, stop = ranges.pop((x, y))
            for (u, v), (other, low, high) in list(ranges.items()):
                if loser not in (u, v):
                    continue
                if other != curve:
                    raise Refused("a junction would be deleted")
                del ranges[u, v]
                if loser == v:
                    ranges[u, winner] = (curve, low, high + stop - start)
                else:
                    ranges[winner, v] = (curve, low - stop + start, high)

    def _join(self, p: int, v: int, q: int) -> None:
        """Join the ranges of p-v and v-q, or q-v and v-p, if they have some."""
        for x, y in ((p, q), (q, p)):
            if (x, v) in self.mesh.ranges:
                curve, start, stop = self.mesh.ranges.pop((x, v))
                if (v, y) not in self.mesh.ranges:
                    raise Refused("the line leaves an interface")
                _, low, high = self.mesh.ranges.pop((v, y))
                self.mesh.ranges[x, y] = (curve, start, stop + high - low)

    def _merge(self, a: int, b: int, gone: list[Face], *, along_boundary: bool = False) -> None:
        """Merge vertices a and b, after removing the faces `gone`."""
        mesh, boundary, curved = self.mesh, self.mesh.boundary(), self.mesh.on_curve()
        along_curve = (a, b) in mesh.ranges or (b, a) in mesh.ranges
        inside, straight = (6, 4) if mesh.k == 3 else (4, 3)

        def rank(v: int) -> tuple[bool, bool, bool, bool]:
            own = mesh.desired[v] != (straight if v in boundary else inside)
            return v in mesh.geometric, v in curved, v in mesh.locked, own

        winner, loser = (b, a) if rank(b) > rank(a) else (a, b)
        if loser in mesh.geometric or loser in mesh.locked:
            raise Refused("the loser must stay")
        if mesh.desired[loser] != (straight if along_boundary else inside):
            raise Refused("the loser has a desired degree of its own")
        if not along_curve and loser in curved:
            raise Refused("a vertex cannot leave its curve")
        if not along_curve and winner in curved and loser in curved:
            raise Refused("two curves cannot merge")
        self._swap(gone, [], [])
        touched = [f for f in mesh.faces if loser in f]
        renamed = [tuple(winner if v == loser else v for v in f) for f in touched]
        self._swap(touched, renamed, [mesh.regions[f] for f in touched])
        self._close(loser, winner)
        del mesh.desired[loser]

    def flip(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
        self._keep_interface(a, b)
        c, d = left[2], right[2]
        self._swap([left, right], [(d, c, a), (c, d, b)])

    def split(self, a: int, b: int) -> None:
        (self._split_edge if self.mesh.k == 3 else self._split_vertex)(a, b)

    def _split_edge(self, a: int, b: int) -> None:
        left = self._left(a, b)
        c = left[2]
        inside = (b, a) in self.mesh.directed()
        v = self._new(boundary=not inside)
        if inside:
            right = self._right(a, b)
            d = right[2]
            self._swap([right], [(v, a, d), (b, v, d)])
        self._swap([left], [(a, v, c), (v, b, c)])
        self._halve(a, b, v)

    def _split_vertex(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
        self._keep_interface(a, b)
        _, _, c, d = left
        _, _, f, g = right
        v = self._new(boundary=False)
        self._swap([left, right], [(v, b, c, d), (b, v, f, g), (v, d, a, f)])

    def collapse(self, a: int, b: int) -> None:
        left = self._left(a, b)
        if self.mesh.k == 4:
            self._merge(a, left[2], [left])
            return
        inside = (b, a) in self.mesh.directed()
        gone = [left, self._right(a, b)] if inside else [left]
        self._merge(a, b, gone, along_boundary=not inside)

    def flip_left(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
        self._keep_interface(a, b)
        _, _, c, d = left
        _, _, f, g = right
        self._swap([left, right], [(f, c, d, a), (c, f, g, b)])

    def flip_right(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
        self._keep_interface(a, b)
        _, _, c, d = left
        _, _, f, g = right
        self._swap([left, right], [(d, g, b, c), (g, d, a, f)])

    def global_split(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
        self._keep_interface(a, b)
        _, _, c, d = left
        _, _, f, g = right
        directed = self.mesh.directed()
        n1 = self._new(boundary=(c, b) not in directed)
        n2 = self._new(boundary=(b, g) not in directed)
        self._swap([left, right], [(a, n1, c, d), (a, f, g, n2), (a, n2, b, n1)])
        self._halve(b, c, n1)
        self._halve(g, b, n2)
        made = [{b, n1}, {n1, c}, {g, n2}, {n2, b}]
        for x, v, y in ((c, n1, b), (b, n2, g)):
            while (x, y) in self.mesh.directed():
                face = self._left(x, y)
                _, _, z, w = face
                if {z, w} in made or {x, y} in made:
                    raise Refused("it meets an edge that it has split")
                far = self._new(boundary=(w, z) not in self.mesh.directed())
                self._swap([face], [(x, v, far, w), (v, y, z, far)])
                self._halve(w, z, far)
                made += [{w, far}, {far, z}]
                x, v, y = w, far, z
                if len(made) > 8 * len(directed):
                    raise Refused("it does not end")

    def cleanup(self, a: int, b: int) -> None:
        self._right(a, b)
        mesh, degrees, boundary = self.mesh, self.mesh.degrees(), self.mesh.boundary()

        def onward(u: int, v: int) -> int | None:
            """The vertex straight on from u over v, None where the line ends at the boundary."""
            if v in mesh.geometric or v in mesh.locked:
                raise Refused("the line meets a vertex that must stay")
            if mesh.desired[v] != (3 if v in boundary else 4):
                raise Refused("the line meets a vertex with a desired degree of its own")
            if v in boundary:
                if degrees[v] != 3:
                    raise Refused("the line ends in the wrong place")
                return None
            if degrees[v] != 4:
                raise Refused("the line meets an irregular vertex")
            turn = self._left(v, u)[3]
            return self._left(v, turn)[3]

        line = [a, b]
        while (w := onward(line[-2], line[-1])) is not None:
            if w == line[1] and line[-1] == line[0]:
                break
            line.append(w)
            if len(line) > 2 * len(degrees):
                raise Refused("the line crosses itself")
        ring = line[0] == line[-1]
        while not ring and (w := onward(line[1], line[0])) is not None:
            line.insert(0, w)
            if len(line) > 2 * len(degrees):
                raise Refused("the line crosses itself")
        old, new, regions, across = [], [], [], {}
        for u, v in pairwise(line):
            self._keep_interface(u, v)
            left, right = self._left(u, v), self._right(u, v)
            old += [left, right]
            new.append((right[2], right[3], left[2], left[3]))
            regions.append(mesh.regions[_turned(left)])
            across[u], across[v] = (left[3], right[2]), (left[2], right[3])
        if len(set(map(_turned, old))) < len(old):
            raise Refused("the line touches an element twice")
        self._swap(old, new, regions)
        for v in set(line):
            del mesh.desired[v]
            self._join(across[v][0], v, across[v][1])

    def chord_collapse(self, a: int, b: int) -> None:
        directed = self.mesh.directed()
        rungs, faces = [(a, b)], []
        while rungs[-1] in directed:
            face = self._left(*rungs[-1])
            faces.append(face)
            rungs.append((face[3], face[2]))
            if rungs[-1] == (a, b):
                break
            if len(faces) > 2 * len(directed):
                raise Refused("the strip does not end")
        ring = len(rungs) > 1 and rungs[-1] == rungs[0]
        if ring:
            rungs.pop()
        while not ring and rungs[0][::-1] in directed:
            face = self._left(*rungs[0][::-1])
            faces.append(face)
            rungs.insert(0, (face[2], face[3]))
        rails = [v for rung in rungs for v in rung]
        if len(set(rails)) < len(rails) or len(set(map(_turned, faces))) < len(faces):
            raise Refused("the strip crosses itself")
        curved = self.mesh.on_curve()
        boundary, ends = self.mesh.boundary(), {rungs[0], rungs[-1]} if not ring else set()
        for rung in rungs:
            if rung not in ends and set(rung) <= boundary:
                raise Refused("the strip pinches the mesh")
        # what the vertices were before any of them merged
        self.mesh.boundary = lambda: boundary  # type: ignore[method-assign]
        self.mesh.on_curve = lambda: curved  # type: ignore[method-assign]
        for rung in rungs:
            self._merge(*rung, faces, along_boundary=rung in ends)
            faces = []
        del self.mesh.boundary, self.mesh.on_curve
