"""The naive face list refuses and rewrites as it should, and every fault of a mesh is found."""

from copy import deepcopy

import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.arrays import CURVE, DEGREE, DESIRED, HALF, ORIGIN, SCORE, TWIN
from meshwright_core.testing import fuzzing
from meshwright_core.testing.comparison import Comparison, face_list
from meshwright_core.testing.face_list_oracle import FaceList, Refused
from meshwright_core.testing.face_list_rewrites import allowed, apply
from meshwright_core.testing.fuzzing import fuzz, start_mesh


def two_by_two(regions=(0, 0, 1, 1)) -> HalfEdgeMesh:
    """Four unit squares; the vertices are numbered row by row."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(3.0), np.arange(3.0)))
    corners = np.array([0, 1, 3, 4])
    elements = np.column_stack([corners, corners + 1, corners + 4, corners + 3])
    return HalfEdgeMesh.from_elements(np.column_stack([x, y]), elements, regions=regions)


def state(oracle: FaceList) -> dict:
    """All that is known of the mesh; counts of 0 do not matter."""
    known = {name: deepcopy(getattr(oracle, name)) for name in ("regions", "left", "ranges")}
    counted = (oracle.degree, oracle._open, oracle._around, oracle._ranged, oracle._sizes)
    known["counts"] = [{key: n for key, n in counts.items() if n} for counts in deepcopy(counted)]
    return known | {"desired": dict(oracle.desired), "numbers": (oracle.edges, oracle.vertices)}


def test_numbers_of_a_mesh():
    oracle = face_list(two_by_two())
    assert (oracle.vertices, oracle.edges, len(oracle.faces), oracle.euler()) == (9, 12, 4, 1)
    assert dict(oracle.degree) == {0: 2, 1: 3, 2: 2, 3: 3, 4: 4, 5: 3, 6: 2, 7: 3, 8: 2}
    assert [v for v in range(9) if oracle.on_boundary(v)] == [0, 1, 2, 3, 5, 6, 7, 8]
    assert sorted(map(sorted, oracle.ranges))[3:6] == [[2, 5], [3, 4], [3, 6]]


@pytest.mark.parametrize(
    ("operation", "edge"),
    [
        ("flip_left", (4, 3)),  # an interface
        ("flip_left", (0, 1)),  # the boundary
        ("chord_collapse", (0, 3)),  # deletes a region
        ("collapse", (0, 1)),  # a corner must stay, or a vertex leaves its curve
        ("cleanup", (3, 4)),
    ],
)
def test_what_is_refused_changes_nothing(operation, edge):
    oracle = face_list(two_by_two())
    before = state(oracle)
    assert not allowed(oracle, operation, *edge)
    with pytest.raises(Refused):
        apply(oracle, operation, *edge)
    assert state(oracle) == before


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_every_change_can_be_taken_back(kind):
    rng = np.random.default_rng(2)
    for _ in range(3):
        mesh = start_mesh(kind, 5, rng, curved=True, interfaces=True)
        oracle = face_list(mesh)
        before = state(oracle)
        names = [str(name) for name in mesh.allowed(-1)]
        edges = list(oracle.left)
        count = sum(allowed(oracle, name, *edge) for edge in edges for name in names)
        assert 0 < count < len(edges) * len(names)
        assert state(oracle) == before


def test_a_mesh_with_two_faces_on_one_side_of_an_edge_is_refused():
    with pytest.raises(Refused, match="same vertices"):
        FaceList([(0, 1, 2), (0, 1, 3)], dict.fromkeys(range(4), 4), set())


def _far_vertex(mesh: HalfEdgeMesh, near: set[int]) -> int:
    """A live vertex that an operation has not touched."""
    return next(v for v in mesh.vertices().tolist()[::-1] if v not in near)


def _touched(mesh: HalfEdgeMesh, near: set[int]) -> int:
    """A live vertex that an operation has touched."""
    return next(v for v in mesh.vertices().tolist() if v in near)


def _wrong_region(mesh: HalfEdgeMesh, v: int) -> None:
    e = int(mesh.arrays.vertex[v, HALF]) // mesh.k
    mesh.arrays.region[e] = 1 - mesh.arrays.region[e]


def _wrong_column(mesh: HalfEdgeMesh, v: int, column: int, change: int) -> None:
    mesh.arrays.vertex[v, column] += change


def _wrong_edge(mesh: HalfEdgeMesh, v: int, column: int) -> None:
    h = int(mesh.arrays.vertex[v, HALF])
    other = h - h % mesh.k + (h + 1) % mesh.k
    mesh.arrays.edge[[h, other], column] = mesh.arrays.edge[[other, h], column]


def _wrong_seat(mesh: HalfEdgeMesh, v: int) -> None:
    on_curve = [u for u in mesh.vertices().tolist() if mesh.arrays.vertex[u, CURVE] >= 0]
    seated = v if v in on_curve else on_curve[v % len(on_curve)]
    mesh.arrays.parameter[seated] += 0.001


FAULTS = {
    "region": _wrong_region,
    "degree": lambda mesh, v: _wrong_column(mesh, v, DEGREE, 1),
    "desired degree": lambda mesh, v: _wrong_column(mesh, v, DESIRED, 1),
    "vertices of an element": lambda mesh, v: _wrong_edge(mesh, v, ORIGIN),
    "twins": lambda mesh, v: _wrong_edge(mesh, v, TWIN),
    "s": lambda mesh, v: mesh.arrays.counters.__setitem__(SCORE, mesh.score + 2),
    "parameter": _wrong_seat,
    "curve": lambda mesh, v: _wrong_column(mesh, v, CURVE, -2),
}


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("place", [_touched, _far_vertex])
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found_by_the_step_that_made_it(fault, place, kind):
    rng, found = np.random.default_rng(5), 0
    name = "flip" if kind == "tri" else "flip_left"
    while found < 3:
        mesh = start_mesh(kind, 7, rng, curved=True, interfaces=True)
        allowed_at = [h for h in mesh.halfedges_of(mesh.element_ids()).ravel().tolist()
                      if mesh.check(name, h)]  # fmt: skip
        if not allowed_at or len(mesh.region_names) < 2 or mesh.n_elements < 12:
            continue
        h = allowed_at[len(allowed_at) // 2]
        both, ends = Comparison(mesh, face_list(mesh)), (mesh.origin(h), mesh.target(h))
        mesh.apply(name, h)
        change = apply(both.oracle, name, *ends)
        v = place(mesh, change.vertices)
        if fault == "curve" and mesh.arrays.vertex[v, CURVE] < 0:
            _wrong_column(mesh, v, CURVE, 1)
        else:
            FAULTS[fault](mesh, v)
        with pytest.raises(MeshError):
            both.step(change)
        found += 1


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_a_wrong_verdict_is_found(kind, monkeypatch):
    right = HalfEdgeMesh.check
    monkeypatch.setattr(
        HalfEdgeMesh, "check",
        lambda mesh, operation, h: right(mesh, operation, h) if operation != "split"
        else right(mesh, operation, -1),
    )  # fmt: skip
    with pytest.raises(MeshError, match=r"seed 0, attempt \d+: split on .* without need"):
        fuzz(kind, 300, curved=True, interfaces=True)


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_the_comparison_at_the_end_looks_at_everything(kind, monkeypatch):
    monkeypatch.setattr(fuzzing.Comparison, "step", lambda both, change: None)
    right = HalfEdgeMesh.apply

    def wrong(mesh, operation, h):
        edit = right(mesh, operation, h)
        if operation == "split":
            mesh.arrays.parameter[mesh.arrays.vertex[:, CURVE] >= 0] *= 0.999
        return edit

    monkeypatch.setattr(HalfEdgeMesh, "apply", wrong)
    with pytest.raises(MeshError):
        fuzz(kind, 120, curved=True)
