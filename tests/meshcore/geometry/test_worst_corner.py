"""Max-min positions: gradients against differences, the worst corner, nothing ever inverts."""

import numpy as np
import pytest

from meshwright_core.curves.curve import Curve
from meshwright_core.domains import gallery
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry import layout_positions as positions
from meshwright_core.geometry.bent_elements import COUNT, PLACES, QUARTERS, BentElements, find_bent
from meshwright_core.geometry.worst_corner import LayoutProblem, _objective, terms


def problem_of(mesh):
    rails = positions.rails_of(mesh, len(mesh.arrays.vertex))
    *fields, x, elements = positions.assemble(mesh.arrays, rails, False, np.zeros(0, np.bool_))
    variable = LayoutProblem._fields.index("variable")
    rows, *sides = find_bent(mesh.arrays, rails.turning, fields[variable], x, elements)
    scale = fields[-1][4 * rows]
    b = len(rows)
    bent = BentElements(
        QUARTERS, np.array([COUNT]), *sides, scale, np.zeros((b, 4, PLACES, 6)),
        np.zeros((b, COUNT, 4)),
        np.zeros((b, COUNT, 4)), np.zeros((b, 4, 2)),
    )  # fmt: skip
    return LayoutProblem(*fields, bent, mesh.arrays.curves), x.copy()


def round_hole():
    square = [Curve.line(a, b) for a, b in (
        ((0, 0), (3, 0)), ((3, 0), (3, 2)), ((3, 2), (0, 2)), ((0, 2), (0, 0)),
    )]  # fmt: skip
    domain = Domain.from_curves([square, [Curve.arc((1.4, 1.0), 0.4, 0.3, 2 * np.pi)]])
    return mesh_domain(domain, "quad")


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
