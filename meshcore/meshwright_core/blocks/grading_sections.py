"""A graded line as sections of constant growth, as block formats describe it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

_ALIKE = 1e-6
"""Relative difference of two ratios of growth up to which they count as one."""


class Section(NamedTuple):
    """A part of a line."""

    share: float
    """Of the length of the line."""
    cells: int
    ratio: float
    """From each cell to the next; 1 for a single cell."""


def sections(sizes: np.ndarray) -> list[Section]:
    """The fewest sections of cells with these sizes (n,), from the first cell on."""
    ratio = sizes[1:] / sizes[:-1]
    found, start = [], 0
    while start < len(sizes):
        stop = start + 1
        while stop < len(sizes) and abs(ratio[stop - 1] / ratio[start] - 1.0) <= _ALIKE:
            stop += 1
        if stop - start == 2 and stop < len(sizes) and abs(ratio[stop - 1] - 1.0) <= _ALIKE:
            stop -= 1  # the second one begins a section of equal cells
        part = sizes[start:stop]
        growth = float(ratio[start]) if stop - start > 1 else 1.0
        if abs(growth - 1.0) <= _ALIKE:
            growth = 1.0
        found.append(Section(float(part.sum() / sizes.sum()), stop - start, growth))
        start = stop
    return found
