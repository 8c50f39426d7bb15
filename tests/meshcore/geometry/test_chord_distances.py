"""How far curved edges lie from straight ones."""

import curved_meshes
import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.chord_distances import largest_chord_distance


def test_the_sagitta_of_a_disc_with_eight_edges():
    mesh = curved_meshes.disc()
    edges = len(mesh.boundary_loops()[0])
    assert largest_chord_distance(mesh) == pytest.approx(
        (1.0 - np.cos(np.pi / edges)) / np.ptp(mesh.points[:, 0]), rel=1e-6
    )


def test_straight_edges_have_none():
    mesh = HalfEdgeMesh.from_elements([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2, 3)])
    assert largest_chord_distance(mesh) == pytest.approx(0.0, abs=1e-15)
