"""Lengths, transforms and view boxes of SVG (SVG 2, chapters 7 and 8)."""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import LARGEST

Matrix = NDArray[np.float64]
Size = tuple[float, float]

_UNITS = {
    "": 1.0, "px": 1.0, "mm": 96 / 25.4, "cm": 96 / 2.54, "in": 96.0, "pt": 4 / 3, "pc": 16.0,
    "q": 96 / 101.6, "em": 16.0, "rem": 16.0, "ex": 8.0,
}  # fmt: skip
"""Pixels; em and ex of the usual 16 pixels."""
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-zA-Z%]*)\s*$")
_TRANSFORM = re.compile(r"\s*,?\s*(\w+)\s*\(([^()]*)\)")
_UNIT = re.compile(r"(?<=\d)(?:px|deg)\b")
_ALIGN = {"min": 0.0, "mid": 0.5, "max": 1.0}


def tag_of(element: ElementTree.Element) -> str:
    """The name of an element without its namespace; "" for a comment."""
    return str(element.tag).rpartition("}")[2] if isinstance(element.tag, str) else ""


def is_number(text: str) -> bool:
    """Whether a word is a number of ordinary size."""
    try:
        return abs(float(text)) < LARGEST
    except ValueError:
        return False


def length(
    element: ElementTree.Element, name: str, axis: int, size: Size, default: str = "0"
) -> float:
    """The length in an attribute; per cents of a width (axis 0), height (1) or their mean (2).

    Raises:
        MeshError: it is none.
    """
    text = element.get(name, default)
    match = _LENGTH.match(text)
    unit = match.group(2).lower() if match else ""
    if match is None or unit not in (*_UNITS, "%") or not is_number(match.group(1)):
        raise MeshError(f"the {name} of a <{tag_of(element)}> is {text[:20]!r}, which is no length")
    value = float(match.group(1))
    if unit != "%":
        return value * _UNITS[unit]
    return value / 100 * (*size, math.hypot(*size) / math.sqrt(2))[axis]


def view_box(element: ElementTree.Element) -> tuple[float, float, float, float] | None:
    """The view box of an element; None if it has none of any size."""
    words = re.split(r"[\s,]+", element.get("viewBox", "").strip())
    if len(words) != 4 or not all(map(is_number, words)):
        return None
    x, y, width, height = map(float, words)
    return (x, y, width, height) if width > 0 and height > 0 else None


def viewport(element: ElementTree.Element, width: float, height: float) -> tuple[Matrix, Size]:
    """The map of what an <svg> or <symbol> holds to a viewport of this size at the origin.

    Returns:
        The (3, 3) matrix, and the size that per cents refer to inside.
    """
    matrix = np.eye(3)
    box = view_box(element)
    if box is None or width <= 0 or height <= 0:
        return matrix, (width, height)
    x, y, wide, high = box
    scale = np.array([width / wide, height / high])
    words = element.get("preserveAspectRatio", "xMidYMid meet").split()
    words = words[1:] if words[:1] == ["defer"] else words
    align = words[0] if words else "xMidYMid"
    free = np.zeros(2)
    if align != "none":
        scale[:] = scale.max() if words[1:2] == ["slice"] else scale.min()
        shares = [_ALIGN.get(align[1:4].lower(), 0.5), _ALIGN.get(align[5:8].lower(), 0.5)]
        free = (np.array([width, height]) - scale * (wide, high)) * shares
    matrix[:2, :2] = np.diag(scale)
    matrix[:2, 2] = free - scale * (x, y)
    return matrix, (wide, high)


def transform(text: str) -> Matrix:
    """The (3, 3) matrix of a list of transforms.

    Raises:
        MeshError: it is not understood.
    """
    result = np.eye(3)
    if text.strip().lower() in ("", "none"):
        return result
    at = 0
    for match in _TRANSFORM.finditer(text):
        if text[at : match.start()].strip():
            break
        at = match.end()
        words = _UNIT.sub("", match.group(2)).replace(",", " ").split()
        if not all(map(is_number, words)):
            raise MeshError(f"the transform {match.group()[:40].strip()!r} has no numbers")
        result = result @ _single(match.group(1), [float(word) for word in words])
    if text[at:].strip(" \t\r\n,"):
        raise MeshError(f"the transform {text[:40]!r} is not understood")
    return result


def _single(name: str, values: list[float]) -> Matrix:
    count = len(values)
    made = np.eye(3)
    if name == "matrix" and count == 6:
        made[:2] = np.array(values).reshape(3, 2).T
    elif name == "translate" and count in (1, 2):
        made[:2, 2] = (*values, 0.0)[:2]
    elif name == "scale" and count in (1, 2):
        made[:2, :2] = np.diag([values[0], values[-1]])
    elif name == "rotate" and count in (1, 3):
        # whole quarters exactly: a rotated rectangle keeps its sides
        quarter, rest = divmod(values[0], 90.0)
        angle = math.radians(values[0])
        c, s = math.cos(angle), math.sin(angle)
        if rest == 0.0:
            c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[int(quarter) % 4]
        made[:2, :2] = [[c, -s], [s, c]]
        centre = np.array(values[1:] or (0.0, 0.0))
        made[:2, 2] = centre - made[:2, :2] @ centre
    elif name == "skewX" and count == 1:
        made[0, 1] = math.tan(math.radians(values[0]))
    elif name == "skewY" and count == 1:
        made[1, 0] = math.tan(math.radians(values[0]))
    else:
        raise MeshError(f"the transform {name}({', '.join(f'{v:g}' for v in values)}) is not known")
    return made
