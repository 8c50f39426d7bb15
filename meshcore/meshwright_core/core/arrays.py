"""The arrays of a half-edge mesh (a DCEL), their invariants, and how to traverse them.

Layout
------
Every element has k sides, k = 3 or 4. Element e owns the half-edges k*e ... k*e+k-1 in
counter-clockwise order, so that *next* and *previous* are arithmetic, and the paper's *cycle* a
reshape (section 4.2). Everything lives in a few arrays (:class:`MeshArrays`) that compiled kernels
take as one argument; the rows of one vertex share a cache line.

Invariants of live slots
------------------------
1. ``edge[h, ORIGIN]`` is a live vertex; the k origins of an element differ.
2. ``edge[h, TWIN]`` is -1 on the boundary; else a live half-edge with the same ends, turned
   round, and twin of twin is h.
3. Between two vertices there is at most one edge.
4. ``vertex[v, HALF]`` is a half-edge that leaves v. If v lies on the boundary it is the one
   without twin, so that turning counter-clockwise from it sweeps all of v's elements once. All
   elements at v are met by this sweep (no pinched vertices).
5. ``vertex[v, DEGREE]`` is the number of edges at v: at least 2; an interior vertex of degree 2
   (a doublet) exists in quad meshes only.
6. ``irregular[:counters[IRREGULAR]]`` holds every vertex with degree != desired once, and
   ``vertex[v, PLACE]`` is its place there, -1 for regular vertices.
7. ``counters`` holds the counts and sums that the names of its indices stand for.
8. ``vertex[:, MARK]`` and ``element_mark`` are zero between calls (scratch of the checks).
9. An edge is *constrained* if its two elements have different regions. The vertices of boundary and
   constrained edges have ``vertex[v, CURVE]`` >= 0, all others -1 and parameter 0.
10. The vertices of a boundary loop lie on one closed curve of their own. Their parameters, in
    [0, length), increase along the loop, once around; the domain is on the left of the curve.
11. The constrained edges between the two regions of an interface form one chain, from its start to
    its end vertex or closed, on which the parameters increase with the left region on the left. A
    vertex whose curve edges are not two of one curve is a *junction*: it is geometric, and every
    interface at it starts or ends there; its own curve is a boundary loop if it lies on one.

A position is no invariant: a vertex lies at ``parameter`` of its curve to within rounding until
someone moves it off (:meth:`meshwright_core.mesh.HalfEdgeMesh.move`), and its parameter then says
which point of the curve it stands for.

Dead slots are chained: an element through ``edge[k*e, TWIN]`` with all origins -1; a vertex v
through ``vertex[v, HALF]`` = -2 - (next dead vertex). A dead vertex has degree and desired degree
0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.composite_curves import Curves, no_curves
from meshwright_core.core.references import by_reference

# columns of MeshArrays.edge
ORIGIN, TWIN = 0, 1
# columns of MeshArrays.vertex
HALF, DEGREE, DESIRED, FLAGS, PLACE, MARK, CURVE, NAMING = 0, 1, 2, 3, 4, 5, 6, 7
VERTEX_COLUMNS = 8  # 32 bytes: half a cache line
# bits of vertex[:, FLAGS]
GEOMETRIC, LOCKED = 1, 2
# columns of MeshArrays.interface
LEFT, RIGHT, START, END = 0, 1, 2, 3
# counters that an undo restores
VERTEX_SLOTS, ELEMENT_SLOTS, VERTICES, ELEMENTS, BOUNDARY_EDGES = 0, 1, 2, 3, 4
FREE_VERTEX, FREE_ELEMENT, SCORE, DELTA_SUM, IRREGULAR = 5, 6, 7, 8, 9
RESTORED = 10
# counters of the mesh and its journal that an undo leaves alone
SIDES, JOURNALLING, JOURNAL_TOP, STEP, STEP_END, GROUPED = 10, 11, 12, 13, 14, 15
COUNTERS = 16
# columns of MeshArrays.steps; the restored counters follow
STEP_START, STEP_STOP, STEP_OPERATION, STEP_HALFEDGE, STEP_COUNTERS = 0, 1, 2, 3, 4
STEP_COLUMNS = STEP_COUNTERS + RESTORED
# MeshArrays.trace: what the last operation did
NEW_COUNT, TOUCHED_COUNT, TRACE_IDS = 0, 1, 2


@by_reference
class MeshArrays(NamedTuple):
    """All data of a mesh; H half-edge, V vertex and E = H / k element slots of capacity."""

    edge: np.ndarray
    """(H, 2) int32: origin, twin."""
    vertex: np.ndarray
    """(V, 8) int32: a half-edge, degree, desired degree, flags, place among the irregular, mark,
    curve; the last column is 0 but in row 0, where it is the number of the names in force."""
    points: np.ndarray
    """(V, 3) float64: coordinates."""
    irregular: np.ndarray
    """(V,) int32: the irregular vertices, in no order."""
    element_mark: np.ndarray
    """(E,) int32: scratch."""
    trace: np.ndarray
    """(2 V + 64,) int32: counts of new and of touched vertices, then their ids, new ones first."""
    counters: np.ndarray
    """(16,) int64."""
    journal: np.ndarray
    """(J, 2) int64: place and former value of each write."""
    steps: np.ndarray
    """(S, 14) int64: one row for each undoable step."""
    parameter: np.ndarray
    """(V,) float64: where on its curve a vertex lies; 0 for those on none."""
    region: np.ndarray
    """(E,) int32: the region of each element."""
    curves: Curves
    """Boundary loops and interfaces; never written, and shared by copies."""
    interface: np.ndarray
    """(n, 4) int32: for each curve left and right region, start and end vertex; all -1 for boundary
    loops, the vertices -1 for interfaces without junction. Never written, and shared by copies."""


def allocate(
    k: int, vertices: int, elements: int, journal: int = 1024, steps: int = 64
) -> MeshArrays:
    """Empty arrays with room for `vertices` and `elements` slots, journal entries and steps.

    They hold no curve: edits put new vertices in the middle of straight edges.
    """
    arrays = MeshArrays(
        edge=np.full((k * elements, 2), -1, np.int32),
        vertex=np.zeros((vertices, VERTEX_COLUMNS), np.int32),
        points=np.zeros((vertices, 3)),
        irregular=np.full(vertices, -1, np.int32),
        element_mark=np.zeros(elements, np.int32),
        trace=np.zeros(2 * vertices + 64, np.int32),
        counters=np.zeros(COUNTERS, np.int64),
        journal=np.zeros((journal, 2), np.int64),
        steps=np.zeros((steps, STEP_COLUMNS), np.int64),
        parameter=np.zeros(vertices),
        region=np.zeros(elements, np.int32),
        curves=no_curves(),
        interface=np.zeros((0, 4), np.int32),
    )
    arrays.vertex[:, (PLACE, HALF, CURVE)] = -1
    arrays.counters[FREE_VERTEX] = arrays.counters[FREE_ELEMENT] = -1
    arrays.counters[SIDES] = k
    arrays.counters[JOURNALLING] = 1
    return arrays


def copied(arrays: MeshArrays) -> MeshArrays:
    """The same mesh and history in arrays of its own; only the curves are shared."""
    own = {name: getattr(arrays, name).copy() for name in MeshArrays._fields[:-2]}
    return MeshArrays(**own, curves=arrays.curves, interface=arrays.interface)


def copy_rows(source: np.ndarray, length: int, fill: int) -> np.ndarray:
    """A longer copy of `source`: (length, ...) rows, the new ones set to `fill`.

    `source` itself if it has that length already: a journal grows without copying a large mesh.
    """
    if length == len(source):
        return source
    longer = np.full((length, *source.shape[1:]), fill, source.dtype)
    longer[: len(source)] = source
    return longer


def enlarge(
    arrays: MeshArrays, vertices: int, elements: int, journal: int, steps: int
) -> MeshArrays:
    """The same mesh in arrays with at least this much room; ids and history stay valid."""
    k = int(arrays.counters[SIDES])
    vertices = max(vertices, len(arrays.vertex))
    elements = max(elements, len(arrays.element_mark))
    vertex = copy_rows(arrays.vertex, vertices, 0)
    vertex[len(arrays.vertex) :, (PLACE, HALF, CURVE)] = -1
    return MeshArrays(
        edge=copy_rows(arrays.edge, k * elements, -1),
        vertex=vertex,
        points=copy_rows(arrays.points, vertices, 0),
        irregular=copy_rows(arrays.irregular, vertices, -1),
        element_mark=copy_rows(arrays.element_mark, elements, 0),
        trace=copy_rows(arrays.trace, 2 * vertices + 64, 0),
        counters=arrays.counters,
        journal=copy_rows(arrays.journal, max(journal, len(arrays.journal)), 0),
        steps=copy_rows(arrays.steps, max(steps, len(arrays.steps)), 0),
        parameter=copy_rows(arrays.parameter, vertices, 0),
        region=copy_rows(arrays.region, elements, 0),
        curves=arrays.curves,
        interface=arrays.interface,
    )


def halfedges_of(elements: np.ndarray, k: int) -> np.ndarray:
    """(m, k) half-edges of elements (m,) of k sides."""
    halfedges: np.ndarray = k * elements[:, None] + np.arange(k)
    return halfedges


def corners_of(m: MeshArrays, elements: np.ndarray) -> np.ndarray:
    """(m, k) int64 vertex ids of elements (m,), counter-clockwise; -1 for dead elements."""
    return m.edge[halfedges_of(elements, int(m.counters[SIDES])), ORIGIN].astype(np.int64)


@bare_kernel
def following(h, k):
    """The next half-edge of h's element, counter-clockwise."""
    return h + 1 if (h + 1) % k else h + 1 - k


