"""Shapes of elements: folded exactly where elements count as inverted, on all kinds of meshes."""

import numpy as np
import pytest
from tests.helpers import curved_meshes, round_meshes

from meshwright_core.domains.meshing import benchmark_mesh
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.quality import inverted
from meshwright_core.mesh import HalfEdgeMesh

MESHES = {
    "ring": round_meshes.round_ring,
    "disc": round_meshes.round_disc,
    "insert": round_meshes.round_insert,
    "plate": curved_meshes.plate,
    "quads": lambda: benchmark_mesh("quad", 9, np.random.default_rng(1)),
    "triangles": lambda: benchmark_mesh("tri", 9, np.random.default_rng(1)),
}


@pytest.mark.parametrize("name", MESHES)
def test_a_shape_of_0_or_less_means_inverted(name):
    start = MESHES[name]()
    rng = np.random.default_rng(7)
    folded = 0
    for amount in (0.0, 0.1, 0.3, 0.6):
        mesh = start.copy()
        ids = mesh.vertices()
        size = np.ptp(mesh.points[ids], axis=0).max()
        shift = np.zeros((len(ids), 3))
        shift[:, :2] = amount * size * rng.uniform(-0.5, 0.5, (len(ids), 2))
        mesh.move(ids, mesh.points[ids] + shift)
        bad = np.isin(mesh.element_ids(), inverted(mesh))
        shapes = element_shapes(mesh)
        assert (shapes[bad] <= 1e-8).all() and (shapes[~bad] > 0.0).all()
        folded += int(bad.sum())
    assert folded


def test_squares_have_1_and_long_rectangles_less():
    points = [(0, 0), (1, 0), (11, 0), (11, 1), (1, 1), (0, 1)]
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 4, 5], [1, 2, 3, 4]])
    assert element_shapes(mesh) == pytest.approx([1.0, 20.0 / 101.0])
