"""Reading what students give: each helper returns it in the form that a check wants, or raises
:class:`~meshwright.teaching.exercises.exercise.Wrong` with a sentence that says what is wanted.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable
from typing import Any

from meshwright.teaching.exercises.exercise import Blank, Wrong
from meshwright_core import HalfEdgeMesh
from meshwright_core.arguments import is_whole_number

LONGEST = 80
"""Letters of a student's own value that a sentence quotes."""


def whole(given: Any, what: str = "the answer") -> int:
    """A whole number: an int, one of numpy's, or a float without a fraction."""
    if isinstance(given, float) and given.is_integer():
        return int(given)
    if not is_whole_number(given):
        raise Wrong(f"{_begun(what)} is a whole number, not {quoted(given)}.")
    return operator.index(given)


def wholes(given: Any, count: int | None = None, what: str = "the answer") -> list[int]:
    """Several whole numbers, in order; ``count`` of them if it is given."""
    if isinstance(given, str | bytes | dict) or not isinstance(given, Iterable):
        raise Wrong(f"{_begun(what)} is a list of whole numbers, not {quoted(given)}.")
    numbers = [whole(one, f"each entry of {what}") for one in given]
    if count is not None and len(numbers) != count:
        raise Wrong(f"{_begun(what)} has {count} numbers, not {len(numbers)}.")
    return numbers


def yes_or_no(given: Any) -> bool:
    """A truth value, or one of the words yes and no."""
    words = {"yes": True, "no": False, "true": True, "false": False}
    if isinstance(given, str) and given.strip().lower() in words:
        return words[given.strip().lower()]
    if isinstance(given, bool) or type(given).__name__ in ("bool_", "bool"):
        return bool(given)
    raise Wrong(f"The answer is True or False, not {quoted(given)}.")


def choice(given: Any, offers: Iterable[str]) -> str:
    """One of some words, whatever its capitals."""
    offers = list(offers)
    word = str(given).strip().lower()
    if word not in offers:
        raise Wrong(f"Choose one of {', '.join(repr(one) for one in offers)}, not {quoted(given)}.")
    return word


def called(function: Callable[..., Any], *arguments: Any) -> Any:
    """What a student's function returns; not answered where that is nothing or ``...``."""
    if not callable(function):
        raise Wrong(f"A function is wanted here, not {quoted(function)}.")
    try:
        value = function(*arguments)
    except Exception as error:
        raise Wrong(f"The function stopped with {type(error).__name__}: {error}") from error
    if value is None or value is ...:
        raise Blank
    return value


def mesh_of(given: Any) -> HalfEdgeMesh:
    """The mesh of a widget or of a document, or the mesh itself."""
    mesh = getattr(given, "mesh", given)
    if not isinstance(mesh, HalfEdgeMesh):
        raise Wrong(f"Give the widget that you clicked in, not {quoted(given)}.")
    return mesh


def edited(given: Any) -> HalfEdgeMesh:
    """The mesh of a widget, once something has been done to it; before that nothing is answered."""
    mesh = mesh_of(given)
    if mesh.steps == 0:
        raise Blank
    return mesh


def expect(truth: object, otherwise: str) -> None:
    """Go on if ``truth``; else the answer is wrong, and ``otherwise`` helps."""
    if not truth:
        raise Wrong(otherwise)


def quoted(given: Any) -> str:
    """What was given, in few letters."""
    text = repr(given)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}\u2026"


def _begun(words: str) -> str:
    return words[:1].upper() + words[1:]


def letters(answer: object, known: str) -> set[str]:
    """Several of the letters of ``known``: a list of them, or a string with commas or spaces."""
    if isinstance(answer, str):
        answer = answer.replace(",", " ").split()
    if not isinstance(answer, list | tuple | set):
        raise Wrong(f"Write a list of letters, such as ['a', 'b'], not {quoted(answer)}.")
    return {choice(one, known) for one in answer}
