"""Pieces of curves in JSON.

A piece is an object with one of these keys; angles are in degrees, counter-clockwise:

- ``{"line": [[x, y], [x, y]]}``
- ``{"polyline": [[x, y], ...]}``
- ``{"arc": {"centre": [x, y], "radius": r, "start": a, "sweep": b}}``, or by its
  ends ``{"arc": {"from": [x, y], "to": [x, y], "bulge": c}}``, c the tangent of a quarter of the
  sweep
- ``{"ellipse": {"centre": [x, y], "major": [x, y], "minor": [x, y], "start": a, "sweep": b}}``;
  `major` and `minor` are the half axes, start 0 and sweep 360 if they are left out
- ``{"spline": {"degree": d, "control": [[x, y], ...], "knots": [...], "weights": [...]}}``; without
  knots they are clamped and even, without weights the spline is not rational
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError

_PLACES = {"line": 2, "arc": 0, "ellipse": 0, "spline": 0, "polyline": 2}


def to_json(kind: str, data: Mapping[str, Any]) -> dict[str, Any]:
    """The object of a piece of this kind and data (angles in radians)."""
    if kind in ("line", "polyline"):
        return {kind: data["points"].tolist()}
    content: dict[str, Any] = {}
    for key, value in data.items():
        if value is None:
            continue
        if key in ("start", "sweep"):
            value = math.degrees(value)
        content[key] = value.tolist() if isinstance(value, np.ndarray) else value
    return {kind: content}


def is_piece(content: Any) -> bool:
    """Whether this is an object with the key of a piece."""
    return isinstance(content, Mapping) and any(kind in content for kind in _PLACES)


def from_json(content: Any) -> tuple[str, dict[str, Any]]:
    """Kind and data (angles in radians) of a piece; MeshError, one sentence, if it is none."""
    found = [kind for kind in _PLACES if isinstance(content, Mapping) and kind in content]
    if len(found) != 1:
        kinds = ", ".join(f'"{kind}"' for kind in _PLACES)
        raise MeshError(f"a piece of a curve is an object with one of the keys {kinds}")
    kind = found[0]
    value = content[kind]
    if kind in ("line", "polyline"):
        points = _array(value, f'"{kind}"', (-1, 2))
        if len(points) < 2 or (kind == "line" and len(points) != 2):
            raise MeshError(f'a "{kind}" has {"two" if kind == "line" else "at least two"} points')
        return kind, {"points": points}
    if not isinstance(value, Mapping):
        raise MeshError(f'"{kind}" is not an object')
    if kind == "spline":
        return kind, _spline(value)
    if kind == "arc" and "bulge" in value:
        ends = [_array(value.get(end), f'"{end}"', (2,)) for end in ("from", "to")]
        return kind, {"points": np.array(ends), "bulge": _number(value["bulge"], '"bulge"')}
    whole = kind == "ellipse"
    data: dict[str, Any] = {"centre": _array(value.get("centre"), '"centre"', (2,))}
    if kind == "arc":
        data["radius"] = _number(value.get("radius"), '"radius"')
    else:
        data["major"] = _array(value.get("major"), '"major"', (2,))
        data["minor"] = _array(value.get("minor"), '"minor"', (2,))
    data["start"] = math.radians(_number(value.get("start", 0.0), '"start"'))
    sweep = value.get("sweep", 360.0 if whole else None)
    data["sweep"] = math.radians(_number(sweep, '"sweep"'))
    return kind, data


def _spline(value: Mapping[str, Any]) -> dict[str, Any]:
    control = _array(value.get("control"), '"control"', (-1, 2))
    degree = value.get("degree", min(3, len(control) - 1))
    if not isinstance(degree, int) or isinstance(degree, bool) or not 1 <= degree < len(control):
        raise MeshError('"degree" of a spline is a whole number below the number of its points')
    weights = value.get("weights")
    knots = value.get("knots")
    if knots is None:
        inner = np.linspace(0.0, 1.0, len(control) - degree + 1)[1:-1]
        knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    return {
        "control": control,
        "knots": _array(knots, '"knots"', (-1,)),
        "degree": degree,
        "weights": None if weights is None else _array(weights, '"weights"', (-1,)),
    }


def _array(value: Any, what: str, shape: tuple[int, ...]) -> NDArray[np.float64]:
    try:
        array = np.array(value, np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise MeshError(f"{what} of a piece is not a list of numbers as it should be") from error
    fits = array.ndim == len(shape) and all(
        want in (-1, have) for want, have in zip(shape, array.shape, strict=True)
    )
    if not fits or not np.isfinite(array).all():
        raise MeshError(f"{what} of a piece is not a list of numbers as it should be")
    return array


def _number(value: Any, what: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise MeshError(f"{what} of a piece is not a number")
    return float(value)
