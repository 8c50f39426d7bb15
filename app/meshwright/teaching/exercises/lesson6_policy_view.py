"""Checks of lesson 6: input and output of a policy, and its training."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from meshwright.teaching.exercises.answer_parsing import (
    quoted,
    require,
    result_of,
    whole_number,
    whole_numbers,
    yes_or_no,
)
from meshwright.teaching.exercises.example_meshes import grid
from meshwright.teaching.exercises.exercise import WrongAnswer, declare

GAMMA, REWARDS, START = 0.9, (0, 0, 2), 4
RETURN = sum(GAMMA**k * r for k, r in enumerate(REWARDS)) / START


@declare("6.1", "Which two numbers does x hold, and is a place in the plane among them?")
def blind_to_places(answer: object) -> str:
    """Whether moving a vertex changes what the policy sees."""
    require(
        not yes_or_no(answer),
        "x holds degrees and \u0394. Which of the two depends on where an inner vertex lies?",
    )
    return "It reads connectivity only; positions of vertices do not matter."


@declare("6.2", "Its own quad first, as `next` goes, and the other side of its edge last.")
def reads(function: object) -> str:
    """The half-edges whose numbers one block gathers for h."""
    mesh = grid(3, 3)
    for h in (mesh.halfedge(5, 6), mesh.halfedge(10, 9), mesh.halfedge(0, 1)):
        found = whole_numbers(result_of(function, mesh, h), None, "what the function returns")
        around = [h, mesh.next(h), mesh.next(mesh.next(h)), mesh.prev(h)]
        require(
            len(found) == 5,
            f"It returns {len(found)} half-edges; a quad has four, and there is the twin.",
        )
        require(
            sorted(found) == sorted([*around, mesh.twin(h)]),
            f"From {h} in a grid of 3 by 3 quads it comes to {found}: that is not its quad and "
            "its twin.",
        )
        require(
            found == [*around, mesh.twin(h)],
            "These are the right ones in another order. It matters: the layer has weights of "
            "their own for each place.",
        )
    return "Four from the quad and one from the other side: five inputs, wherever h lies."


@declare("6.3", "Add up the first three numbers of the line above.")
def seen_after_two(answer: object) -> str:
    """Quads in the field of view after two blocks."""
    n = whole_number(answer)
    require(n != 3, "Those come in with the second block; the ones from before are still seen.")
    require(n != 8, "That is after three blocks.")
    require(n == 5, "Its own quad, one by the first block, and those that the second brings.")
    return "1 + 1 + 3: its own, the one across its edge, and the three across its other sides."


@declare("6.4", "Sizes, not signs; slots beyond the boundary count as 0 already.")
def local_score(function: object) -> str:
    """The sum of |Delta| over the slots of a template."""
    for delta in ([1, -2, 0, 0, 3], [0, 0], [-1, -1, -1]):
        view = SimpleNamespace(delta=np.array(delta))
        n = whole_number(result_of(function, view), "what the function returns")
        require(
            n != sum(delta) or n == sum(map(abs, delta)),
            "The signs cancel in this sum; a template with +2 and -2 is irregular.",
        )
        require(
            n == sum(map(abs, delta)),
            f"For \u0394 = {delta} it returns {n}; it is s, of these slots only.",
        )
    return "It is the score s of one template: where it is high, there is much to improve."


@declare("6.5", "Take np.exp of the logits, put 0 where nothing is allowed, and divide by the sum.")
def masked_softmax(function: object) -> str:
    """Probabilities from logits and an action mask."""
    logits = np.array([1.0, 0.0, 3.0, -1.0])
    for allowed in (
        np.array([True, True, False, True]),
        np.array([True, True, True, True]),
        np.array([False, False, False, True]),
    ):
        found = _numbers(result_of(function, logits, allowed), 4)
        weights = np.exp(logits) * allowed
        require(
            np.all(found[~allowed] == 0.0),
            "An operation that is not allowed has a probability above 0.",
        )
        require(
            abs(found.sum() - 1.0) < 1e-6,
            f"The probabilities add up to {found.sum():.3g}, not to 1.",
        )
        require(
            np.allclose(found, weights / weights.sum()),
            "They add up to 1, but the share of each is not that of its exponential.",
        )
    return "What is not allowed is never drawn, and the probabilities of the rest add up to 1."


@declare("6.6", "Each reward counts \u03b3 times as much as one that comes a step earlier.")
def discounted(answer: object) -> str:
    """A normalised, discounted return."""
    found = float(_numbers([answer], 1)[0])
    require(abs(found - 0.5) > 1e-3, "That is without \u03b3: the 2 comes two steps late.")
    require(
        abs(found - RETURN * START) > 1e-3,
        "That is the discounted return. It still has to be divided by s - s* at the start.",
    )
    require(
        abs(found - 0.45) > 1e-3, "The first reward counts fully, the second \u03b3, the third?"
    )
    require(
        abs(found - RETURN) < 1e-3, "0 + 0.9 \u00b7 0 + ... Then divide by s - s* at the start."
    )
    return "0.81 \u00b7 2 = 1.62, and 1.62 of the 4 that could be gained is 0.405."


def _numbers(given: Any, count: int) -> np.ndarray:
    """``count`` numbers as an array of float."""
    try:
        found = np.asarray(given, dtype=float).ravel()
    except (TypeError, ValueError):
        raise WrongAnswer(f"Numbers are expected here, not {quoted(given)}.") from None
    require(len(found) == count, f"{count} numbers are expected here, not {len(found)}.")
    require(np.all(np.isfinite(found)), f"{quoted(given)} is not made of numbers.")
    return found
