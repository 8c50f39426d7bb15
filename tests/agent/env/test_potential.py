"""Potentials point towards irregular vertices, at a bounded cost, and scratch arrays are reset."""

import numpy as np
import pytest

from meshwright_agent.env.potential import (
    NEIGHBOURHOOD,
    SCREENING,
    SWEEPS,
    as_feature,
    field,
    forget,
    solve_potential,
)
from meshwright_core.domains.meshing import benchmark_mesh, grid


def _potentials(mesh, near=-1):
    """Both potentials by vertex id, NaN where there is none, and the elements looked at."""
    arrays = mesh.arrays
    solved = field(len(arrays.vertex))
    listed = solve_potential(arrays, mesh.k, np.array([near]), solved)
    values = np.full((len(arrays.vertex), 2), np.nan)
    numbered = solved.place_of > 0
    values[numbered] = solved.value[solved.place_of[numbered] - 1]
    forget(arrays, mesh.k, solved, listed)
    assert not solved.place_of.any() and not arrays.element_mark.any()
    return values, listed


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_potentials_are_the_jacobi_iteration_of_the_screened_poisson_problem(kind):
    mesh = benchmark_mesh(kind, 12, np.random.default_rng(4))
    values, _ = _potentials(mesh)
    count = mesh.n_vertices
    graph = np.zeros((count, count))
    for v in range(count):
        graph[v, mesh.neighbours(v)] = 1.0
    delta = mesh.irregularity()[:count].astype(float)
    expected = np.zeros((count, 2))
    for _ in range(SWEEPS):
        charges = np.column_stack([delta, np.abs(delta)])
        expected = (charges + graph @ expected) / (graph.sum(axis=1) + SCREENING)[:, None]
    np.testing.assert_allclose(values[:count], expected, rtol=1e-4, atol=1e-5)


def test_potentials_of_a_regular_mesh_and_of_a_pair_of_opposite_sign():
    mesh = grid("quad", 64)
    assert np.all(_potentials(mesh)[0][mesh.vertices()] == 0.0)
    mesh.apply("flip_left", 4 * 27 + 1)
    plus, minus = mesh.irregularity().argmax(), mesh.irregularity().argmin()
    values = _potentials(mesh)[0]
    assert values[plus, 0] > 0.0 > values[minus, 0]
    assert values[plus, 1] > 0.0 and values[minus, 1] > 0.0


def test_on_a_large_mesh_potentials_use_a_bounded_neighbourhood():
    mesh = grid("quad", 3600)
    near = mesh.outgoing(61 * 30 + 30)[0]
    mesh.apply("flip_left", near)
    values, listed = _potentials(mesh, near)
    assert listed == NEIGHBOURHOOD
    assert np.nanmax(values[:, 0]) > 0.1
    assert np.isnan(values[0, 0])  # a corner, far away


def test_features_keep_sign_and_order():
    given = np.array([-9.0, -1.0, -0.01, 0.0, 0.004, 0.1, 1.0, 4.0, 99.0])
    features = [as_feature(value) for value in given]
    assert features == sorted(features)
    assert features[3] == 0.0 and features[4] > 0.0 and features[2] < 0.0
    assert min(features) >= -127 and max(features) <= 127
