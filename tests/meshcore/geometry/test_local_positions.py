"""Positions around an operation: what moves, and what is refused."""

import numpy as np
import pytest

from meshwright_core.core.arrays import TWIN, copied
from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.element_sines import worst_around
from meshwright_core.geometry.layout_positions import rails_of
from meshwright_core.geometry.local_positions import local_effort, mark_changed, settle
from meshwright_core.geometry.quality import scaled_jacobian
from meshwright_core.geometry.smoothing import relax


@pytest.fixture
def mesh():
    found = mesh_domain(gallery.shape("plate-with-round-hole"), "quad")
    relax(found)
    return found


def interior(mesh):
    ids = mesh.vertices()
    return ids[mesh.curve_ids()[ids] < 0]


def interior_edge(mesh):
    return next(
        h for h in range(4 * mesh.n_elements)
        if mesh.arrays.edge[h, TWIN] >= 0 and mesh.check("split", h)
    )  # fmt: skip


def test_the_worst_sine_is_that_of_the_quality_measure(mesh):
    rails = rails_of(mesh, mesh.slots)
    found = worst_around(mesh.arrays, rails.turning, rails.gauge, np.zeros(0, bool), -1.0)
    assert found == pytest.approx(scaled_jacobian(mesh).min(), abs=1e-9)


def test_only_vertices_around_a_change_are_marked(mesh):
    before = copied(mesh.arrays)
    edit = mesh.apply("split", interior_edge(mesh))
    active = np.zeros(len(mesh.arrays.points), bool)
    changed = mark_changed(before, mesh.arrays, 0, active)
    assert 0 < changed <= mesh.n_elements
    assert set(edit.touched) & set(np.flatnonzero(active).tolist())
    wider = active.copy()
    assert mark_changed(before, mesh.arrays, 1, wider) == changed
    assert wider.sum() >= active.sum()
    assert (wider | ~active).all()


def test_a_folded_corner_is_unfolded_and_what_is_far_stays(mesh):
    rails, effort = rails_of(mesh, mesh.slots), local_effort(rings=1)
    before, after = copied(mesh.arrays), copied(mesh.arrays)
    v = int(interior(mesh)[0])
    # all quads at v count as changed
    for h in range(4 * mesh.n_elements):
        if after.edge[h, 0] == v:
            before.edge[h - h % 4 : h - h % 4 + 4, 0] = -1
    far = mesh.points[:, :2].max(axis=0)
    after.points[v, :2] = far
    active = np.zeros(len(after.points), bool)
    worst = settle(before, after, rails, effort, active)
    assert worst > effort.least
    still = ~active[: len(mesh.points)]
    assert (after.points[: len(still)][still] == mesh.points[still]).all()


def test_what_cannot_be_drawn_is_refused(mesh):
    rails = rails_of(mesh, mesh.slots)
    before, after = copied(mesh.arrays), copied(mesh.arrays)
    before.edge[: 4 * mesh.n_elements, 0] = -1
    active = np.zeros(len(after.points), bool)
    assert settle(before, after, rails, local_effort(least=0.999), active) == 0.0
