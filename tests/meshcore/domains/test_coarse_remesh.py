"""Coarse meshes of the domain of a fine one, and the way back to its curves."""

import numpy as np
import pytest
from tests.helpers.round_meshes import round_insert, round_ring

from meshwright_core.analysis.element_division import chords, divided
from meshwright_core.domains.coarse_remesh import coarse_mesh, on_curves_of
from meshwright_core.domains.gallery import shape
from meshwright_core.domains.meshing import grid, mesh_domain
from meshwright_core.geometry.edge_curves import element_areas


@pytest.mark.parametrize(("name", "edge"), [("star", 0.1), ("plate-with-holes", 0.1)])
def test_the_domain_stays(name, edge):
    fine = mesh_domain(shape(name), "quad", max_edge=edge)
    coarse = coarse_mesh(fine)
    coarse.validate()
    assert coarse.n_elements < 0.5 * fine.n_elements
    assert coarse.optimum == fine.optimum
    back = on_curves_of(fine, coarse)
    back.validate()
    assert element_areas(back).sum() == pytest.approx(element_areas(fine).sum())
    assert back.boundary_info is fine.boundary_info


def test_desired_degrees_that_were_set_at_corners_are_kept():
    fine = grid("quad", 36)
    corner = int(np.flatnonzero(fine.geometric())[0])
    fine.set_desired(corner, 3)
    coarse = coarse_mesh(fine.copy())
    assert coarse.optimum == fine.optimum
    there = np.linalg.norm(coarse.points - fine.points[corner], axis=1).argmin()
    assert coarse.desired()[there] == 3


def test_what_it_cannot_do_it_leaves():
    locked = grid("quad", 36)
    locked.set_locked(int(np.flatnonzero(~locked.boundary())[0]))
    along_a_side = grid("quad", 36)
    side = np.flatnonzero(along_a_side.boundary() & ~along_a_side.geometric())
    along_a_side.set_desired(int(side[0]), 4)
    for mesh in (locked, along_a_side, round_insert(), grid("tri", 36)):
        assert coarse_mesh(mesh) is None


def test_true_curves_are_kept_on_the_way_back():
    ring = round_ring(12)
    fine = divided(ring, np.full(int(chords(ring).max()) + 1, 3))
    back = on_curves_of(fine, coarse_mesh(fine))
    radius = np.hypot(*back.points[back.boundary(), :2].T)
    assert np.minimum(abs(radius - 1.0), abs(radius - 2.0)).max() < 1e-12
