"""What a reader finds in a drawing: its curves, and what else it says about them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError

Points = NDArray[np.float64]

MAX_CURVES = 100_000
"""Curves of one drawing at which reading stops; blocks within blocks multiply."""
MAX_POINTS = 100_000
"""Points of straight lines in one drawing beyond which it is refused."""
LARGEST = 1e100
"""Coordinates from here on would overflow in areas."""


@dataclass(frozen=True)
class DrawnCurve:
    """One curve of a drawing.

    Attributes:
        curve: where it runs.
        layer: the layer or group that it belongs to; "" if the drawing has none.
        name: its own name, "" if it has none that says something.
    """

    curve: Curve
    layer: str = ""
    name: str = ""


@dataclass(frozen=True)
class DrawnArea:
    """An area that the file itself states, as GeoJSON does: rings, by even-odd.

    Attributes:
        rings: closed chains of curves.
        name: of the area, "" if it has none.
        layer: as in :class:`DrawnCurve`.
    """

    rings: tuple[tuple[Curve, ...], ...]
    name: str = ""
    layer: str = ""


@dataclass
class Drawing:
    """All that was read.

    Attributes:
        curves: in the order of the file.
        areas: what is material, where the file says so; None: loops are nested by even-odd.
        holes: (n, 2) points in holes; with them all that is enclosed and holds no such point is
            material, as in Triangle's files. None: not said.
        labels: names of regions, each with a point (2,) in it.
        ignored: how many things of which kind were left out.
        notes: sentences, without full stop, on what was repaired or read in another way.
        units: of the coordinates, "" if not said.
    """

    curves: list[DrawnCurve] = field(default_factory=list)
    areas: list[DrawnArea] | None = None
    holes: Points | None = None
    labels: list[tuple[str, Points]] = field(default_factory=list)
    ignored: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)
    units: str = ""

    def add(self, curve: Curve | None, layer: str = "", name: str = "") -> None:
        """Append a curve, if it is one.

        Raises:
            MeshError: there are too many.
        """
        if curve is None:
            return
        if len(self.curves) >= MAX_CURVES:
            raise MeshError(f"it has more than {MAX_CURVES:,} lines and curves")
        self.curves.append(DrawnCurve(curve, layer, name))


def polyline(points: ArrayLike) -> Curve | None:
    """The polyline through points (n, 2); None if it has no length.

    Raises:
        MeshError: a coordinate is not a finite number; too many points.
    """
    line = np.array(points, dtype=np.float64).reshape(-1, 2)
    if len(line) > MAX_POINTS:
        raise MeshError(
            f"it has {len(line):,} points, and {MAX_POINTS:,} are the most that are read"
        )
    if not (np.abs(line) < LARGEST).all():
        raise MeshError("a coordinate is not a finite number")
    if len(line) < 2 or not (np.diff(line, axis=0) != 0).any():
        return None
    return Curve.polyline(line)


def counted(number: int, noun: str, nouns: str = "") -> str:
    """A number with its noun, in the plural where it must be."""
    return f"{number:,} {noun if number == 1 else nouns or noun + 's'}"


def place_words(point: ArrayLike) -> str:
    """A place for a sentence."""
    x, y = (float(value) + 0.0 for value in np.asarray(point))
    return f"({x:.6g}, {y:.6g})"


def listed(words: Sequence[str], most: int = 8) -> str:
    """Words with commas between them; the first ones where there are many."""
    shown = list(words[:most])
    if len(words) > most:
        shown.append(f"and {len(words) - most:,} more")
    return ", ".join(shown)
