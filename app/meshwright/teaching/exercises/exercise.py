"""Exercises, and the registry of their checks.

A cell of a lesson ends with ``mw.exercise("1.2").check(answer)``. The checks of a lesson are
functions in a module of its own, registered by :func:`declare`; the module is imported when
:func:`exercise` is called for one of them.
"""

from __future__ import annotations

import difflib
import importlib
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from meshwright.teaching.exercises.result import BLANK, RIGHT, WRONG, Answer
from meshwright.teaching.exercises.solution import ExerciseSolution, solution_of

Check = Callable[..., str]
"""Takes the answer; returns a sentence on why it is right, or raises :class:`WrongAnswer` or
:class:`NoAnswer`.
"""

MODULES = {
    "1": "lesson1_half_edges",
    "2": "lesson2_bound",
    "3": "lesson3_triangles",
    "4": "lesson4_quads",
    "5": "lesson5_blocks",
    "6": "lesson6_policy_view",
    "7": "lesson7_research",
}
"""The module of this package with the checks of each lesson."""


class WrongAnswer(Exception):
    """Raised for a wrong answer, with a sentence that helps without giving the answer away."""


class NoAnswer(Exception):
    """Raised if nothing has been answered yet."""


@dataclass(frozen=True)
class Exercise:
    """An exercise. ``name`` is the number of its lesson and its own, ``"1.2"``; ``hint`` is a
    sentence on how to begin; ``judge`` checks answers.
    """

    name: str
    hint: str
    judge: Check

    def check(self, *given: Any) -> Answer:
        """Check an answer: values, a function, or a widget that was edited.

        Never raises for any kind of answer.
        """
        if any(_has_gap(one) for one in given) or not given:
            return Answer(self.name, BLANK, self.hint)
        wanted = len(inspect.signature(self.judge).parameters)
        if len(given) != wanted:
            count = f"{wanted} {'thing' if wanted == 1 else 'things'}"
            return Answer(self.name, WRONG, f"This check takes {count}, not {len(given)}.")
        try:
            return Answer(self.name, RIGHT, self.judge(*given))
        except NoAnswer:
            return Answer(self.name, BLANK, self.hint)
        except WrongAnswer as wrong:
            return Answer(self.name, WRONG, str(wrong))

    def solution(self) -> ExerciseSolution:
        """A solution, as code that can stand above the check."""
        return solution_of(self.name)

    def __repr__(self) -> str:
        """Name and hint."""
        return f"Exercise {self.name}. {self.hint}"


_DECLARED: dict[str, Exercise] = {}


def declare(name: str, hint: str) -> Callable[[Check], Check]:
    """Register the decorated function as the check of the exercise called ``name``."""

    def keep(judge: Check) -> Check:
        _DECLARED[name] = Exercise(name, hint, judge)
        return judge

    return keep


def exercise(name: str) -> Exercise:
    """The exercise called ``name``, such as ``"1.2"``.

    Raises LookupError for an unknown name.
    """
    name = str(name)
    topic = MODULES.get(name.partition(".")[0])
    if topic is not None:
        importlib.import_module(f"meshwright.teaching.exercises.{topic}")
    if name not in _DECLARED:
        near = difflib.get_close_matches(name, _DECLARED, 3, 0.5)
        hint = f"did you mean {' or '.join(near)}?" if near else "the first lesson begins with 1.1."
        raise LookupError(f"There is no exercise {name!r}; {hint}")
    return _DECLARED[name]


def _has_gap(given: Any) -> bool:
    """Whether an answer or a part of it is empty or still ``...``."""
    if isinstance(given, list | tuple | set):
        return any(_has_gap(one) for one in given)
    if isinstance(given, dict):
        return any(_has_gap(one) for one in given.values())
    return given is ... or given is None or (isinstance(given, str) and not given.strip())
