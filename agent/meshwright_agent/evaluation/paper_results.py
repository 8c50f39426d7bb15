"""The results that the paper reports (sections 5.1 and 5.2), for comparison with ours."""

from __future__ import annotations

from typing import NamedTuple


class Measured(NamedTuple):
    """A normalised return over 100 random polygons."""

    mean: float
    deviation: float


class Row(NamedTuple):
    """What the paper gives for polygons of so many sides, a closed range."""

    sides: tuple[int, int]
    best: Measured
    """Of the best of ten rollouts."""
    single: Measured | None = None
    """Of one rollout, where the paper gives it."""


ROWS = {
    "tri": (
        Row((3, 10), Measured(0.83, 0.19)),
        Row((10, 20), Measured(0.87, 0.08)),
        Row((20, 30), Measured(0.83, 0.10)),
        Row((30, 40), Measured(0.78, 0.08)),
        Row((40, 50), Measured(0.75, 0.07)),
        Row((10, 30), Measured(0.86, 0.08), Measured(0.81, 0.11)),
    ),
    "quad": (
        Row((10, 20), Measured(0.98, 0.03)),
        Row((20, 30), Measured(0.97, 0.06)),
        Row((30, 40), Measured(0.94, 0.14)),
        Row((40, 50), Measured(0.91, 0.13)),
        Row((10, 30), Measured(0.992, 0.02), Measured(0.95, 0.05)),
    ),
}
"""The rows of its tables, and last what its text says of the polygons it trains on."""


def row(kind: str, sides: tuple[int, int]) -> Row | None:
    """The paper's row for exactly these sides, if it has one."""
    return next((row for row in ROWS[kind] if row.sides == sides), None)


def single(kind: str) -> float:
    """Mean normalised return of a single rollout, 10 to 30 sides."""
    last = ROWS[kind][-1]
    assert last.single is not None
    return last.single.mean
