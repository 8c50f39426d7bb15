"""Numbers of pieces of chords: against trying all, and with conditions."""

from itertools import product

import numpy as np
import pytest

from meshwright_core.analysis.chord_counts import Sum, chord_counts, counts_for_total
from meshwright_core.errors import MeshError


def cost(counts, chord, wanted):
    n = np.asarray(counts, float)[chord]
    return float((np.maximum(n / wanted, wanted / n) - 1.0).sum())


def test_free_chords_are_the_best_of_all():
    rng = np.random.default_rng(3)
    for _ in range(20):
        chord = np.concatenate([np.arange(3), rng.integers(0, 3, 5)])
        wanted = rng.uniform(0.3, 6.0, len(chord))
        found = chord_counts(chord, wanted)
        best = min(product(range(1, 8), repeat=3), key=lambda n: cost(n, chord, wanted))
        assert cost(found, chord, wanted) == pytest.approx(cost(best, chord, wanted))


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        (Sum((0, 1), total=9), lambda n: n[0] + n[1] == 9),
        (Sum((0, 1, 1), like=(2,)), lambda n: n[0] + 2 * n[1] == n[2]),
        (Sum((0, 1, 2), even=True), lambda n: sum(n) % 2 == 0),
    ],
)
def test_conditions_are_met_at_the_least_cost(condition, holds):
    rng = np.random.default_rng(5)
    for _ in range(5):
        chord = np.array([0, 1, 2, 0, 2])
        wanted = rng.uniform(0.5, 7.0, 5)
        found = chord_counts(chord, wanted, sums=[condition])
        assert holds(found)
        fit = [n for n in product(range(1, 16), repeat=3) if holds(n)]
        least = min(cost(n, chord, wanted) for n in fit)
        assert cost(found, chord, wanted) == pytest.approx(least, abs=1e-6)


def test_given_numbers_and_lower_bounds():
    counts = chord_counts(
        np.array([0, 1, 2]), np.array([4.2, 1.1, 2.0]), least=np.array([1, 3, 1]), fixed={2: 7}
    )
    assert counts.tolist() == [4, 3, 7]


def test_a_number_of_elements_is_met_as_closely_as_possible():
    crossing = np.array([[0, 1], [0, 2], [3, 1]])
    chord, wanted = crossing.ravel(), np.array([1.0, 2.0, 1.0, 3.0, 1.5, 2.0])
    for total in (3, 40, 500, 12_345):
        counts = counts_for_total(crossing, chord, wanted, total)
        elements = int(counts[crossing].prod(axis=1).sum())
        assert 0.75 * total <= elements <= 1.25 * total


def test_what_cannot_be_is_said():
    with pytest.raises(MeshError, match="meet all conditions"):
        chord_counts(
            np.array([0, 1]), np.array([2.0, 2.0]),
            fixed={0: 2, 1: 3}, sums=[Sum((0,), like=(1,))],
        )  # fmt: skip
    with pytest.raises(MeshError, match="above 0"):
        chord_counts(np.array([0]), np.array([0.0]))
    with pytest.raises(MeshError, match="Every chord"):
        chord_counts(np.array([1]), np.array([2.0]))
    with pytest.raises(MeshError, match="Chord 0"):
        chord_counts(np.array([0]), np.array([2.0]), least=3, fixed={0: 2})
