"""Samples of elements with bending sides agree with the Coons maps of the quality measure."""

import numpy as np
import pytest
from layout_problems import problem_of, round_hole

from meshwright_core.core.arrays import CURVE
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.bent_elements import COUNT, QUARTERS, bent_sine
from meshwright_core.geometry.coons import SAMPLES
from meshwright_core.geometry.element_sines import worst_around
from meshwright_core.geometry.layout_positions import position, rails_of
from meshwright_core.geometry.quality import scaled_jacobian
from meshwright_core.geometry.worst_corner import place_layout, worst_sine


def stadium():
    """Half circles at both ends, so that tangents jump nowhere, and a corner at a kink."""
    sides = [
        Curve.line((0, 0), (2, 0)), Curve.arc((2, 0.5), 0.5, -np.pi / 2, np.pi),
        Curve.line((2, 1), (1, 1.4)), Curve.line((1, 1.4), (0, 1)),
        Curve.arc((0, 0.5), 0.5, np.pi / 2, np.pi),
    ]  # fmt: skip
    return mesh_domain(Domain.from_curves([sides]), "quad")


@pytest.mark.parametrize("make", [round_hole, stadium])
def test_samples_are_no_better_than_the_measure_and_close_to_it(make):
    mesh = make()
    problem, x = problem_of(mesh)
    place_layout(problem, x)
    assert len(problem.bent.vertices)
    rails = rails_of(mesh, mesh.slots)
    exact = worst_around(mesh.arrays, rails.turning, rails.gauge, np.zeros(0, np.bool_), -1.0)
    # the measure has twelve more samples, all of them inside
    assert exact - 1e-6 <= worst_sine(problem) <= exact + 0.1
    for b in range(len(problem.bent.vertices)):
        for s in range(COUNT):
            assert -1.0 <= bent_sine(problem.bent, b, s)[0] <= 1.0


def test_thirteen_of_the_samples_count_those_in_middles_first():
    assert QUARTERS.node.shape == (COUNT, 4)
    assert (QUARTERS.node[:5] % 2 == 0).all()
    assert (QUARTERS.node[5:] % 2 == 1).any(axis=1).all()
    assert len(SAMPLES[4].node) == COUNT + 12  # four corners and eight inside


def test_positions_unfold_what_the_corners_alone_do_not_show():
    mesh = round_hole()
    free = mesh.vertices()[mesh.arrays.vertex[mesh.vertices(), CURVE] < 0]
    rng = np.random.default_rng(5)
    places = mesh.points[free].copy()
    places[:, :2] += 0.4 * rng.standard_normal((len(free), 2))
    mesh.move(free, places)
    assert scaled_jacobian(mesh).min() < 0.0
    worst = position(mesh.arrays, rails_of(mesh, mesh.slots), 0.3, 25)
    assert worst > 0.0
    assert scaled_jacobian(mesh).min() >= worst - 1e-9
