"""Triangle's .poly files: vertices, segments, points in holes, and regional attributes.

The format is documented at https://www.cs.cmu.edu/~quake/triangle.poly.html. All that segments
enclose and that holds no hole point is material, and each enclosed part is a region.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import LARGEST, Drawing, Points

_MOST = 1_000_000
"""Vertices or segments beyond which a file is refused."""
_PLAIN = (0, 1)
"""Markers of segments that say nothing: Triangle's own for the inside and the boundary."""

Rows = Iterator[tuple[int, list[str]]]


def read(content: bytes, path: Path | None = None) -> Drawing:
    """Return what a .poly file draws.

    Args:
        content: of the file.
        path: of the file; its vertices may stand in a .node file beside it.

    Raises:
        MeshError: with the line, where the file is damaged.
    """
    rows = _rows(content)
    line, head = _next(rows, "the number of vertices")
    count = _count(head, 0, line)
    dimension = _count(head, 1, line) if len(head) > 1 else 2
    if dimension != 2:
        raise MeshError(f"line {line}: it has {dimension} dimensions, not 2")
    if count:
        numbers, points = _vertices(rows, count)
    else:
        numbers, points = _node_file(path)
    drawing = Drawing()
    segments, markers = _segments(rows, numbers)
    for curve, marker in _chains(points, segments, markers):
        name = "" if marker in _PLAIN else f"marker {marker}"
        drawing.add(curve, "", name)
    drawing.holes = _holes(rows)
    drawing.labels = _labels(rows)
    return drawing


def _rows(content: bytes) -> Rows:
    """Yield the lines that hold anything, as words, with their numbers."""
    for i, line in enumerate(content.decode("utf-8-sig", "replace").splitlines(), 1):
        words = line.split("#", 1)[0].replace(",", " ").split()
        if words:
            yield i, words


def _next(rows: Rows, what: str) -> tuple[int, list[str]]:
    found = next(rows, None)
    if found is None:
        raise MeshError(f"it is cut off: {what} is missing")
    return found


def _number(words: list[str], at: int, line: int) -> float:
    try:
        value = float(words[at])
    except (ValueError, IndexError):
        value = np.nan
    if not abs(value) < LARGEST:
        found = repr(words[at][:20]) if at < len(words) else "nothing"
        raise MeshError(f"line {line}: {found} stands where a number was expected")
    return value


def _count(words: list[str], at: int, line: int) -> int:
    value = _number(words, at, line)
    if value != int(value) or not 0 <= value <= _MOST:
        raise MeshError(f"line {line}: {words[at][:20]!r} is no number of things that is read")
    return int(value)


def _vertices(rows: Rows, count: int) -> tuple[dict[int, int], Points]:
    """The places of `count` vertices, and the row of each number."""
    numbers: dict[int, int] = {}
    points = []
    for i in range(count):
        line, words = _next(rows, f"vertex {i + 1} of {count}")
        numbers[int(_number(words, 0, line))] = i
        points.append((_number(words, 1, line), _number(words, 2, line)))
    return numbers, np.array(points, dtype=np.float64).reshape(-1, 2)


def _node_file(path: Path | None) -> tuple[dict[int, int], Points]:
    if path is None:
        raise MeshError("it has no vertices")
    beside = path.with_suffix(".node")
    try:
        rows = _rows(beside.read_bytes())
    except OSError as error:
        raise MeshError(
            f"its vertices are to be in {beside.name} beside it, which cannot be read"
        ) from error
    try:
        line, head = _next(rows, "the number of vertices")
        return _vertices(rows, _count(head, 0, line))
    except MeshError as error:
        raise MeshError(f"{beside.name}: {error}") from error


def _segments(rows: Rows, numbers: dict[int, int]) -> tuple[list[tuple[int, int]], list[int]]:
    line, head = _next(rows, "the number of segments")
    segments, markers = [], []
    for i in range(count := _count(head, 0, line)):
        line, words = _next(rows, f"segment {i + 1} of {count}")
        ends = [int(_number(words, at, line)) for at in (1, 2)]
        for end in ends:
            if end not in numbers:
                raise MeshError(f"line {line}: there is no vertex {end}")
        segments.append((numbers[ends[0]], numbers[ends[1]]))
        markers.append(int(_number(words, 3, line)) if len(words) > 3 else 0)
    return segments, markers


def _holes(rows: Rows) -> Points:
    found = next(rows, None)
    count = 0 if found is None else _count(found[1], 0, found[0])
    places = []
    for i in range(count):
        line, words = _next(rows, f"hole {i + 1} of {count}")
        places.append((_number(words, 1, line), _number(words, 2, line)))
    return np.array(places, dtype=np.float64).reshape(-1, 2)


def _labels(rows: Rows) -> list[tuple[str, Points]]:
    found = next(rows, None)
    labels = []
    for i in range(count := 0 if found is None else _count(found[1], 0, found[0])):
        line, words = _next(rows, f"region {i + 1} of {count}")
        place = np.array([_number(words, 1, line), _number(words, 2, line)])
        attribute = _number(words, 3, line) if len(words) > 3 else 0.0
        labels.append((f"attribute {attribute:g}", place))
    return labels


def _chains(
    points: Points, segments: list[tuple[int, int]], markers: list[int]
) -> Iterator[tuple[Curve, int]]:
    """Yield segments of one marker, one after the other, as polylines: a curve is drawn so."""
    at: dict[int, list[int]] = {}
    for i, (a, b) in enumerate(segments):
        at.setdefault(a, []).append(i)
        at.setdefault(b, []).append(i)
    left = [a != b for a, b in segments]

    def follow(vertex: int, marker: int) -> Iterator[int]:
        """Yield the vertices that follow, up to one where the chain ends."""
        while len(around := at[vertex]) == 2:
            ahead = next((i for i in around if left[i] and markers[i] == marker), None)
            if ahead is None:
                return
            left[ahead] = False
            vertex = sum(segments[ahead]) - vertex
            yield vertex

    for i, (a, b) in enumerate(segments):
        if not left[i]:
            continue
        left[i] = False
        back = list(follow(a, markers[i]))
        chain = [*back[::-1], a, b, *follow(b, markers[i])]
        line = points[chain]
        if (np.diff(line, axis=0) != 0).any():
            yield Curve.polyline(line), markers[i]
