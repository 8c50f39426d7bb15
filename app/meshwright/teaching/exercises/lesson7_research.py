"""Checks of lesson 7: measuring policies."""

from __future__ import annotations

from typing import Any

from meshwright.experiments.comparison import Comparison
from meshwright.teaching.exercises.answer_parsing import (
    letters,
    quoted,
    require,
    result_of,
    whole_number,
)
from meshwright.teaching.exercises.exercise import WrongAnswer, declare

POLICY = "quad-paper"
PAIRS = (0.9 + 1.0 + 1.0) / 3.0


@declare("7.1", "What was gained, relative to the most that can be gained?")
def normalised(function: object) -> str:
    """The normalised return."""
    for start, best, optimum in ((37, 4, 1), (12, 12, 4), (12, 4, 4), (10, 5, 0)):
        found = _number(result_of(function, start, best, optimum))
        wanted = (start - best) / (start - optimum)
        require(
            abs(found - wanted) < 1e-6,
            f"From s = {start} to {best} with s* = {optimum} it returns {found:.4g}. A run that "
            "gains nothing has 0, one that reaches s* has 1.",
        )
    return "0 for a run that gains nothing and 1 at the optimum, for meshes of any size."


@declare("7.2", "both.rollout_rows has a row for each run, with best and optimum in it.")
def share_at_optimum(answer: object, both: object) -> str:
    """The share of a policy's runs that reach the optimum."""
    found = _number(answer)
    if not isinstance(both, Comparison) or POLICY not in both.rollouts:
        raise WrongAnswer("Give the comparison as well: check(share, both).")
    runs = both.rollouts[POLICY]
    hits = sum(run.best == run.optimum for run in runs)
    wanted = hits / len(runs)
    require(
        abs(found - hits) > 1e-9 or hits in (0, len(runs)),
        "That many runs there are; what share of all is it?",
    )
    every = [run for rows in both.rollouts.values() for run in rows]
    mixed = sum(run.best == run.optimum for run in every) / len(every)
    require(
        abs(found - mixed) > 1e-9 or mixed == wanted,
        f"That is the share among the runs of all policies; take those of `{POLICY}`.",
    )
    require(
        abs(found - wanted) < 1e-6,
        f"A run counts if its best is its optimum; there are {len(runs)} runs of `{POLICY}`.",
    )
    return f"{hits} of {len(runs)} single runs make it, and the best of all of them does."


@declare("7.3", "There are three ways to choose two of the three. What is the better of each pair?")
def best_of_two(answer: object) -> str:
    """The expected best of two among 0.9, 0.9, 1.0."""
    found = _number(answer)
    require(abs(found - 1.0) > 1e-6, "That is the best of all three.")
    require(
        abs(found - 0.95) > 1e-6, "The pairs are not equally good: two of the three have the 1."
    )
    require(abs(found - 2.8 / 3.0) > 1e-3, "That is the mean of single rollouts.")
    require(
        abs(found - PAIRS) < 1e-3,
        "Write the three pairs down, and the larger number of each; then take the mean.",
    )
    return "0.9, 1 and 1: the mean is 0.967, and no fourth rollout was needed to know it."


@declare("7.4", "The standard error is the deviation divided by the square root of the number.")
def how_many_meshes(answer: object) -> str:
    """Meshes for a standard error of 0.003 where the deviation is 0.03."""
    n = whole_number(answer)
    require(n != 10, "Ten times smaller than the deviation: and the square root?")
    require(n == 100, "0.03 / sqrt(n) has to be 0.003. What is n?")
    return "100, as in the paper's tables. For one more digit it would take 10,000."


@declare("7.5", "In each of them ask: is there another reason than the policy?")
def fair(answer: object) -> str:
    """Which of four comparisons are fair."""
    found = letters(answer, "abcd")
    require("b" not in found, "In b one may have been given the easier polygons.")
    require("c" not in found, "In c one may try ten times: chance alone makes it look better.")
    require(found == {"a", "d"}, "One more of them is fair: look what is the same for both.")
    return "The same meshes, the same number of tries, or the same time: then it is the policy."


def _number(given: Any) -> float:
    """A number of any type as a float."""
    try:
        if isinstance(given, bool | str):
            raise TypeError
        return float(given)
    except (TypeError, ValueError):
        raise WrongAnswer(f"A number is expected here, not {quoted(given)}.") from None
