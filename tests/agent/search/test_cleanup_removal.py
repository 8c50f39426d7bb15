"""Without clean-ups s is the same and the lines remain."""

import numpy as np
import pytest
from replay import replayed

from meshwright_agent.search.annealing import anneal
from meshwright_agent.search.cleanup_removal import without_cleanups
from meshwright_core.domains import gallery, meshing


@pytest.mark.parametrize("name", ["annulus", "star", "t-shape"])
def test_s_stays_as_low_and_elements_are_kept(name):
    mesh = meshing.mesh_domain(gallery.shape(name), "quad")
    operations, score = anneal(mesh, proposals=100_000, seed=1)
    assert any(operation == "cleanup" for operation, _ in operations)
    finer = without_cleanups(mesh, operations)
    after = replayed(mesh, finer)
    assert after.score == score
    if finer != operations:
        assert not any(operation == "cleanup" for operation, _ in finer)
        assert after.n_elements >= replayed(mesh, operations).n_elements


def test_operations_without_clean_ups_stay_as_they_are():
    mesh = meshing.benchmark_mesh("tri", 10, np.random.default_rng(0))
    operations, _ = anneal(mesh, proposals=20_000)
    assert without_cleanups(mesh, operations) is operations
