"""Airfoils of the NACA four-digit series, as points and as curves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError

Points = NDArray[np.float64]

CLOSED_EDGE, OPEN_EDGE = -0.1036, -0.1015
"""The last thickness coefficient: trailing edge closed, or 0.21 percent thick at 20 percent."""


def naca4(
    code: str, pieces: int = 14, chord: float = 1.0, trailing_edge: float = CLOSED_EDGE
) -> Points:
    """Return a NACA four-digit airfoil as points from the upper trailing edge on.

    Upper side first, so counter-clockwise. With a closed trailing edge, at (chord, 0), that is the
    first of (2 pieces, 2) points; an open one is the first and the last of (2 pieces + 1, 2).
    Stations follow a cosine, dense at both ends. After Jacobs, Ward and Pinkerton, NACA Report 460
    (1933).

    Args:
        code: four digits: camber in percent, its place in tenths, thickness in percent.
        pieces: edges on each of the two sides.
        chord: length from nose to trailing edge.
        trailing_edge: the last coefficient of the thickness, `CLOSED_EDGE` or `OPEN_EDGE`.

    Raises:
        MeshError: `code` is not four digits, or has no thickness.
    """
    if len(code) != 4 or not code.isascii() or not code.isdigit() or code.endswith("00"):
        raise MeshError(f"A NACA airfoil is named by four digits with a thickness, not {code!r}.")
    camber, place, thickness = int(code[0]) / 100, int(code[1]) / 10, int(code[2:]) / 100
    closed = trailing_edge == CLOSED_EDGE
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, pieces + 1)))
    half = 5 * thickness * x * (-0.1260 - x * (0.3516 - x * (0.2843 + trailing_edge * x)))
    half += 5 * thickness * 0.2969 * np.sqrt(x)
    if closed:
        half[-1] = 0.0
    line, slope = np.zeros_like(x), np.zeros_like(x)
    if camber > 0 and place > 0:
        scale = np.where(x < place, camber / place**2, camber / (1 - place) ** 2)
        line = scale * np.where(
            x < place, 2 * place * x - x**2, 1 - 2 * place + 2 * place * x - x**2
        )
        slope = 2 * scale * (place - x)
    tilt = np.arctan(slope)
    upper = np.column_stack([x - half * np.sin(tilt), line + half * np.cos(tilt)])
    lower = np.column_stack([x + half * np.sin(tilt), line - half * np.cos(tilt)])
    return chord * np.vstack([upper[::-1], lower[1:-1] if closed else lower[1:]])


def airfoil_curves(code: str, blunt: bool = False, pieces: int = 30) -> list[Curve]:
    """Return a NACA four-digit airfoil of chord 1 as a closed loop of curves.

    A spline through points of :func:`naca4` around the nose, and for a blunt trailing edge the
    segment that closes it.

    Args:
        code: as there.
        blunt: whether the trailing edge is open.
        pieces: edges between points on each of the two sides.

    Raises:
        MeshError: as there.
    """
    points = naca4(code, pieces, trailing_edge=OPEN_EDGE if blunt else CLOSED_EDGE)
    if not blunt:
        return [Curve.through(np.vstack([points, points[:1]]))]
    return [Curve.through(points), Curve.line(points[-1], points[0])]
