"""Conversions of a mesh to objects of other libraries, which a room above this one registers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_MAKERS: dict[str, Callable[[str, Any], Any]] = {}


def register(library: str, make: Callable[[str, Any], Any]) -> None:
    """`make` turns the name of the library and a mesh into an object of the library."""
    _MAKERS[library] = make


def converted(library: str, mesh: object) -> Any:
    """The mesh as an object of a library."""
    return _MAKERS[library](library, mesh)
