"""Quality in figures agrees with the slow measures of meshcore, element by element."""

import numpy as np
import pytest

from meshwright.document.quality_summary import CHUNK, summarise
from meshwright_core import HalfEdgeMesh
from meshwright_core.analysis.blocks import block_count
from meshwright_core.geometry import quality


def grid(n: int) -> HalfEdgeMesh:
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0))
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    quads = np.column_stack((corner, corner + 1, corner + n + 2, corner + n + 1))
    return HalfEdgeMesh.from_elements(np.column_stack((x.ravel(), y.ravel())), quads)


@pytest.mark.parametrize("kind", ["quad", "tri"])
@pytest.mark.parametrize("tilt", [False, True])
def test_summary_agrees_with_meshwright_core(kind, tilt, star, triangles):
    mesh = star if kind == "quad" else triangles
    if tilt:  # the same mesh in a slanted plane
        points = mesh.points @ np.array([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]]).T
        mesh = HalfEdgeMesh.from_elements(points, mesh.elements())
    found = summarise(mesh)
    jacobian, angle = quality.scaled_jacobian(mesh), quality.min_angle(mesh)
    assert found.jacobian.worst == pytest.approx(jacobian.min())
    there = mesh.element_ids() == found.jacobian.worst_element
    assert jacobian[there] == pytest.approx(jacobian.min())
    assert found.angle.worst == pytest.approx(angle.min())
    assert found.jacobian.counts.sum() == found.angle.counts.sum() == mesh.n_elements
    assert found.jacobian.counts.tolist() == np.histogram(jacobian, 20, (0, 1))[0].tolist()
    assert found.angle.high == (90.0 if kind == "quad" else 60.0)
    assert found.inverted.tolist() == quality.inverted(mesh).tolist() == []
    assert found.blocks == (block_count(mesh) if kind == "quad" else None)


def test_inverted_elements_are_listed(star):
    inside = np.flatnonzero(~star.boundary())
    star.move(inside[:1], star.points[inside[:1]] + (3.0, 0.0, 0.0))
    found = summarise(star)
    assert found.inverted.tolist() == quality.inverted(star).tolist() != []
    assert found.jacobian.worst == pytest.approx(quality.scaled_jacobian(star).min())
    assert found.jacobian.worst < 0 < found.angle.worst
    assert found.angle.worst_element not in found.inverted
    assert found.jacobian.counts.sum() == star.n_elements - len(found.inverted)


def test_bounds_of_bins(star):
    spread = summarise(star).angle
    assert spread.edges(0) == (0.0, 4.5)
    assert spread.edges(19) == pytest.approx((85.5, 90.0))


def test_measuring_a_large_mesh_can_be_cancelled():
    mesh = grid(200)
    found = summarise(mesh)
    assert found.jacobian.counts[-1] == mesh.n_elements == 40_000
    assert found.blocks == 1
    answers = iter([False, True])
    assert mesh.n_elements > CHUNK
    assert summarise(mesh, lambda: next(answers)) is None
