"""The operations on the naive face list, as the paper defines them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from meshwright_core.testing.face_list_oracle import Change, Face, FaceList, Refused, turned


def apply(mesh: FaceList, operation: str, a: int, b: int, fresh: Sequence[int] = ()) -> Change:
    """Change the mesh by `operation` on the half-edge a-b; returns what has changed.

    fresh: ids for new vertices in the order of their creation; further ones are generated. Raises
    Refused, and leaves the mesh as it was, where the operation is not allowed.
    """
    mesh.begin()
    try:
        getattr(_Rewrite(mesh, fresh), operation)(a, b)
        return mesh.judge()
    except Refused:
        mesh.take_back()
        raise


def allowed(mesh: FaceList, operation: str, a: int, b: int) -> bool:
    """Whether `operation` is allowed on the half-edge a-b; the mesh stays as it is."""
    try:
        apply(mesh, operation, a, b)
    except Refused:
        return False
    mesh.take_back()
    return True


class _Rewrite:
    """The operations as the paper defines them, on a FaceList that may become invalid."""

    def __init__(self, mesh: FaceList, fresh: Sequence[int]) -> None:
        self.mesh = mesh
        self.fresh = list(fresh)

    def _new(self, boundary: bool) -> int:
        v = self.fresh.pop(0) if self.fresh else max(self.mesh.desired) + 1
        inside, straight = (6, 4) if self.mesh.k == 3 else (4, 3)
        self.mesh.add_vertex(v, straight if boundary else inside)
        return v

    def _left(self, a: int, b: int) -> Face:
        """The face left of a-b, rotated to begin with a, b."""
        face = self.mesh.left[a, b]
        i = face.index(a)
        return face[i:] + face[:i]

    def _right(self, a: int, b: int) -> Face:
        if (b, a) not in self.mesh.left:
            raise Refused("the edge lies on the boundary")
        return self._left(b, a)

    def _keep_interface(self, a: int, b: int) -> None:
        if (a, b) in self.mesh.ranges or (b, a) in self.mesh.ranges:
            raise Refused("the edge lies between two regions")

    def _swap(
        self, old: Sequence[Face], new: Sequence[Face], regions: Sequence[int] | None = None
    ) -> None:
        """Replace faces; the new ones get the region of the first old one unless it is given."""
        if regions is None:
            regions = [self.mesh.regions[turned(old[0])]] * len(new)
        self.mesh.replace(old, new, regions)

    def _halve(self, a: int, b: int, v: int) -> None:
        """Put v in the middle of the range of the edge a-b, if it has one."""
        self._cut(a, b, v, 0.5)

    def _cut(self, a: int, b: int, v: int, share: float) -> None:
        """Put v that share of the way from a to b in the range of the edge, if it has one."""
        for x, y, part in ((a, b, share), (b, a, 1.0 - share)):
            if (x, y) in self.mesh.ranges:
                curve, start, stop = self.mesh.drop_range((x, y))
                middle = (1.0 - part) * start + part * stop
                self.mesh.put_range((x, v), (curve, start, middle))
                self.mesh.put_range((v, y), (curve, middle, stop))

    def _close(self, loser: int, winner: int) -> None:
        """Shrink the edge between them, if it has a range; the next one along the curve grows."""
        mesh = self.mesh
        for x, y in ((loser, winner), (winner, loser)):
            if (x, y) not in mesh.ranges:
                continue
            curve, start, stop = mesh.drop_range((x, y))
            for u, v in mesh.ranges_at(loser):
                other, low, high = mesh.drop_range((u, v))
                if other != curve:
                    raise Refused("a junction would be deleted")
                if loser == v:
                    mesh.put_range((u, winner), (curve, low, high + stop - start))
                else:
                    mesh.put_range((winner, v), (curve, low - stop + start, high))

    def _join(self, p: int, v: int, q: int) -> None:
        """Join the ranges of p-v and v-q, or q-v and v-p, if they have some."""
        for x, y in ((p, q), (q, p)):
            if (x, v) in self.mesh.ranges:
                curve, start, stop = self.mesh.drop_range((x, v))
                if (v, y) not in self.mesh.ranges:
                    raise Refused("the line leaves an interface")
                _, low, high = self.mesh.drop_range((v, y))
                self.mesh.put_range((x, y), (curve, start, stop + high - low))

    def _merge(self, a: int, b: int, gone: list[Face], *, along_boundary: bool = False) -> None:
        """Merge vertices a and b, after removing the faces `gone`."""
        boundary = self._those((a, b), self.mesh.on_boundary)
        curved = self._those((a, b), self.mesh.on_curve)
        self._unite(*self._loser_first(a, b, boundary, curved, along_boundary), gone)

    def _loser_first(
        self, a: int, b: int, boundary: set[int], curved: set[int], along_boundary: bool
    ) -> tuple[int, int]:
        """Which of two vertices vanishes when they merge, and which stays; Refused if neither may.

        boundary, curved: which vertices lie there.
        """
        mesh = self.mesh
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
        return loser, winner

    def _unite(self, loser: int, winner: int, gone: list[Face]) -> None:
        """Put `winner` in place of `loser`, after removing the faces `gone`."""
        mesh = self.mesh
        self._swap(gone, [], [])
        touched = mesh.faces_at(loser)
        renamed = [tuple(winner if v == loser else v for v in f) for f in touched]
        self._swap(touched, renamed, [mesh.regions[f] for f in touched])
        self._close(loser, winner)
        mesh.drop_vertex(loser)

    @staticmethod
    def _those(vertices: Sequence[int], lies: Callable[[int], bool]) -> set[int]:
        """The vertices for which `lies` holds now."""
        return {v for v in vertices if lies(v)}

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
        inside = (b, a) in self.mesh.left
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
        inside = (b, a) in self.mesh.left
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
        most = 8 * len(self.mesh.left)
        n1 = self._new(boundary=(c, b) not in self.mesh.left)
        n2 = self._new(boundary=(b, g) not in self.mesh.left)
        self._swap([left, right], [(a, n1, c, d), (a, f, g, n2), (a, n2, b, n1)])
        self._halve(b, c, n1)
        self._halve(g, b, n2)
        made = [{b, n1}, {n1, c}, {g, n2}, {n2, b}]
        for x, v, y in ((c, n1, b), (b, n2, g)):
            while (x, y) in self.mesh.left:
                face = self._left(x, y)
                _, _, z, w = face
                if {z, w} in made or {x, y} in made:
                    raise Refused("it meets an edge that it has split")
                far = self._new(boundary=(w, z) not in self.mesh.left)
                self._swap([face], [(x, v, far, w), (v, y, z, far)])
                self._halve(w, z, far)
                made += [{w, far}, {far, z}]
                x, v, y = w, far, z
                if len(made) > most:
                    raise Refused("it does not end")

    def divide_chord(self, a: int, b: int) -> None:
        first = (a, b)
        self._left(a, b)
        while (b, a) in self.mesh.left:
            _, _, a, b = self._left(b, a)
            if (a, b) == first:
                raise Refused("the strip closes in a ring")
        v = self._new(boundary=True)
        self._halve(a, b, v)
        self._carry(a, v, b)

    def _carry(self, x: int, v: int, y: int) -> None:
        """Cut quad after quad in two, from the vertex v on the edge x-y to the boundary."""
        while (x, y) in self.mesh.left:
            face = self._left(x, y)
            _, _, z, w = face
            far = self._new(boundary=(w, z) not in self.mesh.left)
            self._swap([face], [(x, v, far, w), (v, y, z, far)])
            self._halve(w, z, far)
            x, v, y = w, far, z

    def insert_ring(self, a: int, b: int) -> None:
        mesh = self.mesh
        self._left(a, b)
        outer = (b, a) not in mesh.left
        if not outer and (a, b) not in mesh.ranges and (b, a) not in mesh.ranges:
            raise Refused("the edge lies within a region")

        def ends(u: int, v: int) -> bool:
            """Whether the edge belongs to such a loop."""
            if outer:
                return (v, u) not in mesh.left
            return (u, v) in mesh.ranges or (v, u) in mesh.ranges

        # at each vertex: the corners of its elements on this side, from one loop edge to the next
        loop, fans = [(a, b)], []
        while True:
            u, v = loop[-1]
            fan = [u]
            while True:
                fan.append(self._left(fan[-1], v)[2])
                if ends(v, fan[-1]):
                    break
            fans.append(fan)
            if (v, fan[-1]) == (a, b):
                break
            loop.append((v, fan[-1]))
        fans = fans[-1:] + fans[:-1]
        if not outer:
            directed = [edge if edge in mesh.ranges else edge[::-1] for edge in loop]
            curves = {mesh.ranges[edge][0] for edge in directed}
            if len(curves) > 1 or any(len(mesh.ranges_at(v)) > 2 for v, _ in loop):
                raise Refused("the interface does not close")
        old: dict[Face, None] = {}
        crossing: list[tuple[int, int]] = []
        copy: dict[int, int] = {}
        for (v, _), fan in zip(loop, fans, strict=True):
            inner = [u for u in fan[1:-1] if (u, v) in mesh.ranges or (v, u) in mesh.ranges]
            if len(inner) > 1:
                raise Refused("two interfaces meet the loop in a vertex")
            copy[v] = self._new(boundary=False)
            old.update({turned(self._left(u, v)): None for u in fan[:-1]})
            crossing += [(v, u) for u in inner]
        for v, u in crossing:
            if (u, v) in crossing and copy[u] < copy[v]:
                continue
            self._cut(v, u, copy[v], 1.0 / 3.0)
            if (u, v) in crossing:
                self._cut(u, copy[v], copy[u], 0.5)
        inside = {
            (v, turned(self._left(u, v)))
            for (v, _), fan in zip(loop, fans, strict=True)
            for u in fan[:-1]
        }
        faces = list(old)
        new = [tuple(copy[v] if (v, f) in inside else v for v in f) for f in faces]
        new += [(u, v, copy[v], copy[u]) for u, v in loop]
        regions = [mesh.regions[f] for f in faces]
        regions += [mesh.regions[turned(self._left(u, v))] for u, v in loop]
        self._swap(faces, new, regions)

    def cleanup(self, a: int, b: int) -> None:
        self._right(a, b)
        mesh = self.mesh

        def onward(u: int, v: int) -> int | None:
            """The vertex straight on from u over v, None where the line ends at the boundary."""
            if v in mesh.geometric or v in mesh.locked:
                raise Refused("the line meets a vertex that must stay")
            if mesh.desired[v] != (3 if mesh.on_boundary(v) else 4):
                raise Refused("the line meets a vertex with a desired degree of its own")
            if mesh.on_boundary(v):
                if mesh.degree[v] != 3:
                    raise Refused("the line ends in the wrong place")
                return None
            if mesh.degree[v] != 4:
                raise Refused("the line meets an irregular vertex")
            turn = self._left(v, u)[3]
            return self._left(v, turn)[3]

        line = [a, b]
        while (w := onward(line[-2], line[-1])) is not None:
            if w == line[1] and line[-1] == line[0]:
                break
            line.append(w)
            if len(line) > 2 * mesh.vertices:
                raise Refused("the line crosses itself")
        ring = line[0] == line[-1]
        while not ring and (w := onward(line[1], line[0])) is not None:
            line.insert(0, w)
            if len(line) > 2 * mesh.vertices:
                raise Refused("the line crosses itself")
        old, new, regions, across = [], [], [], {}
        for u, v in pairwise(line):
            self._keep_interface(u, v)
            left, right = self._left(u, v), self._right(u, v)
            old += [left, right]
            new.append((right[2], right[3], left[2], left[3]))
            regions.append(mesh.regions[turned(left)])
            across[u], across[v] = (left[3], right[2]), (left[2], right[3])
        if len(set(map(turned, old))) < len(old):
            raise Refused("the line touches an element twice")
        self._swap(old, new, regions)
        for v in set(line):
            mesh.drop_vertex(v)
            self._join(across[v][0], v, across[v][1])

    def chord_collapse(self, a: int, b: int) -> None:
        directed = self.mesh.left
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
        if len(set(rails)) < len(rails) or len(set(map(turned, faces))) < len(faces):
            raise Refused("the strip crosses itself")
        # what the vertices are before any of them merge
        curved = self._those(rails, self.mesh.on_curve)
        boundary = self._those(rails, self.mesh.on_boundary)
        ends = {rungs[0], rungs[-1]} if not ring else set()
        for rung in rungs:
            if rung not in ends and set(rung) <= boundary:
                raise Refused("the strip pinches the mesh")
        merging = [self._loser_first(*rung, boundary, curved, rung in ends) for rung in rungs]
        for loser, winner in merging:
            self._unite(loser, winner, faces)
            faces = []