@bare_kernel
def preceding(h, k):
    """The previous half-edge of h's element."""
    return h - 1 if h % k else h + k - 1


@bare_kernel
def opposite(h):
    """The half-edge across h in its quad: the last two bits of h are its place there."""
    return h ^ 2


@bare_kernel
def on_boundary(m, v):
    """Whether the live vertex v lies on the boundary (invariant 4)."""
    return m.edge[m.vertex[v, HALF], TWIN] < 0


@bare_kernel
def on_curve(m, v):
    """Whether v lies on the boundary or on the interface of two regions (invariant 9)."""
    return m.vertex[v, CURVE] >= 0


@bare_kernel
def constrained(m, h, k):
    """Whether the edge of h lies on the interface of two regions."""
    t = m.edge[h, TWIN]
    return t >= 0 and m.region[h // k] != m.region[t // k]


@bare_kernel
def along_curve(m, h, k):
    """Whether the edge of h lies on the boundary or on the interface of two regions."""
    t = m.edge[h, TWIN]
    return t < 0 or m.region[h // k] != m.region[t // k]


@bare_kernel
def turned(m, h, k):
    """The next half-edge that leaves the origin of h, counter-clockwise.

    Beyond the last one of a boundary vertex: -1 - g, where g is the boundary half-edge that ends
    there. So the neighbours of v are met once each by starting at ``vertex[v, HALF]`` and turning
    ``vertex[v, DEGREE]`` - 1 times, and :func:`neighbour` names each of them.
    """
    back = preceding(h, k)
    t = m.edge[back, TWIN]
    return t if t >= 0 else -1 - back


@bare_kernel
def neighbour(m, h, k):
    """The vertex at the far end of h, which may also be what :func:`turned` returns beyond the
    boundary.
    """
    return m.edge[following(h, k) if h >= 0 else -1 - h, ORIGIN]


@bare_kernel
def joined(m, a, b, k):
    """Whether an edge joins the live vertices a and b: one sweep around a, O(degree)."""
    h = m.vertex[a, HALF]
    for _ in range(m.vertex[a, DEGREE]):
        if neighbour(m, h, k) == b:
            return True
        if h < 0:
            break
        h = turned(m, h, k)
    return False


@bare_kernel
def find(m, a, b, k):
    """The half-edge from a to b, or -1: one sweep around a, O(degree)."""
    h = m.vertex[a, HALF]
    for _ in range(m.vertex[a, DEGREE]):
        if neighbour(m, h, k) == b:
            return h
        h = turned(m, h, k)
        if h < 0:
            break
    return -1


@bare_kernel
def common_neighbours(m, a, b, k):
    """The number of vertices joined to both a and b, O(degree of a times degree of b)."""
    count = 0
    h = m.vertex[a, HALF]
    for _ in range(m.vertex[a, DEGREE]):
        if joined(m, b, neighbour(m, h, k), k):
            count += 1
        if h < 0:
            break
        h = turned(m, h, k)
    return count
