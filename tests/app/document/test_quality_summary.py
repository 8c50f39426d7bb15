"""Quality in figures agrees with the slow measures of meshcore, element by element."""

import numpy as np
import pytest

from meshwright.document.element_quality import CHUNK, ElementQuality
from meshwright.document.quality_summary import shape_words, summarise
from meshwright_core import HalfEdgeMesh
from meshwright_core.analysis.blocks import block_count
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry import quality
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.shape_bound import shape_bound
from meshwright_core.geometry.smoothing import relax
from meshwright_core.operations.catalogue import of_kind


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


def test_shapes_and_bound_are_those_of_meshwright_core(star):
    found = summarise(star)
    assert found.shape.worst == pytest.approx(element_shapes(star).min())
    assert found.bound == shape_bound(star)
    ids = star.element_ids()
    assert np.array_equal(found.values.shape[ids], element_shapes(star))


@pytest.mark.parametrize("name", ["star", "plate-with-holes"])
@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_only_what_has_changed_is_measured_again(name, kind):
    mesh = meshing.mesh_domain(gallery.shape(name), kind)
    followed, rng = ElementQuality(), np.random.default_rng(3)
    followed.follow(mesh)
    least = mesh.n_elements
    names = [info.operation for info in of_kind(kind)]
    for number in range(30):
        halfedge = int(rng.integers(mesh.k * int(mesh.element_ids()[-1])))
        operation = names[number % len(names)]
        if mesh.check(operation, halfedge):
            edit = mesh.apply(operation, halfedge)
            relax(mesh, edit.touched, thorough=False)
        if number % 10 == 9:
            mesh.undo()
        followed.follow(mesh)
        least = min(least, followed.measured) or least
        fresh = ElementQuality()
        fresh.follow(mesh)
        assert np.array_equal(followed.ids, mesh.element_ids())
        for one, other in zip(
            (followed.jacobian, followed.angle, followed.shape),
            (fresh.jacobian, fresh.angle, fresh.shape),
            strict=True,
        ):
            assert np.allclose(one, other, equal_nan=True, atol=1e-12)
        assert followed.inverted.tolist() == quality.inverted(mesh).tolist()
    assert least < mesh.n_elements


def test_a_mesh_that_leaves_its_plane_is_measured_anew(star):
    followed = ElementQuality()
    followed.follow(star)
    star.move(star.vertices(), star.points[star.vertices()] + (0.0, 0.0, 1.0))
    followed.follow(star)
    assert followed.measured == star.n_elements
    assert np.allclose(followed.jacobian[star.element_ids()], quality.scaled_jacobian(star))


@pytest.mark.parametrize(
    ("worst", "bound", "words"),
    [
        (0.7229, 0.7229, ".72 of at most .72"),
        (1.0, 1.0, "1.00 of at most 1.00"),
        (-0.051, 0.5, "\u2212.05 of at most .50"),
        (0.9, 0.7, ".90; regular corners permit .70"),
    ],
)
def test_shape_in_words(worst, bound, words):
    assert shape_words(worst, bound) == words
