"""A naive reference implementation: a mesh as a list of faces, for tests and the fuzz benchmark.

Every operation rewrites tuples of vertex ids directly, and the whole result is checked afterwards.
It shares no code with the half-edge mesh; a half-edge is a pair of vertices (a, b).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from itertools import pairwise

Face = tuple[int, ...]


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
    ) -> None:
        """faces: counter-clockwise vertex ids, all of 3 or all of 4."""
        self.faces = set(map(_turned, faces))
        self.k = len(faces[0])
        self.desired = dict(desired)
        self.geometric = set(geometric)
        self.locked = set(locked or ())

    def directed(self) -> dict[tuple[int, int], Face]:
        """The face on the left of each pair of vertices."""
        return {(f[i - 1], f[i]): f for f in self.faces for i in range(self.k)}

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
        result = FaceList([*self.faces], self.desired, self.geometric, self.locked)
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

    def _swap(self, old: Sequence[Face], new: Sequence[Face]) -> None:
        self.mesh.faces -= set(map(_turned, old))
        for face in map(_turned, new):
            if face in self.mesh.faces:
                raise Refused("two equal faces")
            self.mesh.faces.add(face)

    def _merge(self, a: int, b: int, gone: list[Face], *, along_boundary: bool = False) -> None:
        """Merge vertices a and b, after removing the faces `gone`."""
        mesh, boundary = self.mesh, self.mesh.boundary()
        inside, straight = (6, 4) if mesh.k == 3 else (4, 3)

        def rank(v: int) -> tuple[bool, bool, bool, bool]:
            own = mesh.desired[v] != (straight if v in boundary else inside)
            return v in mesh.geometric, v in boundary, v in mesh.locked, own

        winner, loser = (b, a) if rank(b) > rank(a) else (a, b)
        if loser in mesh.geometric or loser in mesh.locked:
            raise Refused("the loser must stay")
        if mesh.desired[loser] != (straight if along_boundary else inside):
            raise Refused("the loser has a desired degree of its own")
        if not along_boundary and loser in boundary:
            raise Refused("the boundary cannot move inside")
        self._swap(gone, [])
        touched = [f for f in mesh.faces if loser in f]
        self._swap(touched, [tuple(winner if v == loser else v for v in f) for f in touched])
        del mesh.desired[loser]

    def flip(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
        c, d = left[2], right[2]
        self._swap([left, right], [(d, c, a), (c, d, b)])

    def split(self, a: int, b: int) -> None:
        (self._split_edge if self.mesh.k == 3 else self._split_vertex)(a, b)

    def _split_edge(self, a: int, b: int) -> None:
        left = self._left(a, b)
        c = left[2]
        inside = (b, a) in self.mesh.directed()
        v = self._new(boundary=not inside)
        new, old = [(a, v, c), (v, b, c)], [left]
        if inside:
            right = self._right(a, b)
            d = right[2]
            old.append(right)
            new += [(v, a, d), (b, v, d)]
        self._swap(old, new)

    def _split_vertex(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
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
        _, _, c, d = left
        _, _, f, g = right
        self._swap([left, right], [(f, c, d, a), (c, f, g, b)])

    def flip_right(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
        _, _, c, d = left
        _, _, f, g = right
        self._swap([left, right], [(d, g, b, c), (g, d, a, f)])

    def global_split(self, a: int, b: int) -> None:
        left, right = self._left(a, b), self._right(a, b)
        _, _, c, d = left
        _, _, f, g = right
        directed = self.mesh.directed()
        n1 = self._new(boundary=(c, b) not in directed)
        n2 = self._new(boundary=(b, g) not in directed)
        self._swap([left, right], [(a, n1, c, d), (a, f, g, n2), (a, n2, b, n1)])
        made = [{b, n1}, {n1, c}, {g, n2}, {n2, b}]
        for x, v, y in ((c, n1, b), (b, n2, g)):
            while (x, y) in self.mesh.directed():
                face = self._left(x, y)
                _, _, z, w = face
                if {z, w} in made or {x, y} in made:
                    raise Refused("it meets an edge that it has split")
                far = self._new(boundary=(w, z) not in self.mesh.directed())
                self._swap([face], [(x, v, far, w), (v, y, z, far)])
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
        old, new = [], []
        for u, v in pairwise(line):
            left, right = self._left(u, v), self._right(u, v)
            old += [left, right]
            new.append((right[2], right[3], left[2], left[3]))
        if len(set(map(_turned, old))) < len(old):
            raise Refused("the line touches an element twice")
        self._swap(old, new)
        for v in set(line):
            del mesh.desired[v]

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
        boundary, ends = self.mesh.boundary(), {rungs[0], rungs[-1]} if not ring else set()
        for rung in rungs:
            if rung not in ends and set(rung) <= boundary:
                raise Refused("the strip pinches the mesh")
        self.mesh.boundary = lambda: boundary  # type: ignore[method-assign]
        for rung in rungs:
            self._merge(*rung, faces, along_boundary=rung in ends)
            faces = []
        del self.mesh.boundary
