"""The results that the paper reports (sections 5.1 and 5.2), for comparison with ours."""

from __future__ import annotations

from typing import NamedTuple


class ReturnStatistics(NamedTuple):
    """Statistics of the normalised return over 100 random polygons."""

    mean: float
    deviation: float


class PaperRow(NamedTuple):
    """The results of the paper for polygons with so many sides, a closed range."""

    sides: tuple[int, int]
    best: ReturnStatistics
    """The best of ten rollouts."""
    single: ReturnStatistics | None = None
    """A single rollout, if the paper reports it."""


ROWS = {
    "tri": (
        PaperRow((3, 10), ReturnStatistics(0.83, 0.19)),
        PaperRow((10, 20), ReturnStatistics(0.87, 0.08)),
        PaperRow((20, 30), ReturnStatistics(0.83, 0.10)),
        PaperRow((30, 40), ReturnStatistics(0.78, 0.08)),
        PaperRow((40, 50), ReturnStatistics(0.75, 0.07)),
        PaperRow((10, 30), ReturnStatistics(0.86, 0.08), ReturnStatistics(0.81, 0.11)),
    ),
    "quad": (
        PaperRow((10, 20), ReturnStatistics(0.98, 0.03)),
        PaperRow((20, 30), ReturnStatistics(0.97, 0.06)),
        PaperRow((30, 40), ReturnStatistics(0.94, 0.14)),
        PaperRow((40, 50), ReturnStatistics(0.91, 0.13)),
        PaperRow((10, 30), ReturnStatistics(0.992, 0.02), ReturnStatistics(0.95, 0.05)),
    ),
}
"""The rows of the paper's tables; last, from its text, the range of sides used in training."""


def row(kind: str, sides: tuple[int, int]) -> PaperRow | None:
    """The paper's row for exactly these sides, if it has one."""
    return next((row for row in ROWS[kind] if row.sides == sides), None)


def single(kind: str) -> float:
    """Mean normalised return of a single rollout, 10 to 30 sides."""
    last = ROWS[kind][-1]
    assert last.single is not None
    return last.single.mean
