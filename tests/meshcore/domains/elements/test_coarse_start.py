"""Coarse starts between curved sides: pairs of triangles, their shapes, sizes and validity."""

from __future__ import annotations

import numpy as np
import pytest

from meshwright_core.domains import gallery, meshing
from meshwright_core.domains.curved_parts import curved_part
from meshwright_core.domains.elements.coarse_start import PAIRED, coarse
from meshwright_core.domains.elements.cut_elements import CutElements
from meshwright_core.domains.elements.side_edges import SideEdges
from meshwright_core.geometry import quality
from meshwright_core.geometry.edge_curves import element_areas


def part(number: int):
    """A random part with curved sides."""
    return curved_part(np.random.default_rng([5, number]))


@pytest.mark.parametrize("number", range(3))
def test_pairs_make_fewer_and_more_regular_quads(number):
    domain = part(number)
    triangles = coarse(SideEdges(domain.sides), domain.diameter, 0).elements()
    plain = triangles.catmull_clark([triangles.elements], [triangles.regions]).mesh(domain.sides)
    mesh = meshing.mesh_domain(domain, "quad")
    mesh.validate()
    assert mesh.n_elements < 0.9 * plain.n_elements
    assert mesh.score < 0.6 * plain.score and mesh.optimum == plain.optimum
    assert len(quality.inverted(mesh)) <= len(quality.inverted(plain))
    assert element_areas(mesh).sum() == pytest.approx(domain.area, rel=1e-9)


def test_shape_of_a_pair_is_that_of_its_four_quads():
    domain = part(1)
    found = coarse(SideEdges(domain.sides), domain.diameter, 0)
    cut = CutElements(found.edges, found.points)
    blocks, regions = found.elements().paired(lambda quads: cut.quad_shapes(quads) - PAIRED)
    mesh = found.elements().catmull_clark(blocks, regions).mesh(domain.sides)
    pairs = len(blocks[0])
    measured = quality.scaled_jacobian(mesh)[: 4 * pairs].reshape(-1, 4).min(axis=1)
    shapes = cut.quad_shapes(blocks[0])
    bent = (cut.side_edges(blocks[0]) >= 0).any(axis=1)
    assert pairs and bent.any() and not bent.all()
    assert shapes.min() > PAIRED
    np.testing.assert_allclose(shapes, measured, atol=1e-9)


def test_interfaces_stay_between_pairs():
    domain = gallery.shape("plate-with-insert")
    mesh = meshing.mesh_domain(domain, "quad")
    mesh.validate()
    assert not len(quality.inverted(mesh))
    areas, regions = element_areas(mesh), mesh.arrays.region[mesh.element_ids()]
    assert len(np.unique(regions)) == 2
    triangles = coarse(SideEdges(domain.sides), domain.diameter, 0).elements()
    plain = triangles.catmull_clark([triangles.elements], [triangles.regions]).mesh(domain.sides)
    before, labels = element_areas(plain), plain.arrays.region[plain.element_ids()]
    for region in (0, 1):
        ours, usual = areas[regions == region].sum(), before[labels == region].sum()
        assert ours == pytest.approx(usual, rel=1e-12)


def test_a_plate_with_a_round_hole_is_coarse():
    mesh = meshing.mesh_domain(gallery.shape("plate-with-round-hole"), "quad")
    assert mesh.n_elements <= 24 and not len(quality.inverted(mesh))
