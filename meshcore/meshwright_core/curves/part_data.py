"""The numbers that define parts and images of curves, from their Bezier spans."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def part_of_conic(axes: Array, data: dict[str, Any], spans: list[Array]) -> dict[str, Any]:
    """The data of a part of an arc of a circle or ellipse.

    Args:
        axes: (2, 2) rows: the half diameters at angles 0 and 90 degrees.
        data: of the whole.
        spans: of the part.
    """
    ends = np.array([spans[0][0, :2] / spans[0][0, 3], spans[-1][-1, :2] / spans[-1][-1, 3]])
    local = np.linalg.solve(axes.T, (ends - data["centre"]).T).T
    first, last = np.arctan2(local[:, 1], local[:, 0]).tolist()
    turn = math.copysign(2.0 * math.pi, data["sweep"])
    # both angles on the way from the old start to the old end, which may touch either
    begin = math.fmod(first - data["start"], turn)
    begin += turn if begin * turn < 0.0 else 0.0
    if abs(begin - turn) < 1e-9:
        begin = 0.0
    stop = math.fmod(last - data["start"], turn)
    stop += turn if stop * turn < 0.0 else 0.0
    if abs(stop) <= abs(begin) + 1e-12:
        stop += turn
    return dict(data, start=data["start"] + begin, sweep=stop - begin)


def image_of_conic(axes: Array, data: dict[str, Any], affine: Array) -> tuple[str, dict[str, Any]]:
    """Kind and data of the image of an arc under an affine map (2, 3).

    A circle stays one under similarities only.
    """
    centre = affine[:, :2] @ data["centre"] + affine[:, 2]
    images = axes @ affine[:, :2].T
    scale = float(np.linalg.norm(images[0]))
    across = np.array([-images[0, 1], images[0, 0]])
    flips = bool(images[1] @ across < 0.0)
    circle = "radius" in data
    if circle and np.abs(images[1] - (-across if flips else across)).max() <= 1e-12 * scale:
        turned = float(np.arctan2(images[0, 1], images[0, 0]))
        sign = -1.0 if flips else 1.0
        return "arc", {
            "centre": centre, "radius": scale,
            "start": turned + sign * data["start"], "sweep": sign * data["sweep"],
        }  # fmt: skip
    return "ellipse", {
        "centre": centre, "major": images[0], "minor": images[1],
        "start": data["start"], "sweep": data["sweep"],
    }  # fmt: skip


def spline_of_spans(spans: list[Array]) -> dict[str, Any]:
    """Spans of one degree as a B-spline whose knots have the multiplicity of the degree.

    The ends of neighbouring spans may have different weights: each span is scaled to the one
    before it, which does not change its points.
    """
    degree = len(spans[0]) - 1
    rows, scale = [spans[0]], 1.0
    for before, after in pairwise(spans):
        scale *= before[-1, 3] / after[0, 3]
        rows.append(after[1:] * scale)
    control = np.concatenate(rows)
    knots = np.arange(len(spans) + 1, dtype=np.float64)
    weights = control[:, 3]
    return {
        "degree": degree,
        "control": control[:, :2] / weights[:, None],
        "knots": np.concatenate([[0.0], np.repeat(knots, degree), knots[-1:]]),
        "weights": None if (weights == 1.0).all() else weights,
    }
