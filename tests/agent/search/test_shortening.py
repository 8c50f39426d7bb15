"""Shortened operations are never more, lead to the same s, and can be replayed."""

import time

import numpy as np
import pytest
from replay import replayed

from meshwright_agent.search.annealing import anneal
from meshwright_agent.search.shortening import shorten, without_loops
from meshwright_core.domains.meshing import benchmark_mesh


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.slow
def test_operations_of_annealing_become_much_fewer_at_equal_s(kind, seed):
    mesh = benchmark_mesh(kind, 12, np.random.default_rng(seed))
    operations, score = anneal(mesh, proposals=100_000, seed=seed)
    long = replayed(mesh, operations)
    short = shorten(mesh, operations, seconds=5.0)
    after = replayed(mesh, short)
    assert len(short) < 0.8 * len(operations)
    assert after.score <= score
    assert after.n_elements <= long.n_elements
    assert after.optimum == mesh.optimum


def test_an_operation_and_its_inverse_are_left_out():
    mesh = benchmark_mesh("quad", 8, np.random.default_rng(1))
    h = next(h for h in range(4 * mesh.n_elements) if mesh.check("flip_left", h))
    assert shorten(mesh, [("flip_left", h), ("flip_right", h)]) == []


def test_an_unneeded_split_is_left_out_although_later_ids_depend_on_it():
    mesh = benchmark_mesh("tri", 10, np.random.default_rng(3))
    noisy = [("split", next(h for h in range(9, 90) if mesh.twin(h) >= 0))]
    copy = replayed(mesh, noisy)
    more, _ = anneal(copy, proposals=100_000, seed=0)
    whole = noisy + more
    short = shorten(mesh, whole, seconds=5.0)
    assert len(short) < len(whole)
    assert replayed(mesh, short).score <= replayed(mesh, whole).score


@pytest.mark.slow
def test_sixty_operations_are_shortened_quickly():
    mesh = benchmark_mesh("tri", 20, np.random.default_rng(0))
    operations, _ = anneal(mesh, proposals=40_000, seed=0)
    shorten(mesh, operations[:60])
    began = time.process_time()
    shorten(mesh, operations[:60], seconds=5.0)
    assert time.process_time() - began < 0.3


def test_a_cancelled_shortening_returns_valid_operations():
    mesh = benchmark_mesh("quad", 20, np.random.default_rng(0))
    operations, score = anneal(mesh, proposals=100_000, seed=0)
    assert replayed(mesh, shorten(mesh, operations, cancelled=lambda: True)).score <= score


def test_operations_that_do_not_replay_are_refused():
    mesh = benchmark_mesh("quad", 8, np.random.default_rng(1))
    with pytest.raises(ValueError, match="operation 0, flip_left at half-edge 100000"):
        shorten(mesh, [("flip_left", 100_000)])


def test_loops_are_cut_at_the_last_return():
    states = np.array([1, 2, 3, 2, 4, 1, 5, 6])
    assert without_loops(states).tolist() == [5, 6]
    assert without_loops(np.array([1, 2, 3])).tolist() == [0, 1]
    assert without_loops(np.array([1, 2, 1])).tolist() == []
