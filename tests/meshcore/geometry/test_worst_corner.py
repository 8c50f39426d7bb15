"""Max-min positions: gradients against differences, the worst corner, nothing ever inverts."""

import numpy as np
import pytest
from layout_problems import problem_of, round_hole

from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.worst_corner import _objective, terms


@pytest.mark.parametrize("mesh", [mesh_domain(gallery.shape("star"), "quad"), round_hole()])
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
