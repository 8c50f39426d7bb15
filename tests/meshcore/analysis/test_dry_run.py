"""What an operation would do, and that finding it out leaves no trace."""

import numpy as np
import pytest
from tiny_meshes import faces, grid, ring, square_of_triangles

from meshwright_core import HalfEdgeMesh, OperationRefused
from meshwright_core.analysis.dry_run import dry_run
from meshwright_core.core.arrays import ELEMENT_SLOTS, JOURNAL_TOP
from meshwright_core.domains import gallery, meshing
from meshwright_core.operations.catalogue import of_kind


def _pairs(segments):
    """Edges as a set of pairs of rounded places."""
    return {frozenset(tuple(np.round(end[:2], 9).tolist()) for end in edge) for edge in segments}


def _edges(mesh):
    found = set()
    points = mesh.points[:, :2]
    for row in mesh.elements().tolist():
        for a, b in zip(row, row[1:] + row[:1], strict=True):
            found.add(frozenset(tuple(np.round(points[v], 9).tolist()) for v in (a, b)))
    return found


def _bits(mesh):
    arrays = mesh.arrays
    slots = {
        "edge": mesh.k * int(arrays.counters[ELEMENT_SLOTS]),
        "element_mark": int(arrays.counters[ELEMENT_SLOTS]),
        "region": int(arrays.counters[ELEMENT_SLOTS]),
        "trace": 0,
        "journal": int(arrays.counters[JOURNAL_TOP]),
    }
    return [
        np.array(array[: slots.get(name, len(array))]).tobytes()
        for name, array in zip(arrays._fields[:-2], arrays[:-2], strict=True)
    ]


def test_a_flip_replaces_one_edge():
    mesh = square_of_triangles()
    seen = dry_run(mesh, "flip", mesh.halfedge(0, 2))
    assert _pairs(seen.removed) == {frozenset([(0.0, 0.0), (1.0, 1.0)])}
    assert _pairs(seen.added) == {frozenset([(1.0, 0.0), (0.0, 1.0)])}
    assert sorted(seen.vertices.tolist()) == [0, 1, 2, 3]
    assert seen.score_change == 0
    assert faces(mesh) == {(0, 1, 2), (0, 2, 3)}


def test_the_two_halves_of_an_edge_count_as_unchanged():
    mesh = square_of_triangles()
    seen = dry_run(mesh, "split", mesh.halfedge(0, 2))
    assert len(seen.removed) == 0
    assert _pairs(seen.added) == {
        frozenset([(0.5, 0.5), (1.0, 0.0)]),
        frozenset([(0.5, 0.5), (0.0, 1.0)]),
    }
    assert seen.new_vertices.tolist() == [4]
    assert dict(zip(seen.vertices.tolist(), seen.delta.tolist(), strict=True))[4] == -2


def test_a_global_split_shows_its_whole_path():
    mesh = grid(6)
    seen = dry_run(mesh, "global_split", mesh.halfedge(24, 31))
    ends = {place for edge in _pairs(seen.added) for place in edge}
    assert ends >= {(2.5, y) for y in (4.0, 5.0, 6.0)} | {(3.5, y) for y in (4.0, 5.0, 6.0)}
    assert _pairs(seen.removed) <= {frozenset([(3.0, 3.0), (3.0, 4.0)])}
    assert len(seen.new_vertices) == 6
    assert seen.score_change == 2


def test_a_clean_up_shows_the_line_that_goes():
    mesh = grid(3)
    seen = dry_run(mesh, "cleanup", mesh.halfedge(1, 5))
    assert len(seen.added) == 0
    assert _pairs(seen.removed) == {
        frozenset([(1.0, float(y)), (1.0, float(y + 1))]) for y in range(3)
    }
    mesh = ring(6, 2)
    seen = dry_run(mesh, "cleanup", mesh.halfedge(6, 7))
    assert (len(seen.removed), len(seen.added)) == (6, 0)


def test_a_collapse_shows_the_vertex_that_goes():
    mesh = grid(3)
    seen = dry_run(mesh, "collapse", mesh.halfedge(5, 6))
    assert seen.gone.tolist() == [[2.0, 2.0, 0.0]]
    assert 5 in seen.vertices


def test_a_refused_operation_says_why():
    mesh = square_of_triangles()
    with pytest.raises(OperationRefused, match="boundary"):
        dry_run(mesh, "flip", mesh.halfedge(0, 1))


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_dry_runs_agree_with_the_operation_and_change_nothing(kind):
    mesh = meshing.mesh_domain(gallery.shape("star"), kind)
    rng = np.random.default_rng(3)
    infos = of_kind(kind)
    seen_once = set()
    for _ in range(300):
        h = int(rng.choice(mesh.element_ids())) * mesh.k + int(rng.integers(mesh.k))
        operation = infos[rng.integers(len(infos))].operation
        if rng.random() < 0.2:
            mesh.undo()
        if not mesh.live(h) or not mesh.check(operation, h):
            continue
        steps, redo, bits = mesh.steps, mesh.can_redo, _bits(mesh)
        seen = dry_run(mesh, operation, h)
        arrays = mesh.arrays
        if len(arrays.points) == len(np.frombuffer(bits[2])) // 3:  # the arrays did not grow
            assert _bits(mesh) == bits
        assert (mesh.steps, mesh.can_redo) == (steps, redo)
        before, delta = _edges(mesh), mesh.irregularity()
        edit = mesh.apply(operation, h)
        seen_once.add(operation)
        assert seen.score_change == edit.score_change
        after = _edges(mesh)
        assert _pairs(seen.removed) <= before - after
        assert _pairs(seen.added) <= after - before
        now = mesh.irregularity()
        assert now[seen.vertices].tolist() == seen.delta.tolist()
        assert np.array_equal(mesh.points[seen.vertices], seen.places)
        same = np.ones(len(now), bool)
        same[seen.vertices] = False
        same[len(delta) :] = False
        live = np.isin(np.arange(len(now)), mesh.vertices())
        rows = np.flatnonzero(same & live)
        old_live = rows[rows < len(delta)]
        assert np.array_equal(now[old_live], delta[old_live])
        if rng.random() < 0.5:
            mesh.undo()
    mesh.validate()
    assert len(seen_once) >= 3


def test_dry_runs_enlarge_arrays_and_keep_redo():
    points = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    mesh = HalfEdgeMesh.from_elements(points, [(0, 1, 2), (0, 2, 3)])
    for _ in range(200):
        mesh.apply("split", 0)
        dry_run(mesh, "split", 0)
    end = mesh.elements()
    while mesh.undo():
        continue
    dry_run(mesh, "flip", mesh.halfedge(0, 2))
    assert faces(mesh) == {(0, 1, 2), (0, 2, 3)}
    while mesh.redo():
        continue
    assert np.array_equal(mesh.elements(), end)
    mesh.validate()
