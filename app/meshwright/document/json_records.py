"""Plain values read from JSON, converted to typed records with one clear sentence on failure."""

from __future__ import annotations

import re
from typing import Annotated, Any, TypeVar

import msgspec

from meshwright_core import MeshError

LARGEST = 1 << 53
"""Bound on the integers in files: those that a float holds exactly."""

WholeNumber = Annotated[int, msgspec.Meta(ge=-LARGEST, le=LARGEST)]
Count = Annotated[int, msgspec.Meta(ge=0, le=LARGEST)]
"""A whole number that is not negative."""

Record = TypeVar("Record")

_MISSING = re.compile(r"Object missing required field `(.*)`")


def converted(values: Any, to: type[Record]) -> Record:
    """The record of type ``to`` with these values.

    Raises MeshError with a part of a sentence that names the field: ``its field 'rows[1][0]' is
    wrong: expected int, got bool``.
    """
    try:
        return msgspec.convert(values, to)
    except msgspec.ValidationError as error:
        raise MeshError(reason(error)) from error


def decoded(data: bytes, to: type[Record]) -> Record:
    """The record of type ``to`` in JSON text; raises MeshError as :func:`converted` does."""
    try:
        return msgspec.json.decode(data, type=to)
    except msgspec.ValidationError as error:
        raise MeshError(reason(error)) from error
    except msgspec.DecodeError as error:
        raise MeshError(f"it is not JSON ({error})") from error
    except RecursionError as error:
        raise MeshError("its JSON is nested too deeply") from error


def reason(error: msgspec.ValidationError) -> str:
    """A validation error as the second part of a sentence, after the name of a file."""
    problem, _, path = str(error).partition(" - at `$")
    path = path.strip("`.")
    missing = _MISSING.fullmatch(problem)
    if missing:
        return f"its field '{path}{'.' if path else ''}{missing[1]}' is missing"
    problem = problem.replace("`", "")
    problem = problem[:1].lower() + problem[1:]
    return f"its field '{path}' is wrong: {problem}" if path else f"it is wrong: {problem}"
