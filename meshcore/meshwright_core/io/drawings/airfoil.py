"""Coordinates of airfoils (.dat), in Selig's order or Lednicer's, as smooth splines.

Selig's files run from the trailing edge over the upper side to the leading edge and back along the
lower side; Lednicer's give the number of points of each side and then each side from the leading
edge (https://m-selig.ae.illinois.edu/ads/coord_database.html). The curve is a cubic spline through
the points; the trailing edge is a corner, or two with a segment between them where it is blunt.
"""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import LARGEST, Drawing, Points

_TECPLOT = re.compile(rb"^\s*(?:TITLE|VARIABLES|ZONE|FILETYPE|TEXT|GEOMETRY|#!TDV)\b", re.I | re.M)
_SHARP = 75.0
"""Degrees by which the points turn where a side has a corner; a coarse nose turns less."""
_BLUNT = 1e-6
"""Ends of the two sides nearer than this share of the chord are one point."""


def is_airfoil(head: bytes) -> bool:
    """Whether the beginning of a .dat file is one of coordinates, and not Tecplot's."""
    if _TECPLOT.search(head) or b"\0" in head:
        return False
    lines = head.splitlines()
    return sum(_pair(line) is not None for line in lines[1:6]) >= min(3, len(lines) - 1) > 0


def read(content: bytes) -> Drawing:
    """Return the outline of the airfoil in a file.

    Raises:
        MeshError: with the line, where it holds no coordinates.
    """
    points, notes = _points(content)
    drawing = Drawing(notes=notes)
    chord = float(np.ptp(points, axis=0).max())
    if (np.hypot(*(points[0] - points[-1]))) <= _BLUNT * chord:
        points = np.vstack([points[:-1], points[:1]])
    for first, last in _stretches(points):
        drawing.add(Curve.through(points[first : last + 1]), "", "airfoil")
    if (points[0] != points[-1]).any():
        drawing.add(Curve.line(points[-1], points[0]), "", "trailing edge")
    return drawing


def _pair(line: bytes) -> tuple[float, float] | None:
    words = line.replace(b",", b" ").split()
    if len(words) != 2:
        return None
    try:
        x, y = float(words[0]), float(words[1])
    except ValueError:
        return None
    return (x, y) if max(abs(x), abs(y)) < LARGEST else None


def _points(content: bytes) -> tuple[Points, list[str]]:
    """The points in order around the airfoil, from the trailing edge."""
    lines = content.removeprefix(b"\xef\xbb\xbf").splitlines()
    rows: list[tuple[float, float]] = []
    for i, line in enumerate(lines, 1):
        pair = _pair(line)
        if pair is None:
            if rows and line.strip():
                shown = repr(line.strip().decode("utf-8", "replace")[:20])
                raise MeshError(f"line {i}: {shown} stands where two coordinates were expected")
            continue
        rows.append(pair)
    if len(rows) < 4:
        raise MeshError(f"it has {len(rows)} points; an airfoil needs at least 4")
    counts = rows[0]
    lednicer = min(counts) > 1.5 and all(abs(value - round(value)) < 1e-9 for value in counts)
    if not lednicer:
        return np.array(rows), []
    upper, lower = (round(value) for value in counts)
    if upper + lower != len(rows) - 1 or min(upper, lower) < 2:
        raise MeshError(f"it states {upper} and {lower} points, but has {len(rows) - 1}")
    points = np.array(rows[1:])
    over, under = points[:upper], points[upper:]
    shared = bool((over[0] == under[0]).all())
    return np.vstack([over[::-1], under[1:] if shared else under]), []


def _stretches(points: Points) -> list[tuple[int, int]]:
    """First and last point of each smooth stretch."""
    steps = np.diff(points, axis=0)
    before, after = steps[:-1], steps[1:]
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turn = np.abs(np.degrees(np.arctan2(across, (before * after).sum(axis=1))))
    corners = [0, *(np.flatnonzero(turn > _SHARP) + 1).tolist(), len(points) - 1]
    return list(pairwise(corners))
