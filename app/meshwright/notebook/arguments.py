"""Checks of arguments from users' code; all raise MeshError with one sentence."""

from __future__ import annotations

import math
from difflib import get_close_matches
from operator import index
from pathlib import Path
from reprlib import repr as shortened
from typing import Any

from meshwright.notebook.protocol.requests import DEGREES
from meshwright_core import HalfEdgeMesh, MeshError, Operation
from meshwright_core.arguments import is_whole_number
from meshwright_core.operations.catalogue import of_kind

_IDS = 2**31


def operation_of(mesh: HalfEdgeMesh, operation: Any) -> Operation:
    """The operation of this name; MeshError, with those that are close, if there is none."""
    try:
        return Operation(operation)
    except ValueError:
        names = [str(info.operation) for info in of_kind(mesh.kind)]
        near = get_close_matches(operation, names, 3) if isinstance(operation, str) else []
        there = f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(names)}."
        raise MeshError(f"There is no operation {shortened(operation)}; {there}") from None


def whole(value: Any, noun: str) -> int:
    """``value`` as int, numpy integers included; MeshError if it is none or out of range."""
    if not is_whole_number(value):
        raise MeshError(f"A {noun} must be a whole number, not {shortened(value)}.")
    number = index(value)
    if not -_IDS <= number < _IDS:
        raise MeshError(f"There is no {noun} {shortened(number)}.")
    return number


def vertex_of(mesh: HalfEdgeMesh, value: Any) -> int:
    """The id of an existing vertex; else MeshError."""
    vertex = whole(value, "vertex")
    if not (mesh.vertices() == vertex).any():
        raise MeshError(f"There is no vertex {vertex} in this mesh.")
    return vertex


def degree_of(value: Any) -> int:
    """A valid desired degree; else MeshError."""
    degree = whole(value, "degree")
    low, high = DEGREES
    if not low <= degree <= high:
        raise MeshError(f"A desired degree must be from {low} to {high}, not {degree}.")
    return degree


def positive(value: Any, name: str) -> float:
    """A finite number above 0; else MeshError."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if isinstance(value, str) or not 0 < number < math.inf:
        raise MeshError(f"{name} must be a number above 0, not {shortened(value)}.")
    return number


def policy_of(value: Any) -> str:
    """A policy's name, or the path of its file; else MeshError."""
    if not isinstance(value, str | Path):
        raise MeshError(f"A policy must be a name or a file, not {shortened(value)}.")
    return str(value)
