"""Smoothing of coarse quads keeps the shape of the worst element."""

import numpy as np
import pytest

import meshwright as mw
from meshwright.document.document import Document
from meshwright_core import warm_up
from meshwright_core.errors import MeshError
from meshwright_core.geometry import smoothing
from meshwright_core.geometry.max_min_positions import max_min_positions
from meshwright_core.geometry.quality import inverted, scaled_jacobian
from meshwright_core.geometry.weighed_shapes import weighed_worst


@pytest.fixture(scope="module", autouse=True)
def _kernels():
    warm_up.warm()


def blocks():
    """Blocks of a star as a search leaves them: at the optimum, with the best positions."""
    return mw.solve(mw.mesh("star"), seconds=2, seed=1).mesh


def test_smoothing_does_not_spoil_blocks():
    mesh = blocks()
    before = weighed_worst(mesh)
    averaged = mesh.copy()
    smoothing.relax(averaged)
    assert weighed_worst(averaged) < 0.5 < before
    document = Document(mesh, "blocks")
    document.smooth()
    assert weighed_worst(mesh) >= 0.9 * before
    document.undo()
    assert weighed_worst(mesh) == before


def test_smoothing_mends_blocks_that_a_drag_has_spoilt():
    mesh = blocks()
    good = weighed_worst(mesh)
    free = np.flatnonzero(~mesh.boundary() & (mesh.degree() > 0))
    shaken = np.zeros((len(free), 3))
    shaken[:, :2] = 0.03 * np.random.default_rng(3).normal(size=(len(free), 2))
    mesh.move(free, mesh.points[free] + shaken)
    document = Document(mesh, "blocks")
    document.smooth()
    assert weighed_worst(mesh) > 0.9 * min(good, 0.5)


def test_max_min_positions_raise_the_worst_element_and_move_no_pinned_vertex():
    mesh = mw.mesh("star")
    pinned = int(np.flatnonzero(~mesh.boundary() & (mesh.degree() > 0))[0])
    mesh.set_pinned(pinned, True)
    points = mesh.points.copy()
    ids, places, parameters = max_min_positions(mesh)
    assert np.array_equal(mesh.points, points)
    assert pinned not in ids
    assert not mesh.geometric()[ids].any()
    before = weighed_worst(mesh)
    mesh.move(ids, places, parameters)
    assert weighed_worst(mesh) > before
    assert not len(inverted(mesh))


def test_smoothing_after_an_operation_does_not_spoil_blocks():
    mesh = blocks()
    spoilt = 0
    for halfedge in mesh.halfedges_of(mesh.element_ids()).ravel().tolist():
        if not mesh.check("divide_chord", halfedge):
            continue
        plain = mesh.copy()
        edit = plain.apply("divide_chord", halfedge)
        just_after = scaled_jacobian(plain).min()
        smoothing.relax(plain, edit.touched)
        spoilt += scaled_jacobian(plain).min() < just_after - 0.05
        document = Document(mesh.copy(), "blocks")
        document.submit("divide_chord", halfedge)
        assert scaled_jacobian(document.mesh).min() >= just_after - 0.02
        document.undo()
        assert np.array_equal(document.mesh.points, mesh.points)
    assert spoilt


def test_smoothing_a_selection_does_not_spoil_blocks():
    mesh = blocks()
    mesh.apply("divide_chord", next(h for h in range(mesh.slots) if mesh.check("divide_chord", h)))
    before = scaled_jacobian(mesh).min()
    averaged = mesh.copy()
    averaged.move(*smoothing.smooth(averaged))
    assert scaled_jacobian(averaged).min() < before - 0.05
    Document(mesh, "blocks").smooth(vertices=mesh.vertices())
    assert scaled_jacobian(mesh).min() >= before - 0.02


def test_max_min_positions_of_some_vertices_move_no_other():
    mesh = mw.mesh("star")
    inside = np.flatnonzero(~mesh.boundary() & (mesh.degree() > 0))[:2]
    ids, _, _ = max_min_positions(mesh, inside)
    assert ids.tolist() == inside.tolist()


def test_triangles_have_no_max_min_positions():
    with pytest.raises(MeshError, match="Only quads"):
        max_min_positions(mw.mesh("star", kind="tri"))


def test_clean_all_smooths_without_spoiling_blocks():
    mesh = blocks()
    before = weighed_worst(mesh)
    halfedge = next(h for h in range(4 * mesh.n_elements) if mesh.check("divide_chord", h))
    mesh.apply("divide_chord", halfedge)
    document = Document(mesh, "blocks")
    assert document.clean_all() > 0
    assert weighed_worst(mesh) >= 0.9 * before > 0.5
