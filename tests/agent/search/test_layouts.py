"""Layouts: guarded coarsening, local search, and the solver that chooses by use."""

import numpy as np
import pytest

from meshwright_agent.policy import policy_files
from meshwright_agent.search import guarded_coarsening
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.guarded_coarsening import Aims, Coarsener
from meshwright_agent.search.layout_search import PATIENCE, STALE_ABOVE, LayoutSearch, Preference
from meshwright_agent.search.shortening import shorten
from meshwright_agent.search.solver import prepare, solve
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.domains.random_parts import random_part
from meshwright_core.geometry import quality
from meshwright_core.geometry.shape_bound import attainable_bound, shape_bound
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import Operation


@pytest.fixture(scope="module")
def policy():
    policy = policy_files.load(policy_files.shipped("quad")[0])
    prepare(policy)
    return policy


def part(corners=14, seed=3, holes=False):
    return mesh_domain(random_part(corners, np.random.default_rng(seed), holes), "quad")


def never():
    return False


@pytest.mark.parametrize("prefer", ["blocks", "balanced", "shape"])
def test_coarsening_under_the_guard_replays_and_stays_valid(prefer):
    mesh = part()
    search = LayoutSearch(mesh, Preference(prefer), seed=1)
    search.add([], False, never)
    before = search.best.key.copy()
    search.pool.clear()
    search.add([], True, never)
    search.run(never, kicks=20)
    s, worst, squares, elements = search.best.key
    assert s <= before[0] and worst > 0.0 and elements < before[3]
    reached = replayed(mesh, search.best.operations())
    assert (reached.score, reached.n_elements) == (s, elements)
    assert (reached.irregularity() ** 2).sum() == squares
    reached.move(*search.coarsener.positions(search.best))
    reached.validate()
    assert not len(quality.inverted(reached))
    assert quality.scaled_jacobian(reached).min() == pytest.approx(worst, abs=1e-6)


def test_coarsening_goes_on_where_it_stopped(monkeypatch):
    """With few elements between two looks at the clock a pass over all strips still ends."""
    monkeypatch.setattr(guarded_coarsening, "SLICE", 1)
    looks = []
    search = LayoutSearch(part(), Preference("blocks"), seed=1)
    search.add([], True, lambda: len(looks) > 5000 or looks.append(0))
    assert len(looks) < 5000
    few = search.best.copy()
    search.coarsener.coarsen(few)
    assert few.key[3] == search.best.key[3] < part().n_elements


def test_a_long_strip_is_cut_until_its_elements_are_good():
    mesh = HalfEdgeMesh.from_elements([[0, 0], [20, 0], [20, 1], [0, 1]], [[0, 1, 2, 3]])
    coarsener = Coarsener(mesh, Aims(0.9, 0.9, 0.0, True), ceiling=20)
    layout = coarsener.layout([])
    assert layout.key[1] == pytest.approx(8 * 20 / 401)
    while coarsener.divided(layout, never):
        pass
    assert layout.key[1] >= 0.9
    assert layout.key[[0, 2, 3]].tolist() == [0, 0, 3]
    assert [operation for operation, _ in layout.operations()] == [Operation.DIVIDE_CHORD] * 2
    assert not coarsener.divided(coarsener.layout([]), lambda: True)


def test_shortening_can_keep_the_layout():
    mesh = part()
    search = LayoutSearch(mesh, Preference(), seed=1)
    search.add([], True, never)
    search.run(never, kicks=40)
    operations = search.best.operations()
    fewer = shorten(mesh, operations, seconds=None, slices=20, keep_layout=True)
    assert len(fewer) <= len(operations)
    a, b = replayed(mesh, operations), replayed(mesh, fewer)
    assert (a.score, a.n_elements) == (b.score, b.n_elements)
    assert sorted(a.degree()[a.vertices()]) == sorted(b.degree()[b.vertices()])


def test_the_same_number_of_rollouts_gives_the_same_answer(policy):
    mesh = part(14, 5, True)
    first, second = (solve(mesh, policy, rollouts=2, seed=4) for _ in range(2))
    assert first.operations == second.operations
    assert np.array_equal(first.positions, second.positions)


def test_above_the_optimum_other_starts_are_soon_asked_for_whatever_the_shape():
    """The first rollouts may come too late where the machine stands still for a while."""
    seeker = LayoutSearch(part(), Preference("blocks"))
    seeker.add([], False, never)
    assert seeker.best.key[0] > seeker.optimum and seeker.best.key[1] >= seeker.aims.target
    assert not seeker.needs_layouts
    seeker.idle = STALE_ABOVE
    assert seeker.needs_layouts
    seeker.idle = PATIENCE
    assert not seeker.exhausted


def test_an_answer_is_placed_as_it_was_judged(policy):
    mesh = part(16, 7)
    found = solve(mesh, policy, rollouts=4)
    found.replay(mesh)
    found.place(mesh)
    mesh.validate()
    assert found.inverted == 0 and found.score == found.optimum
    worst = float(quality.scaled_jacobian(mesh).min())
    assert found.worst_scaled_jacobian == pytest.approx(worst, abs=1e-9)
    assert found.shape_bound == shape_bound(mesh)
    assert worst <= found.attainable + 1e-6


@pytest.mark.slow
def test_preferences_trade_blocks_for_shape(policy):
    mesh = part(18, 11)
    blocks, shape = (solve(mesh, policy, rollouts=6, prefer=word) for word in ("blocks", "shape"))
    assert blocks.score == shape.score == mesh.optimum
    assert blocks.inverted == shape.inverted == 0
    assert blocks.elements <= shape.elements
    assert blocks.worst_scaled_jacobian <= shape.worst_scaled_jacobian + 1e-6


def test_words_and_numbers_of_preferences_are_checked():
    with pytest.raises(ValueError, match="prefer must be"):
        Preference("nice")
    with pytest.raises(ValueError, match="between 0 and 1"):
        Preference(min_shape=2.0)
    assert Preference("balanced").aims(1.0, 1.0).target == 0.5
    assert Preference(min_shape=0.7).aims(1.0, 1.0)[:2] == (0.7, 0.7)
    assert Preference("shape").aims(0.866, 1.0).target < attainable_bound(part()) + 1.0
