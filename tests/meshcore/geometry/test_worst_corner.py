"""Max-min positions: gradients against differences, the worst corner, nothing ever inverts."""

import numpy as np
import pytest
from layout_problems import problem_of, round_hole

from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.element_sines import THIN
from meshwright_core.geometry.layout_positions import position, rails_of
from meshwright_core.geometry.worst_corner import _objective, terms


def grid(x, y):
    """A grid of quads with vertices at the given coordinates."""
    points = np.array([(a, b, 0.0) for b in y for a in x])
    n = len(x)
    first = [j * n + i for j in range(len(y) - 1) for i in range(n - 1)]
    return HalfEdgeMesh.from_elements(points, [(v, v + 1, v + n + 1, v + n) for v in first])


@pytest.mark.parametrize(
    "mesh",
    [
        mesh_domain(gallery.shape("star"), "quad"),
        round_hole(),
        grid((0.0, 0.1, 1.0, 2.0), (0.0, 1.0, 1.9)),
    ],
)
@pytest.mark.parametrize("aim", [(16.0, 0.01, 1e3, 0.0), (16.0, 0.01, 0.2, 0.0), (0, 1, 1e3, 0.5)])
def test_gradients_agree_with_differences(mesh, aim):
    problem, x = problem_of(mesh)
    sines, gradient, spare = np.zeros(terms(problem)), np.zeros(len(x)), np.zeros(len(x))
    aim = np.array(aim, float)
    value, _ = _objective(problem, x, gradient, sines, aim)
    assert np.isfinite(value)
    step = 1e-6
    for i in range(len(x)):
        ends = []
        for way in (1, -1):
            moved = x.copy()
            moved[i] += way * step
            ends.append(_objective(problem, moved, spare, sines, aim)[0])
        assert gradient[i] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=2e-4, abs=2e-4)


def test_long_thin_elements_count_as_bad_ones():
    mesh = grid((0.0, 0.01, 1.0), (0.0, 0.02, 1.0))
    before = element_shapes(mesh).min()
    assert THIN * before < 0.2
    worst = position(mesh.arrays, rails_of(mesh, len(mesh.arrays.vertex)), 0.9, 100)
    assert worst >= 0.9 - 1e-6
    assert THIN * element_shapes(mesh).min() >= 0.9 - 1e-6
