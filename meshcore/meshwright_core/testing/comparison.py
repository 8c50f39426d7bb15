"""Compares a half-edge mesh with the naive face list: all of it, or what has changed."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from meshwright_core.core.arrays import CURVE, DEGREE, DESIRED, HALF, ORIGIN, TWIN
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.testing.face_list_oracle import Change, Edge, Face, FaceList, Range, turned


def face_list(mesh: HalfEdgeMesh) -> FaceList:
    """The mesh as a :class:`FaceList`."""
    live = mesh.vertices().tolist()
    desired, geometric, locked = mesh.desired(), mesh.geometric(), mesh.locked()
    return FaceList(
        [tuple(row) for row in mesh.elements().tolist()],
        {v: int(desired[v]) for v in live},
        {v for v in live if geometric[v]},
        {v for v in live if locked[v]},
        mesh.regions().tolist(),
        edge_ranges(mesh, mesh.halfedges_of(mesh.element_ids()).ravel()),
    )


def edge_ranges(mesh: HalfEdgeMesh, halfedges: np.ndarray) -> dict[Edge, Range]:
    """The curve and the range of those of the half-edges (n,) that lead along a curve in its
    direction.
    """
    curve, span = edge_places(mesh.arrays, halfedges, mesh.k)
    ahead = halfedges - halfedges % mesh.k + (halfedges + 1) % mesh.k
    ends = mesh.arrays.edge[:, ORIGIN]
    edges = zip(ends[halfedges].tolist(), ends[ahead].tolist(), strict=True)
    ranges = zip(curve.tolist(), *span.T.tolist(), strict=True)
    return {
        edge: (c, start, stop)
        for edge, (c, start, stop) in zip(edges, ranges, strict=True)
        if c >= 0 and start < stop
    }


def same_ranges(mesh: HalfEdgeMesh, expected: dict[Edge, Range], found: dict[Edge, Range]) -> bool:
    """Whether edges lie on the same curves at the same places, those on closed ones modulo the
    length.
    """
    if expected.keys() != found.keys():
        return False
    lengths = mesh.boundary_info.lengths().tolist()
    closed = mesh.boundary_info.curves.closed.tolist()
    for edge, (curve, start, stop) in expected.items():
        other, first, last = found[edge]
        turn = (start - first) / lengths[curve]
        near = 1e-9 * lengths[curve]
        if other != curve or abs(stop - start - (last - first)) > near:
            return False
        whole = round(turn) if closed[curve] else 0
        if abs(turn - whole) * lengths[curve] > near:
            return False
    return True


class Comparison:
    """A mesh and the face list that it should agree with, operation by operation.

    The state of the mesh that was compared last is kept, so that :meth:`step` finds all that an
    operation has written, expected or not, and compares that alone.
    """

    def __init__(self, mesh: HalfEdgeMesh, oracle: FaceList) -> None:
        """Both must agree: `oracle` is :func:`face_list` of the mesh."""
        self.mesh = mesh
        self.oracle = oracle
        self._face: dict[int, Face] = {}  # of each element
        self._halfedge: dict[Edge, int] = {}
        for e, row in zip(mesh.element_ids().tolist(), mesh.elements().tolist(), strict=True):
            self._place(e, tuple(row))
        self._irregularity = {v: oracle.degree[v] - d for v, d in oracle.desired.items()}
        self._score = sum(map(abs, self._irregularity.values()))
        self._keep()

    def _keep(self) -> None:
        """Keep the state of the mesh, and how it should look after the next operation."""
        m = self.mesh.arrays
        self._origin, self._twin = m.edge[:, ORIGIN].copy(), m.edge[:, TWIN].copy()
        self._region = m.region.copy()
        self._curve, self._parameter = m.vertex[:, CURVE].copy(), m.parameter.copy()
        self._degree, self._desired = np.zeros((2, len(m.vertex)), np.int32)
        for v, desired in self.oracle.desired.items():
            self._degree[v], self._desired[v] = self.oracle.degree[v], desired

    def _place(self, e: int, row: Face) -> None:
        """Enter an element with the vertices of its half-edges in order."""
        self._face[e] = turned(row)
        first = e * self.oracle.k
        for i, a in enumerate(row):
            self._halfedge[a, row[i + 1 - len(row)]] = first + i

    def step(self, change: Change) -> None:
        """Compare after an operation on both, of which `change` is the face list's account.

        Raises MeshError with what differs.
        """
        if len(self.mesh.arrays.edge) != len(self._origin) or (
            len(self.mesh.arrays.vertex) != len(self._degree)
        ):
            self._enlarge()
        self._compare_elements(change)
        self._compare_twins(change)
        self._compare_vertices(change)
        self._compare_ranges(change)

    def _enlarge(self) -> None:
        """Let the kept arrays grow with those of the mesh; new slots are unused."""
        m = self.mesh.arrays
        longer, more = len(m.edge) - len(self._origin), len(m.vertex) - len(self._degree)
        self._origin = np.append(self._origin, np.full(longer, -1, self._origin.dtype))
        self._twin = np.append(self._twin, np.full(longer, -1, self._twin.dtype))
        self._region = np.append(
            self._region, np.zeros(longer // self.oracle.k, self._region.dtype)
        )
        self._curve = np.append(self._curve, np.full(more, -1, self._curve.dtype))
        self._parameter = np.append(self._parameter, np.zeros(more))
        self._degree = np.append(self._degree, np.zeros(more, np.int32))
        self._desired = np.append(self._desired, np.zeros(more, np.int32))

    def _compare_elements(self, change: Change) -> None:
        m, k, regions = self.mesh.arrays, self.oracle.k, self.oracle.regions
        origin = m.edge[:, ORIGIN]
        elements = sorted({h // k for h in (origin != self._origin).nonzero()[0].tolist()})
        gone: set[Face] = set()
        come: set[Face] = set()
        for e in elements:
            if e in self._face:
                face = self._face.pop(e)
                gone.add(face)
                for i, a in enumerate(face):
                    self._halfedge.pop((a, face[i + 1 - k]), None)
        rows = origin.reshape(-1, k)[elements].tolist()
        for e, row in zip(elements, map(tuple, rows), strict=True):
            if row[0] >= 0:
                self._place(e, row)
                come.add(self._face[e])
        if len(self._face) != len(regions):
            raise MeshError("there are more elements than should be, or fewer")
        if gone - come != change.removed.keys() or come - gone != change.added.keys():
            raise MeshError("other elements were replaced than should be")
        for e in {*(m.region != self._region).nonzero()[0].tolist(), *elements}:
            if e in self._face and m.region[e] != regions[self._face[e]]:
                raise MeshError(f"element {self._face[e]} has a wrong region")
        self._origin[:] = origin
        self._region[:] = m.region

    def _compare_twins(self, change: Change) -> None:
        m, halfedge = self.mesh.arrays, self._halfedge
        twin = m.edge[:, TWIN]
        edges = {*change.edges, *self._edges_of((twin != self._twin).nonzero()[0].tolist())}
        for a, b in edges:
            there, back = halfedge.get((a, b), -1), halfedge.get((b, a), -1)
            if (there >= 0 and twin[there] != back) or (back >= 0 and twin[back] != there):
                raise MeshError(f"the sides of the edge {a}-{b} are not twins")
        self._twin[:] = twin

    def _edges_of(self, halfedges: Iterable[int]) -> set[Edge]:
        """The edges of those half-edges that are alive, the smaller id first."""
        origin, k, edges = self._origin, self.oracle.k, set()
        for h in halfedges:
            a, b = int(origin[h]), int(origin[h - h % k + (h + 1) % k])
            if a >= 0:
                edges.add((min(a, b), max(a, b)))
        return edges

    def _compare_vertices(self, change: Change) -> None:
        m, oracle, delta = self.mesh.arrays, self.oracle, self._irregularity
        for v in change.vertices:
            self._score -= abs(delta.pop(v, 0))
            if v not in oracle.desired:
                self._degree[v] = self._desired[v] = 0
                continue
            degree, desired = oracle.degree[v], oracle.desired[v]
            self._degree[v], self._desired[v] = degree, desired
            delta[v] = degree - desired
            self._score += abs(degree - desired)
            h = m.vertex[v, HALF]
            if h < 0 or self._origin[h] != v or (oracle.on_boundary(v) and self._twin[h] >= 0):
                raise MeshError(f"the half-edge of vertex {v} is wrong")
        if (m.vertex[:, DEGREE] != self._degree).any():
            raise MeshError("the degree of a vertex is wrong")
        if (m.vertex[:, DESIRED] != self._desired).any():
            raise MeshError("the desired degree of a vertex is wrong")
        if self.mesh.score != self._score:
            raise MeshError(f"s is {self._score}, not {self.mesh.score}")

    def _compare_ranges(self, change: Change) -> None:
        """Compare where those edges lie on curves that are new or of which an end was moved."""
        m, ranges = self.mesh.arrays, self.oracle.ranges
        moved = (m.vertex[:, CURVE] != self._curve) | (m.parameter != self._parameter)
        edges = {e for a, b in change.edges for e in ((a, b), (b, a)) if e in ranges}
        for v in moved.nonzero()[0].tolist():
            edges.update(self.oracle.ranges_at(v))
            if (v in self.oracle.desired and self.oracle.on_curve(v)) != (m.vertex[v, CURVE] >= 0):
                raise MeshError(f"vertex {v} lies on a curve, or on none, and should not")
        self._curve[:] = m.vertex[:, CURVE]
        self._parameter[:] = m.parameter
        if edges:
            expected = {edge: ranges[edge] for edge in edges}
            halfedges = np.array([self._halfedge[edge] for edge in edges])
            if not same_ranges(self.mesh, expected, edge_ranges(self.mesh, halfedges)):
                raise MeshError("an edge lies in a wrong place of its curve")

    def whole(self) -> None:
        """Validate the mesh, and compare all of it with the face list.

        Raises MeshError with what differs.
        """
        self.mesh.validate()
        oracle, found = self.oracle, face_list(self.mesh)
        if found.regions != oracle.regions or found.left != oracle.left:
            raise MeshError("the faces or their regions differ")
        if not same_ranges(self.mesh, oracle.ranges, found.ranges):
            raise MeshError("an edge lies in a wrong place of its curve")
        if found.desired != oracle.desired:
            raise MeshError("a desired degree differs")
        if any(oracle.degree[v] != found.degree[v] for v in found.desired):
            raise MeshError("a degree differs")
        if (found.euler(), found.delta_sum()) != (self.mesh.euler, oracle.delta_sum()):
            raise MeshError("V - E + F or the sum of Delta differs")
