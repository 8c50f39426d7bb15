"""Exercises that check themselves.

A lesson's cell ends with ``mw.exercise("1.2").check(answer)``. The checks stand in one module a
lesson, as functions that :func:`declare` names; they are imported when one of theirs is asked for.
"""

from __future__ import annotations

import difflib
import importlib
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from meshwright.teaching.exercises.result import BLANK, RIGHT, WRONG, Answer
from meshwright.teaching.exercises.solution import Solution, solution_of

Check = Callable[..., str]
"""Takes what the student gives; returns why it is right, or raises :class:`Wrong` or
:class:`Blank`.
"""

TOPICS = {
    "1": "lesson1_half_edges",
    "2": "lesson2_bound",
    "3": "lesson3_triangles",
    "4": "lesson4_quads",
    "5": "lesson5_blocks",
    "6": "lesson6_policy_view",
    "7": "lesson7_research",
}
"""The module of this package with the checks of each lesson."""


class Wrong(Exception):
    """An answer that is not right; its sentence helps without giving the answer away."""


class Blank(Exception):
    """Nothing has been answered yet."""


@dataclass(frozen=True)
class Exercise:
    """An exercise of a lesson. ``name`` is the number of the lesson and its own, ``"1.2"``;
    ``nudge`` says how to begin.
    """

    name: str
    nudge: str
    judge: Check

    def check(self, *given: Any) -> Answer:
        """Judge what is given: a value, a function, or the widget that was clicked in.

        Whatever a student may write is an answer: nothing is raised for it.
        """
        if any(_has_gap(one) for one in given) or not given:
            return Answer(self.name, BLANK, self.nudge)
        wanted = len(inspect.signature(self.judge).parameters)
        if len(given) != wanted:
            said = f"{wanted} {'thing' if wanted == 1 else 'things'}"
            return Answer(self.name, WRONG, f"This check takes {said}, not {len(given)}.")
        try:
            return Answer(self.name, RIGHT, self.judge(*given))
        except Blank:
            return Answer(self.name, BLANK, self.nudge)
        except Wrong as wrong:
            return Answer(self.name, WRONG, str(wrong))

    def solution(self) -> Solution:
        """One solution, as code that may stand above the check."""
        return solution_of(self.name)

    def __repr__(self) -> str:
        """Its name and how to begin."""
        return f"Exercise {self.name}. {self.nudge}"


_DECLARED: dict[str, Exercise] = {}


def declare(name: str, nudge: str) -> Callable[[Check], Check]:
    """Make the decorated function the judge of the exercise called ``name``."""

    def keep(judge: Check) -> Check:
        _DECLARED[name] = Exercise(name, nudge, judge)
        return judge

    return keep


def exercise(name: str) -> Exercise:
    """The exercise called ``name``, such as ``"1.2"``.

    Raises LookupError, in one sentence, where there is none.
    """
    name = str(name)
    topic = TOPICS.get(name.partition(".")[0])
    if topic is not None:
        importlib.import_module(f"meshwright.teaching.exercises.{topic}")
    if name not in _DECLARED:
        near = difflib.get_close_matches(name, _DECLARED, 3, 0.5)
        hint = f"did you mean {' or '.join(near)}?" if near else "the first lesson begins with 1.1."
        raise LookupError(f"There is no exercise {name!r}; {hint}")
    return _DECLARED[name]


def _has_gap(given: Any) -> bool:
    """Whether what is given, or a part of it, is still ``...``."""
    if isinstance(given, list | tuple | set):
        return any(_has_gap(one) for one in given)
    if isinstance(given, dict):
        return any(_has_gap(one) for one in given.values())
    return given is ... or given is None or (isinstance(given, str) and not given.strip())
