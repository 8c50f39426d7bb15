"""Improved meshes of elements of the same size, and answers as they were asked for."""

import time
from dataclasses import replace

import numpy as np
import pytest

from meshwright_agent.policy import policy_files
from meshwright_agent.search.improvement import Wishes, _divided_for, improve
from meshwright_agent.search.layout_search import Preference
from meshwright_agent.search.patchwise import is_large
from meshwright_agent.search.size_keeping import Fit
from meshwright_agent.search.solution import Solution
from meshwright_core.analysis.element_division import divided
from meshwright_core.domains.gallery import shape
from meshwright_core.domains.meshing import grid, mesh_domain
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.quality import inverted, scaled_jacobian
from meshwright_core.mesh import HalfEdgeMesh


@pytest.fixture(scope="module")
def policies():
    policy_files.decide_on_one_thread()
    return {kind: policy_files.load(policy_files.shipped(kind)[0]) for kind in ("quad", "tri")}


@pytest.mark.parametrize(("kind", "in_place"), [("quad", False), ("quad", True), ("tri", False)])
def test_size_and_shape_are_kept(policies, kind, in_place):
    mesh = mesh_domain(shape("star"), kind, max_edge=0.15)
    wishes = Wishes(keep_size=True, in_place=in_place)
    found = improve(mesh, policies[kind], wishes, rollouts=4)
    made = found.mesh
    made.validate()
    fit = Fit.of(mesh, Preference())
    assert not fit.faults(made)
    assert made.optimum == mesh.optimum and made.score < mesh.score
    assert not len(inverted(made))
    assert scaled_jacobian(made).min() >= min(scaled_jacobian(mesh).min(), 0.5) - 1e-6
    assert abs(made.n_elements / mesh.n_elements - 1.0) <= 0.25
    assert fit.sized(made) > 0.9
    if kind == "quad" and not in_place:
        assert found.method == "blocks" and made.score == made.optimum
    if found.method == "in place":
        again = mesh.copy()
        for operation, h in found.operations:
            again.apply(operation, h)
        assert again.score == made.score


@pytest.mark.slow
def test_large_meshes_are_improved_in_place_and_stay_valid(policies):
    mesh = mesh_domain(shape("star"), "tri", max_edge=0.045)
    assert is_large(mesh)
    found = improve(mesh, policies["tri"], Wishes(keep_size=True), seconds=4.0)
    assert not Fit.of(mesh, Preference()).faults(found.mesh)
    again = mesh.copy()
    for operation, h in found.operations:
        again.apply(operation, h)
    assert again.score == found.mesh.score
    assert np.array_equal(again.elements(), found.mesh.elements())
    assert not found.mesh.locked()[found.mesh.vertices()].any()


def test_a_structured_mesh_stays_as_it_is(policies):
    mesh = grid("quad", 400)
    found = improve(mesh, policies["quad"], Wishes(keep_size=True), rollouts=2)
    assert found.mesh.n_elements == 400 and found.rollouts == 0
    assert np.array_equal(found.mesh.points, mesh.points)
    assert "there already" in found.reason


def test_every_element_gets_the_wanted_shape(policies):
    mesh = mesh_domain(shape("l-shape"), "quad")
    found = improve(mesh, policies["quad"], Wishes(elements_shape=0.6), rollouts=4)
    assert element_shapes(found.mesh).min() >= 0.6
    assert found.mesh.score == found.mesh.optimum


@pytest.mark.parametrize(
    ("worst", "over", "elements"), [(1.0, False, 3), (1.0, True, 27), (0.2, False, 27)]
)
def test_of_several_answers_the_one_counts_that_takes_the_fewest_elements(worst, over, elements):
    """A long quad cut lengthwise takes more than the quad itself, which may have a worse corner."""
    whole = HalfEdgeMesh.from_elements([(0, 0), (10, 0), (10, 1), (0, 1)], [[0, 1, 2, 3]])
    cut = divided(whole, np.array([1, 3]))
    answer = Solution(
        [], 0, 0, 0, elements=3, worst_scaled_jacobian=1.0, aims=Preference().aims(1.0, 1.0)
    )
    other = replace(answer, elements=1, worst_scaled_jacobian=worst)
    best, mesh, fault = _divided_for([(answer, cut), (other, whole)], 0.5, lambda: over)
    assert (best is other) == (elements == 3)
    assert (mesh.n_elements, fault) == (elements, "")
    assert element_shapes(mesh).min() >= 0.5


@pytest.mark.parametrize("wishes", [Wishes(), Wishes(keep_size=True)])
def test_with_a_number_of_rollouts_the_clock_does_not_matter(policies, wishes, monkeypatch):
    mesh = mesh_domain(shape("star"), "quad", max_edge=0.3)
    first = improve(mesh, policies["quad"], wishes, rollouts=1, seed=7).mesh
    clock = time.perf_counter
    monkeypatch.setattr(time, "perf_counter", lambda: 1000.0 * clock())
    second = improve(mesh, policies["quad"], wishes, rollouts=1, seed=7).mesh
    assert np.array_equal(first.elements(), second.elements())
    assert np.array_equal(first.points, second.points)


def test_wishes_that_cannot_be_are_refused():
    for bad in ({"prefer": "few"}, {"min_shape": 2.0}, {"elements_shape": 1.0}):
        with pytest.raises(ValueError, match="must"):
            Wishes(**bad)
    with pytest.raises(ValueError, match="keep their size"):
        Wishes(keep_size=True, elements_shape=0.3)
