"""Converts answers to the types that checks need.

Each function raises :class:`~meshwright.teaching.exercises.exercise.WrongAnswer`, with a sentence
about the expected form, for an answer that it cannot convert.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable
from typing import Any

from meshwright.teaching.exercises.exercise import NoAnswer, WrongAnswer
from meshwright_core import HalfEdgeMesh
from meshwright_core.arguments import is_whole_number
from meshwright_core.errors import capitalised

LONGEST = 80
"""The most characters of an answer that a sentence quotes."""


def whole_number(given: Any, what: str = "the answer") -> int:
    """A whole number: an int, a numpy integer, or a float without a fractional part."""
    if isinstance(given, float) and given.is_integer():
        return int(given)
    if not is_whole_number(given):
        raise WrongAnswer(f"{capitalised(what)} is a whole number, not {quoted(given)}.")
    return operator.index(given)


def whole_numbers(given: Any, count: int | None = None, what: str = "the answer") -> list[int]:
    """A sequence of whole numbers, of length ``count`` if it is given."""
    if isinstance(given, str | bytes | dict) or not isinstance(given, Iterable):
        raise WrongAnswer(f"{capitalised(what)} is a list of whole numbers, not {quoted(given)}.")
    numbers = [whole_number(one, f"each entry of {what}") for one in given]
    if count is not None and len(numbers) != count:
        raise WrongAnswer(f"{capitalised(what)} has {count} numbers, not {len(numbers)}.")
    return numbers


def yes_or_no(given: Any) -> bool:
    """A bool, or one of the words yes and no."""
    words = {"yes": True, "no": False, "true": True, "false": False}
    if isinstance(given, str) and given.strip().lower() in words:
        return words[given.strip().lower()]
    if isinstance(given, bool) or type(given).__name__ in ("bool_", "bool"):
        return bool(given)
    raise WrongAnswer(f"The answer is True or False, not {quoted(given)}.")


def choice(given: Any, offers: Iterable[str]) -> str:
    """One of the words ``offers``, in upper or lower case."""
    offers = list(offers)
    word = str(given).strip().lower()
    if word not in offers:
        raise WrongAnswer(
            f"Choose one of {', '.join(repr(one) for one in offers)}, not {quoted(given)}."
        )
    return word


def result_of(function: object, *arguments: Any) -> Any:
    """The result of calling the function of an answer; NoAnswer if it is None or ``...``."""
    if not callable(function):
        raise WrongAnswer(f"A function is expected here, not {quoted(function)}.")
    try:
        value = function(*arguments)
    except Exception as error:
        raise WrongAnswer(f"The function stopped with {type(error).__name__}: {error}") from error
    if value is None or value is ...:
        raise NoAnswer
    return value


def mesh_of(given: Any) -> HalfEdgeMesh:
    """The mesh of a widget or document, or the mesh itself."""
    mesh = getattr(given, "mesh", given)
    if not isinstance(mesh, HalfEdgeMesh):
        raise WrongAnswer(f"Give the widget that you clicked in, not {quoted(given)}.")
    return mesh


def edited_mesh(given: Any) -> HalfEdgeMesh:
    """The mesh of a widget; NoAnswer if it has not been edited."""
    mesh = mesh_of(given)
    if mesh.steps == 0:
        raise NoAnswer
    return mesh


def require(truth: object, otherwise: str) -> None:
    """Raise WrongAnswer with the sentence ``otherwise`` unless ``truth``."""
    if not truth:
        raise WrongAnswer(otherwise)


def quoted(given: Any) -> str:
    """The repr of an answer, shortened."""
    text = repr(given)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}\u2026"


def letters(answer: object, known: str) -> set[str]:
    """A set of letters out of ``known``, from a list or from a string with commas or spaces."""
    if isinstance(answer, str):
        answer = answer.replace(",", " ").split()
    if not isinstance(answer, list | tuple | set):
        raise WrongAnswer(f"Write a list of letters, such as ['a', 'b'], not {quoted(answer)}.")
    return {choice(one, known) for one in answer}
