"""Patch-wise improvement that can be drawn at every moment, and the time that it takes."""

import itertools
import math
import time

import numpy as np
import pytest

from meshwright_agent.policy.policy_files import load
from meshwright_agent.search import drawn_patches
from meshwright_agent.search.drawn_patches import improve_drawn
from meshwright_agent.search.patchwise import is_large
from meshwright_agent.search.solver import prepare, solve
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry.quality import inverted

TICK = 0.02


@pytest.fixture(scope="module")
def policy():
    made = load("quad")
    prepare(made)
    return made


@pytest.fixture(scope="module")
def star():
    """Some 1,300 quads with more than 500 irregular vertices."""
    mesh = meshing.mesh_domain(gallery.shape("star"), "quad", 0.06)
    assert is_large(mesh) and not len(inverted(mesh))
    return mesh


@pytest.fixture
def clock(monkeypatch):
    """Time that passes only when somebody looks at the clock: a fiftieth of a second each time."""
    looks = itertools.count()
    monkeypatch.setattr(time, "perf_counter", lambda: next(looks) * TICK)
    return lambda: next(looks) * TICK


def test_every_slice_leaves_a_mesh_without_inverted_elements(policy, star, clock, monkeypatch):
    monkeypatch.setattr(drawn_patches, "UNITS", 0.0)
    monkeypatch.setattr(drawn_patches, "OVERHEAD", 0.0)
    seen = []
    run = improve_drawn(
        star, policy, slice_seconds=0.1, left=lambda: 9.0 * (len(seen) < 3), progress=seen.append
    )
    assert len(seen) > 1 and seen == sorted(seen, reverse=True)
    assert run.mesh.score == seen[-1] < star.score and not len(inverted(run.mesh))
    replay = star.copy()
    for operation, halfedge in run.operations:
        replay.apply(operation, halfedge)
    assert np.array_equal(replay.elements(), run.mesh.elements())


def test_what_cannot_be_drawn_is_taken_back_and_left_alone(policy, star, clock, monkeypatch):
    """Elements in the left half count as inverted once they have changed."""
    before = {tuple(sorted(row)) for row in star.elements().tolist()}

    def changed_on_the_left(mesh):
        rows = mesh.elements()
        left = mesh.points[rows, 0].mean(axis=1) < -0.3
        new = np.array([tuple(sorted(row)) not in before for row in rows.tolist()])
        return mesh.element_ids()[left & new]

    monkeypatch.setattr(drawn_patches, "inverted", changed_on_the_left)
    monkeypatch.setattr(drawn_patches, "UNITS", 0.0)
    monkeypatch.setattr(drawn_patches, "OVERHEAD", 0.0)
    seen = []
    run = improve_drawn(
        star, policy, slice_seconds=0.1, left=lambda: 9.0 * (len(seen) < 4), progress=seen.append
    )
    assert run.mesh.score < star.score and not len(changed_on_the_left(run.mesh))


def test_without_a_time_limit_it_ends_by_itself(policy, star):
    run = improve_drawn(star, policy, slice_seconds=None, left=lambda: math.inf, max_steps=300)
    assert run.reason and run.mesh.score < star.score and not len(inverted(run.mesh))


def test_a_search_on_a_large_mesh_keeps_to_its_time(policy, star, clock):
    seconds = 1.0
    began = clock()
    found = solve(star, policy, seconds=seconds)
    assert clock() - began <= 1.2 * seconds + 1.0
    assert found.score < star.score and not found.inverted
    reached = star.copy()
    assert found.carry_out(reached)
