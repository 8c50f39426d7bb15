"""Coarsening: fewer quads, s no higher, no more inverted elements, corners kept."""

import numpy as np
import pytest
from replay import replayed

from meshwright_agent.search.annealing import anneal
from meshwright_agent.search.coarsening import coarsen, undrawable
from meshwright_core.domains import gallery, meshing

pytestmark = pytest.mark.slow


def optimal(name):
    mesh = meshing.mesh_domain(gallery.shape(name), "quad")
    for operation, h in anneal(mesh, proposals=1_000_000)[0]:
        mesh.apply(operation, h)
    assert mesh.score == mesh.optimum
    return mesh


@pytest.mark.parametrize(("name", "most"), [("l-shape", 3), ("square", 1), ("star", 12)])
def test_gallery_shapes_become_coarse_at_the_optimum(name, most):
    mesh = optimal(name)
    after = replayed(mesh, coarsen(mesh, proposals=100_000, seconds=None))
    assert after.score == mesh.optimum
    assert after.n_elements <= most
    assert undrawable(after, []) <= undrawable(mesh, [])
    assert after.geometric().sum() == mesh.geometric().sum()


def test_the_floor_is_kept():
    mesh = meshing.grid("quad", 36)
    after = replayed(mesh, coarsen(mesh, proposals=50_000, seconds=None, floor=12))
    assert 12 <= after.n_elements < 36


def test_it_ends_when_nothing_was_found_for_many_sweeps():
    mesh = optimal("l-shape")
    after = replayed(mesh, coarsen(mesh, seconds=None, patience=1000))
    assert after.n_elements <= 3


def test_no_operations_for_triangles_or_when_cancelled():
    mesh = meshing.benchmark_mesh("tri", 10, np.random.default_rng(0))
    assert coarsen(mesh) == []
    quads = meshing.benchmark_mesh("quad", 10, np.random.default_rng(0))
    assert coarsen(quads, seconds=60.0, cancelled=lambda: True) == []
