"""Searches on meshes of several regions keep the interfaces."""

import numpy as np
import pytest

from meshwright_agent.search.annealing import anneal
from meshwright_core.testing.curved_starts import region_areas
from meshwright_core.testing.fuzzing import start_mesh


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_annealing_keeps_regions_and_vertices_on_their_curves(kind):
    for seed in range(6):
        mesh = start_mesh(kind, 8, np.random.default_rng(seed), curved=True, interfaces=True)
        areas, curves = region_areas(mesh), mesh.boundary_info
        operations, score = anneal(mesh, proposals=20_000, seed=seed)
        for operation, h in operations:
            mesh.apply(operation, h)
        assert mesh.score == score
        mesh.validate()
        assert mesh.boundary_info is curves
        assert mesh.off_curve().max() < 1e-12 * 8
        assert np.abs(region_areas(mesh) - areas).max() < 1e-11
