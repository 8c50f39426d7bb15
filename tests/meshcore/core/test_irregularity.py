"""Desired degrees: equation 2, and the sum rule where regions meet."""

import numpy as np
import pytest

from meshwright_core.core.irregularity import (
    desired_between,
    desired_on_boundary,
    usual_desired_degree,
)


@pytest.mark.parametrize("k", [3, 4])
@pytest.mark.parametrize("angle", [5.0, 44.0, 90.0, 135.0, 180.0, 270.0, 355.0])
def test_one_sector_on_the_boundary_is_equation_2(k, angle):
    assert (
        desired_between([angle], k, boundary=True) == desired_on_boundary(np.array([angle]), k)[0]
    )


def test_straight_sides_and_interfaces_have_the_usual_degrees():
    for k in (3, 4):
        assert desired_between([180.0], k, boundary=True) == usual_desired_degree(k, True)
        assert desired_between([180.0, 180.0], k, boundary=False) == usual_desired_degree(k, False)


@pytest.mark.parametrize(
    ("angles", "boundary", "quads", "triangles"),
    [
        ([90.0, 90.0], True, 3, 5),
        ([90.0, 180.0], True, 4, 6),
        ([20.0, 20.0, 140.0], True, 5, 5),
        ([120.0, 120.0, 120.0], False, 3, 6),
        ([90.0, 270.0], False, 4, 7),
        ([10.0, 350.0], False, 5, 7),
    ],
)
def test_sum_rule(angles, boundary, quads, triangles):
    assert desired_between(angles, 4, boundary) == quads
    assert desired_between(angles, 3, boundary) == triangles
