"""What is derived from the score s (equation 1) and its lower bound s* (equation 3)."""

from __future__ import annotations

from typing import overload

import numpy as np


@overload
def normalised_return(start: int, best: int, optimum: int) -> float: ...
@overload
def normalised_return(start: np.ndarray, best: np.ndarray, optimum: np.ndarray) -> np.ndarray: ...
def normalised_return(
    start: int | np.ndarray, best: int | np.ndarray, optimum: int | np.ndarray
) -> float | np.ndarray:
    """The undiscounted normalised return (equation 6), (s - s_best) / (s - s*).

    1 at the optimum, 0 without progress; 1 too where the start is at the optimum already, and below
    it, where no mesh is valid.

    Args:
        start: s at the start, a number or an array.
        best: the lowest s reached, of the same shape.
        optimum: s*, of the same shape.
    """
    if isinstance(start, np.ndarray):
        # the maximum only matters where both differences are zero
        left = np.maximum(best - optimum, 0)
        result: np.ndarray = 1.0 - left / np.maximum(start - optimum, 1)
        return result
    if min(start, best) <= optimum:
        return 1.0
    return float(1.0 - (best - optimum) / (start - optimum))
