"""Domains in JSON; the forms are described at :meth:`.domain.Domain.from_json`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError, capitalised


@dataclass
class PolygonContent:
    """A polygon with holes, as the arguments of a domain."""

    outline: list[list[float]]
    holes: list[list[list[float]]]
    corners: Any = None
    hole_corners: Any = None
    name: str = ""


@dataclass
class CurvedContent:
    """Regions of loops of named curves; one without name is a domain without regions."""

    regions: list[tuple[str, list[list[Curve]]]]
    names: list[list[list[str]]]
    labels: list[list[str]]
    name: str = ""
    corner_angle: float = 0.0
    outlines: list[int] = field(default_factory=list)
    """How many of the loops of each region, its first ones, are outlines."""


def parsed(content: Any) -> PolygonContent | CurvedContent:
    """What the object of a domain file says; MeshError, one sentence, if it is none."""
    if not isinstance(content, Mapping):
        raise MeshError('A domain is a JSON object with an "outline".')
    name = content.get("name", "")
    if not isinstance(name, str):
        raise MeshError('"name" is not a text.')
    if "regions" in content:
        regions = content["regions"]
        if not _is_list(regions) or not all(isinstance(region, Mapping) for region in regions):
            raise MeshError('"regions" is not a list of objects with an "outline" each.')
    elif "outline" not in content and "outlines" not in content:
        raise MeshError('The domain has no "outline".')
    elif not any(_has_pieces(loop) for loop in _all_loops(content)):
        if "outlines" not in content:
            return _polygon(content, name)
        regions = [content]
    else:
        regions = [content]
    found = CurvedContent([], [], [], name)
    angle = content.get("corner_angle", 0.0)
    if not _is_number(angle):
        raise MeshError('"corner_angle" is not a number.')
    found.corner_angle = float(angle)
    for number, region in enumerate(regions):
        _add_region(found, region, number, "regions" in content)
    return found


def _polygon(content: Mapping[str, Any], name: str) -> PolygonContent:
    outline = _pairs(content["outline"], "the outline")
    rings = [_pairs(hole, f"hole {i}") for i, hole in enumerate(_holes(content))]
    hole_corners = content.get("hole_corners")
    if hole_corners is not None and not _is_list(hole_corners):
        raise MeshError('"hole_corners" is not a list with one entry for each hole.')
    return PolygonContent(outline, rings, content.get("corners"), hole_corners, name)


def _add_region(
    found: CurvedContent, region: Mapping[str, Any], number: int, several: bool
) -> None:
    name = region.get("name", "") if several else ""
    if not isinstance(name, str):
        raise MeshError(f'"name" of region {number} is not a text.')
    of = f" of region {name or number}" if several else ""
    if "outlines" in region:
        if not _is_list(region["outlines"]) or not len(region["outlines"]):
            raise MeshError(f'"outlines"{of} is not a list of outlines.')
        loops = list(region["outlines"])
        labels = [f"outline {i}{of}" for i in range(len(loops))]
    elif "outline" in region:
        loops, labels = [region["outline"]], [f"the outline{of}"]
    else:
        raise MeshError(f'Region {number} has no "outline".')
    found.outlines.append(len(loops))
    holes = _holes(region)
    labels += [f"hole {i}{of}" for i in range(len(holes))]
    chains = [_chain(loop, label) for loop, label in zip([*loops, *holes], labels, strict=True)]
    found.regions.append((name, [curves for curves, _ in chains]))
    found.names.append([names for _, names in chains])
    found.labels.append(labels)


def _chain(loop: Any, label: str) -> tuple[list[Curve], list[str]]:
    """Curves and names of a loop: a list of pieces, or of the corners of a polygon."""
    if not _has_pieces(loop):
        corners = _pairs(loop, label)
        if len(corners) > 1 and corners[0] != corners[-1]:
            corners.append(corners[0])
        try:
            lines = [Curve.line(a, b) for a, b in pairwise(corners)]
        except MeshError as error:
            raise MeshError(f"{capitalised(label)} has a point twice, or none at all.") from error
        return lines, [""] * len(lines)
    curves, names = [], []
    for i, piece in enumerate(loop):
        name = piece.get("name", "") if isinstance(piece, Mapping) else ""
        if not isinstance(name, str):
            raise MeshError(f'"name" of piece {i} of {label} is not a text.')
        try:
            curves.append(Curve.from_json(piece))
        except MeshError as error:
            raise MeshError(f"Piece {i} of {label}: {error}.") from error
        names.append(name)
    return curves, names


def chain_json(curves: Sequence[Curve], names: Sequence[str]) -> list[dict[str, Any]]:
    """A loop as the list of its pieces."""
    return [
        {**curve.to_json(), **({"name": name} if name else {})}
        for curve, name in zip(curves, names, strict=True)
    ]


def _holes(content: Mapping[str, Any]) -> Sequence[Any]:
    holes = content.get("holes")
    if holes is None:
        return []
    if not _is_list(holes):
        raise MeshError('"holes" is not a list of holes.')
    found: Sequence[Any] = holes
    return found


def _all_loops(content: Mapping[str, Any]) -> list[Any]:
    loops = [content["outline"]] if "outline" in content else []
    for key in ("outlines", "holes"):
        several = content.get(key)
        if several is not None and _is_list(several):
            loops += list(several)
    return loops


def _has_pieces(loop: Any) -> bool:
    return _is_list(loop) and any(isinstance(piece, Mapping) for piece in loop)


def _is_list(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, str)


def load_json(path: Path) -> Any:
    """Return what a JSON file holds; MeshError that begins with the path if there is none."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError as error:
        raise MeshError(f"{path}: there is no such file.") from error
    except IsADirectoryError as error:
        raise MeshError(f"{path}: this is a folder, not a file.") from error
    except UnicodeDecodeError as error:
        raise MeshError(f"{path}: this is not a text file.") from error
    except (OSError, ValueError) as error:
        raise MeshError(f"{path}: cannot be read ({_reason(error)}).") from error
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        if not text.strip():
            raise MeshError(f"{path}: the file is empty.") from error
        place = f"line {error.lineno}, column {error.colno}"
        raise MeshError(f"{path}, {place}: this is not JSON ({error.msg}).") from error
    except (RecursionError, ValueError) as error:
        raise MeshError(f"{path}: this JSON is too deep or its numbers too long.") from error


def _reason(error: Exception) -> str:
    text = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return text[:1].lower() + text[1:].strip().rstrip(".")


def _pairs(ring: Any, what: str) -> list[list[float]]:
    """Return a JSON list of [x, y] pairs as floats, or raise MeshError with the wrong entry."""
    if isinstance(ring, np.ndarray):
        ring = ring.tolist()
    if not isinstance(ring, Sequence) or isinstance(ring, str):
        raise MeshError(f"{capitalised(what)} is not a list of [x, y] pairs.")
    pairs = []
    for i, pair in enumerate(ring):
        numbers = isinstance(pair, Sequence) and len(pair) == 2 and all(map(_is_number, pair))
        if not numbers:
            shown = repr(pair)
            shown = shown if len(shown) <= 40 else shown[:37] + "..."
            raise MeshError(f"Point {i} of {what} is not a pair of numbers: {shown}.")
        try:
            pairs.append([float(pair[0]), float(pair[1])])
        except OverflowError as error:
            raise MeshError(f"Point {i} of {what} has a number that is too large.") from error
    return pairs


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
