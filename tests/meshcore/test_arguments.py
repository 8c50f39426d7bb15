"""Checks of arguments, and the normalised return."""

import numpy as np
import pytest

from meshwright_core import MeshError
from meshwright_core.arguments import is_whole_number, whole_number
from meshwright_core.core.score import normalised_return


@pytest.mark.parametrize("value", [3, np.int32(3), np.uint8(3)])
def test_whole_numbers(value):
    assert is_whole_number(value)
    assert whole_number(value, 3, "count") == 3


@pytest.mark.parametrize("value", [True, np.bool_(True), 3.0, "3", None, 2])
def test_what_is_no_whole_number_of_at_least_three(value):
    with pytest.raises(MeshError, match="count is a whole number of at least 3, not "):
        whole_number(value, 3, "count")


def test_normalised_return_of_numbers_and_arrays():
    assert normalised_return(12, 8, 4) == 0.5
    assert normalised_return(4, 4, 4) == 1.0
    starts, best, optima = np.array([12, 12, 4]), np.array([8, 4, 4]), np.array([4, 4, 4])
    assert normalised_return(starts, best, optima).tolist() == [0.5, 1.0, 1.0]
