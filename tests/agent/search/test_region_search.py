"""A search within a region lowers s there and leaves the rest of the mesh unchanged."""

import threading

import numpy as np
import pytest

from meshwright_agent.policy import policy_files
from meshwright_agent.policy.policy_files import PolicyError
from meshwright_agent.search.region_search import KEEP, solve_within
from meshwright_core import MeshError
from meshwright_core.analysis.submesh import enclose, temporarily_locked
from meshwright_core.core.arrays import ORIGIN
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry.movable_part import rings
from meshwright_core.geometry.smoothing import relax

pytestmark = pytest.mark.slow


@pytest.fixture(params=["quad", "tri"])
def case(request):
    """A policy, a mesh, and a region around an irregular vertex in its middle."""
    domain = gallery.random_polygon(16, np.random.default_rng(7))
    mesh = meshing.mesh_domain(domain, request.param, max_edge=0.14)
    return policy_files.load(request.param), mesh, region(mesh, 3)


def region(mesh, reach):
    irregular = np.flatnonzero(mesh.irregularity())
    centre = mesh.points[mesh.vertices()].mean(axis=0)
    away = np.linalg.norm(mesh.points[irregular] - centre, axis=1)
    chosen = rings(mesh, irregular[[int(away.argmin())]], reach)
    return mesh.element_ids()[np.isin(mesh.elements(), chosen).all(axis=1)]


def outside_of(mesh, elements):
    """Ends and twins of the half-edges outside, but for twins that lie in the region."""
    kept = np.setdiff1d(mesh.element_ids(), elements)
    halfedges = mesh.halfedges_of(kept).ravel()
    return halfedges, mesh.arrays.edge[halfedges, ORIGIN].copy()


def test_operations_replay_lower_s_and_leave_the_rest_unchanged(case):
    policy, mesh, elements = case
    before, copy = mesh.elements(), mesh.copy()
    found = solve_within(mesh, policy, elements, rollouts=3, seed=1)
    assert np.array_equal(before, mesh.elements()) and not mesh.locked().any()
    assert found.optimum <= found.score < mesh.score
    halfedges, ends = outside_of(copy, elements)
    inside = enclose(copy, elements)
    places = copy.points[inside.held].copy()
    with temporarily_locked(copy, inside.held):
        for operation, h in found.operations:
            copy.apply(operation, h)
    assert copy.score == found.score
    assert np.array_equal(copy.arrays.edge[halfedges, ORIGIN], ends)
    assert np.array_equal(copy.points[inside.held], places)
    outside = mesh.n_elements - len(inside.elements)
    assert copy.n_elements - outside >= KEEP * len(inside.elements)
    assert len(relax(copy, around=np.setdiff1d(copy.vertices(), inside.held))) == 0
    copy.validate()


def test_a_search_ends_early_at_the_lower_bound():
    mesh = meshing.grid("quad", 64)
    h = 4 * 27
    mesh.apply("flip_left", h)
    elements = mesh.element_ids()
    found = solve_within(mesh, policy_files.load("quad"), elements, seconds=20.0)
    assert found.score == found.optimum == 0 and found.seconds < 10.0
    again = mesh.copy()
    for operation, at in found.operations:
        again.apply(operation, at)
    assert again.score == 0


def test_a_very_irregular_region_is_improved_patch_by_patch(monkeypatch):
    mesh = meshing.mesh_domain(gallery.shape("gear"), "tri", max_edge=0.07)
    elements = region(mesh, 9)
    monkeypatch.setattr("meshwright_agent.search.region_search.MANY", 8)
    halfedges, ends = outside_of(mesh, elements)
    found = solve_within(mesh, policy_files.load("tri"), elements, rollouts=2, seed=2)
    assert found.score < mesh.score
    inside = enclose(mesh, elements)
    with temporarily_locked(mesh, inside.held):
        for operation, h in found.operations:
            mesh.apply(operation, h)
    assert mesh.score == found.score
    assert np.array_equal(mesh.arrays.edge[halfedges, ORIGIN], ends)
    mesh.validate()


def test_it_reports_progress_and_stops_when_cancelled(case):
    policy, mesh, elements = case
    reported = []
    found = solve_within(
        mesh, policy, elements, rollouts=32, seed=3, progress=lambda *a: reported.append(a)
    )
    assert reported[-1][0] == found.rollouts <= 32
    assert found.score <= reported[-1][1] <= mesh.score
    enough = threading.Event()
    enough.set()
    stopped = solve_within(mesh, policy, elements, seconds=60.0, cancelled=enough.is_set)
    assert stopped.operations == [] and stopped.score == mesh.score


def test_wrong_arguments_are_refused(case):
    policy, mesh, elements = case
    with pytest.raises(MeshError, match="No vertex lies inside"):
        solve_within(mesh, policy, elements[:1])
    other = policy_files.load("tri" if mesh.kind == "quad" else "quad")
    with pytest.raises(PolicyError):
        solve_within(mesh, other, elements)
