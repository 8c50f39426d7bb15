"""Into how many pieces each chord is divided, by a small integer programme.

All edges of a chord get the same number of pieces, so the edges of one chord, which wish for
different numbers, have to agree, and so do the chords along a side whose total is given. An edge
that wishes for w pieces and gets n costs max(n / w, w / n) - 1, so that too many and too few count
alike; this is convex in n. Chords without conditions are independent, and the best number of each
is found directly; those with conditions are solved together by SciPy's `milp` (HiGHS). The problem
is the quantisation of Lyon, Campen and Kobbelt, *Quad layouts via constrained T-mesh quantization*
(2021), on a layout without T-junctions.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from meshwright_core.errors import MeshError

REACH = 8.0
"""How many times the largest wish, or the largest given total, a number may be."""
DENSE = 64
"""Numbers next to the best one between which the cost is exact; beyond, it is interpolated."""
SECONDS = 10.0
"""Time limit of the integer programme, after which the best solution found counts."""
_HALVINGS = 40


@dataclass(frozen=True)
class Sum:
    """A condition: the numbers of some chords add up.

    A chord that is named several times counts so often: that is how often it ends on a side.
    """

    chords: Sequence[int]
    total: int | None = None
    """To this number..."""
    like: Sequence[int] = ()
    """... or, if it is None, to the sum over these chords..."""
    even: bool = False
    """... or, if there are none either, to an even number."""


def chord_counts(
    chord: np.ndarray,
    wanted: np.ndarray,
    *,
    weight: np.ndarray | None = None,
    least: int | np.ndarray = 1,
    fixed: Mapping[int, int] | None = None,
    sums: Iterable[Sum] = (),
) -> np.ndarray:
    """(c,) int64 numbers of pieces of the chords, of least cost.

    Args:
        chord: (n,) the chord, from 0 to c - 1, of each edge or block side that has a wish; every
            chord has at least one. For the chords of a quad mesh:
            :func:`meshwright_core.analysis.element_division.chords`.
        wanted: (n,) pieces that each wishes for, real numbers above 0: the length of the edge, or
            its length measured in local sizes.
        weight: (n,) what each wish weighs; by default all the same.
        least: lower bound of all numbers, or (c,) one for each chord.
        fixed: numbers that are given, by chord.
        sums: conditions on several chords.

    Raises MeshError, one sentence, if arguments do not fit or no numbers meet the conditions.
    """
    chord, wanted = np.asarray(chord, np.int64), np.asarray(wanted, float)
    if not len(chord):
        return np.zeros(0, np.int64)
    number = int(chord.max()) + 1
    if chord.shape != wanted.shape or (np.bincount(chord, minlength=number) == 0).any():
        raise MeshError("Every chord needs a wanted number of pieces.")
    if not (np.isfinite(wanted).all() and (wanted > 0.0).all()):
        raise MeshError("A wanted number of pieces must be above 0.")
    weights = np.ones(len(chord)) if weight is None else np.asarray(weight, float)
    low = np.maximum(np.broadcast_to(np.asarray(least, np.int64), number), 1)
    low, high = low.copy(), np.full(number, np.iinfo(np.int64).max)
    for c, count in (fixed or {}).items():
        if count < low[c]:
            raise MeshError(f"Chord {c} cannot have fewer than {low[c]} pieces, and not {count}.")
        low[c] = high[c] = count
    cost = _Costs(chord, wanted, weights, number)
    counts = np.clip(cost.best(), low, high)
    conditions = list(sums)
    if conditions:
        return _together(cost, counts, (low, high), conditions)
    return counts


def counts_for_total(
    crossing: np.ndarray,
    chord: np.ndarray,
    wanted: np.ndarray,
    total: float,
    *,
    weight: np.ndarray | None = None,
    least: int | np.ndarray = 1,
) -> np.ndarray:
    """(c,) int64 numbers of pieces so that about `total` elements result: all wishes are scaled by
    one factor until the number of elements is as close to it as the whole numbers permit.

    crossing: (m, 2) the chords that cross each block; other arguments as in :func:`chord_counts`.
    """

    def counts_at(scale: float) -> np.ndarray:
        return chord_counts(chord, scale * wanted, weight=weight, least=least)

    def elements(counts: np.ndarray) -> int:
        return int(counts[crossing].prod(axis=1).sum())

    low, high = 0.0, 1.0
    while elements(counts_at(high)) < total and high < 2.0**_HALVINGS:
        low, high = high, 2.0 * high
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if elements(counts_at(middle)) < total:
            low = middle
        else:
            high = middle
    below, above = counts_at(max(low, 1e-9)), counts_at(high)
    near = total / max(elements(below), 1) < elements(above) / max(total, 1e-9)
    return below if near else above


class _Costs:
    """The cost of each number of pieces of each chord."""

    def __init__(
        self, chord: np.ndarray, wanted: np.ndarray, weight: np.ndarray, number: int
    ) -> None:
        order = np.argsort(chord, kind="stable")
        self._chord, self._wanted, self._weight = chord[order], wanted[order], weight[order]
        self._start = np.searchsorted(self._chord, np.arange(number))
        self.largest = np.maximum.reduceat(self._wanted, self._start)

    def of(self, counts: np.ndarray) -> np.ndarray:
        """(c,) the cost of one number (c,) for each chord."""
        n = counts[self._chord].astype(float)
        each = self._weight * (np.maximum(n / self._wanted, self._wanted / n) - 1.0)
        found: np.ndarray = np.add.reduceat(each, self._start)
        return found

    def at(self, c: int, counts: np.ndarray) -> np.ndarray:
        """(q,) the costs of several numbers (q,) for chord c."""
        stop = self._start[c + 1] if c + 1 < len(self._start) else len(self._chord)
        part = slice(self._start[c], stop)
        w, n = self._wanted[part][:, None], counts[None, :].astype(float)
        found: np.ndarray = self._weight[part] @ (np.maximum(n / w, w / n) - 1.0)
        return found

    def best(self) -> np.ndarray:
        """(c,) the number of least cost for each chord, at least 1: bisection on the difference,
        as the cost is convex.
        """
        low = np.ones(len(self._start), np.int64)
        high = np.maximum(np.ceil(self.largest).astype(np.int64), 1)
        while (low < high).any():
            middle = (low + high) // 2
            rising = self.of(middle + 1) >= self.of(middle)
            high = np.where(rising, middle, high)
            low = np.where(rising, low, np.minimum(middle + 1, high))
        return low


def _together(
    cost: _Costs,
    counts: np.ndarray,
    bounds: tuple[np.ndarray, np.ndarray],
    conditions: list[Sum],
) -> np.ndarray:
    """The numbers with conditions on some chords; the others keep `counts`.

    Variables: the number of each chord concerned, an integer, and how far it goes into each step of
    its cost, which is linear there; convexity fills the steps in their order. An even sum has half
    of it as one more integer.
    """
    # SciPy's parts take a second to import, and a notebook's widget needs them only for grids
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import coo_matrix

    low, high = bounds
    named = [c for one in conditions for c in (*one.chords, *one.like)]
    coupled = np.unique(np.array(named, np.int64))
    if len(coupled) and not (coupled[0] >= 0 and coupled[-1] < len(counts)):
        raise MeshError("A condition names a chord that there is not.")
    totals = [one.total or 0 for one in conditions]
    span = REACH * max(float(cost.largest[coupled].max(initial=1.0)), *totals, 1.0)
    place = {int(c): i for i, c in enumerate(coupled)}
    rows: list[int] = []
    columns: list[int] = []
    entries: list[float] = []
    right: list[float] = []
    prices, lower, upper, whole = [], [], [], []

    def enter(row: int, column: int, value: float) -> None:
        rows.append(row)
        columns.append(column)
        entries.append(value)

    for c in coupled:
        prices.append(0.0)
        lower.append(float(low[c]))
        upper.append(float(min(high[c], max(span, low[c]))))
        whole.append(1)
    for i, c in enumerate(coupled):
        stops = _stops(int(counts[c]), int(low[c]), int(upper[i]))
        values = cost.at(int(c), stops)
        enter(len(right), i, 1.0)
        for k in range(len(stops) - 1):
            width = float(stops[k + 1] - stops[k])
            enter(len(right), len(prices), -1.0)
            prices.append(float(values[k + 1] - values[k]) / width)
            lower.append(0.0)
            upper.append(width)
            whole.append(0)
        right.append(float(low[c]))
    for one in conditions:
        for c in one.chords:
            enter(len(right), place[int(c)], 1.0)
        for c in one.like if one.total is None else ():
            enter(len(right), place[int(c)], -1.0)
        if one.total is None and not len(one.like) and one.even:
            enter(len(right), len(prices), -2.0)
            prices.append(0.0)
            lower.append(0.0)
            upper.append(np.inf)
            whole.append(1)
        right.append(float(one.total or 0))
    matrix = coo_matrix((entries, (rows, columns)), (len(right), len(prices))).tocsr()
    solved = milp(
        np.array(prices), integrality=np.array(whole), bounds=Bounds(lower, upper),
        constraints=LinearConstraint(matrix, right, right), options={"time_limit": SECONDS},
    )  # fmt: skip
    if solved.x is None:
        raise MeshError("No numbers of pieces meet all conditions.")
    result = counts.copy()
    result[coupled] = np.rint(solved.x[: len(coupled)]).astype(np.int64)
    return result


def _stops(best: int, low: int, high: int) -> np.ndarray:
    """Ascending numbers from `low` to `high`: all near `best`, further apart beyond."""
    near = np.arange(max(low, best - DENSE), min(high, best + DENSE) + 1)
    far = np.unique(np.geomspace(max(low, 1), max(high, 1), DENSE).round().astype(np.int64))
    inside = far[(far > low) & (far < high)]
    return np.unique(np.concatenate([[low], near, inside, [high]])).astype(np.int64)
