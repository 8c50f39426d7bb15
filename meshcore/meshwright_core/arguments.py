"""Checks of arguments that people pass to functions."""

from __future__ import annotations

from operator import index

import numpy as np

from meshwright_core.errors import MeshError


def is_whole_number(value: object) -> bool:
    """Whether the value is an integer: Python's, NumPy's, or another with ``__index__``.

    Booleans are none.
    """
    if isinstance(value, bool | np.bool_):
        return False
    try:
        index(value)  # type: ignore[arg-type]
    except TypeError:
        return False
    return True


def whole_number(value: object, least: int, name: str) -> int:
    """The value as an int if it is a whole number of at least `least`.

    Otherwise raises MeshError with one sentence that begins with `name`.
    """
    if not is_whole_number(value) or (number := index(value)) < least:  # type: ignore[arg-type]
        raise MeshError(f"{name} is a whole number of at least {least}, not {value!r}.")
    return number
