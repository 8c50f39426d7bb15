"""Checks of lesson 2: Gauss-Bonnet, and the bound s*."""

from __future__ import annotations

from meshwright.teaching.exercises.answer_parsing import (
    edited_mesh,
    letters,
    require,
    result_of,
    whole_number,
)
from meshwright.teaching.exercises.exercise import WrongAnswer, declare

ANGLES = {90: 2, 180: 3, 270: 4, 60: 2, 120: 2, 150: 3, 240: 4, 350: 5, 45.17: 2, 242.83: 4, 20: 2}
"""Desired degree in quads by the angle in degrees; none is half-way between two."""
HALVES = {225: 4, 135: 3, 45: 2, 315: 5}
"""The same for angles half-way between two, which are rounded up."""


@declare("2.1", "The sum was -4 before the flip. Predict it, then look.")
def sum_after_flip(answer: object) -> str:
    """The sum of Delta of the star after a flip."""
    n = whole_number(answer)
    require(n != 4, "Mind the sign: the star has too few edges, not too many.")
    require(
        n == -4,
        "A flip takes an edge from two vertices and gives it to two others. What does that do "
        "to the sum?",
    )
    return "Two vertices lose an edge and two gain one: s may change, the sum does not."


@declare("2.2", "Round theta / 90, halves up, add 1, and return at least 2.")
def desired(function: object) -> str:
    """Equation 2 for quads."""
    for angle, wanted in ANGLES.items():
        n = whole_number(result_of(function, angle), "what the function returns")
        if n < 2:
            raise WrongAnswer(
                f"At {angle} degrees it returns {n}; no corner has fewer than two edges."
            )
        if n != wanted:
            raise WrongAnswer(
                f"At {angle} degrees it returns {n}. How many quads fit there best, and how many "
                "edges does a fan of so many quads have?"
            )
    for angle, wanted in HALVES.items():
        require(
            whole_number(result_of(function, angle), "what the function returns") == wanted,
            f"At {angle} degrees {angle / 90:g} quads fit, and halves go up: {wanted}. Python's "
            "round goes to the even number; floor(x + 0.5) does not.",
        )
    return "A fan of n quads has n + 1 edges, for it has one at both of its ends."


@declare("2.3", "Begin with -4, and add 3 minus the desired degree for each corner.")
def three_bounds(l_shape: object, hexagon: object, disc: object) -> str:
    """s* of an L, of a regular hexagon and of a disc, in quads."""
    require(
        whole_number(l_shape, "the answer for the L") == 0,
        "The L has five corners of 90 degrees and one of 270. What does each kind add to -4?",
    )
    require(
        whole_number(hexagon, "the answer for the hexagon") == 2,
        "Each corner of the hexagon has 120 degrees. Which degree is desired there, and what do "
        "the six of them add to -4?",
    )
    require(
        whole_number(disc, "the answer for the disc") == 4,
        "The disc has no corner at all: nothing is added to -4. And s* has no sign.",
    )
    return "The L can be regular; the hexagon is always 2 away from it, the disc 4."


@declare("2.4", "Find the Euler characteristic first: 1, less one for each hole.")
def two_round_holes(answer: object) -> str:
    """s* of a square plate with two round holes, in quads."""
    n = whole_number(answer)
    require(n >= 0, "s* is an absolute value; it has no sign.")
    require(n != 0, "That is the square without holes.")
    require(n != 4, "Two things add up here: what the holes bring, and the corners of the square.")
    require(n == 8, "Put the Euler characteristic into the formula, then go round the corners.")
    return "-4 \u00b7 (1 - 2) = 4, and one more for each corner of the square: eight too many."


@declare(
    "2.5", "Compare the sum of the absolute values, s, with the absolute value of the sum, s*."
)
def at_the_optimum(answer: object) -> str:
    """Which of four meshes are at their optimum."""
    found = letters(answer, "abcd")
    require("b" not in found, "Look at b again: a +1 and a -1 could still meet and cancel.")
    require("c" in found, "What of c? Without irregular vertices s is 0, and nothing is below 0.")
    require(len(found) == 3, "There is one more: where all signs agree, nothing can cancel.")
    return "s equals s* exactly where no two irregular vertices have opposite signs."


@declare("2.6", "Call `star.set_desired(vertex, degree)` for some of the corners.")
def other_desired_degrees(widget: object) -> str:
    """Desired degrees with which s* of the star is 0."""
    mesh = edited_mesh(widget)
    total = int(mesh.irregularity().sum())
    require(
        total == 0,
        f"The sum of \u0394 is {total} now. Does it rise or fall when the desired degree of a "
        "vertex is lowered?",
    )
    return "With one edge less at four corners s* is 0: the bound depends on the desired degrees."
