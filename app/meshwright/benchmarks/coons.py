"""How often the samples of Coons maps miss a fold: random quads with curved sides, one core.

The corners of a unit square move by up to 0.35, and one to four sides become arcs that turn by up
to 90 or 120 degrees either way, or cubic Bezier curves whose control points are off the chord by up
to 0.4 of it. *Missed* are the quads that are valid at the 5 x 5 samples, but have a point without a
positive Jacobian on a grid of 65 x 65; *deepest* is the smallest sine of the angle between the
derivatives at such a point, and *certified* the share of valid ones that the bound of
:mod:`meshwright_core.geometry.jacobian_bound` certifies from these samples, and from 17 x 17.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwright.console import Update
from meshwright_core.core.composite_curves import place_all, tangents
from meshwright_core.curves.curve import Curve
from meshwright_core.curves.many_curves import flattened
from meshwright_core.geometry.jacobian_bound import jacobian_bound

SUMMARY = "random curved quads: how often the sampled Jacobian misses a fold, and how deep"

QUADS = 1_000
"""Quads of each kind and number of curved sides."""
QUICK = 50
KINDS = (("arcs up to 90", 90.0), ("arcs up to 120", 120.0), ("splines", 0.0))
_FINE = 64
_COARSE, _FINER = 4, 16
_JITTER, _BULGE = 0.35, 0.4
_BATCH = 250

Array = NDArray[np.float64]


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Measure all kinds; quick: few quads."""
    found: dict[str, Any] = {}
    for number, (name, degrees) in enumerate(KINDS):
        for bent in (1, 2, 3, 4):
            update(4 * number + bent - 1, f"{name}, {bent} sides")
            rng = np.random.default_rng((seed, number, bent))
            row = _measured(rng, QUICK if quick else QUADS, bent, degrees)
            found[f"{name}, {bent} sides"] = row
    return found


def _measured(rng: np.random.Generator, count: int, bent: int, degrees: float) -> dict[str, Any]:
    valid = missed = certified = finer = 0
    deepest = 0.0
    for start in range(0, count, _BATCH):
        size = min(_BATCH, count - start)
        corners, sides, bends = _quads(rng, size, bent, degrees)
        p, q = derivatives(corners, sides, _FINE)
        jacobian = p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]
        step = _FINE // _COARSE
        passes = (jacobian[:, ::step, ::step] > 0.0).all(axis=(1, 2))
        folded = passes & (jacobian <= 0.0).any(axis=(1, 2))
        valid, missed = valid + int(passes.sum()), missed + int(folded.sum())
        if folded.any():
            lengths = np.linalg.norm(p[folded], axis=3) * np.linalg.norm(q[folded], axis=3)
            deepest = min(deepest, float((jacobian[folded] / lengths).min()))
        if degrees:
            for parts in (_COARSE, _FINER):
                step = _FINE // parts
                some = [x[:, ::step, ::step].reshape(size, -1, 2) for x in (p, q)]
                safe = jacobian_bound(corners, bends, some[0], some[1], parts) > 0.0
                if (safe & (jacobian <= 0.0).any(axis=(1, 2))).any():
                    raise AssertionError("a quad that the bound certifies is folded")
                certified += int((safe & passes).sum()) if parts == _COARSE else 0
                finer += int((safe & passes).sum()) if parts == _FINER else 0
    row = {
        "quads": count,
        "valid at 5 x 5": valid,
        "missed": missed,
        "missed of valid": round(missed / max(valid, 1), 5),
        "deepest sine": round(deepest, 3),
    }
    if degrees:
        row["certified at 5 x 5"] = round(certified / max(valid, 1), 3)
        row["certified at 17 x 17"] = round(finer / max(valid, 1), 3)
    return row


def _quads(
    rng: np.random.Generator, count: int, bent: int, degrees: float
) -> tuple[Array, list[Curve], Array]:
    """Corners (m, 4, 2), their sides in order, and radius times squared angle of each (m, 4)."""
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    corners = square + rng.uniform(-_JITTER, _JITTER, (count, 4, 2))
    curved = np.argsort(rng.random((count, 4)), axis=1) < bent
    turns = np.radians(rng.uniform(-degrees, degrees, (count, 4)))
    offsets = rng.uniform(-_BULGE, _BULGE, (count, 4, 2))
    sides: list[Curve] = []
    bends = np.zeros((count, 4))
    for i, j in np.ndindex(count, 4):
        a, b = corners[i, j], corners[i, (j + 1) % 4]
        if not curved[i, j]:
            sides.append(Curve.line(a, b))
        elif degrees:
            sides.append(Curve.arc_by_bulge(a, b, float(np.tan(0.25 * turns[i, j]))))
            data = sides[-1].data
            bends[i, j] = data["radius"] * data["sweep"] ** 2 if "radius" in data else 0.0
        else:
            normal = np.array([a[1] - b[1], b[0] - a[0]])
            inner = [a + (b - a) * (k + 1) / 3 + offsets[i, j, k] * normal for k in (0, 1)]
            sides.append(Curve.bezier([a, *inner, b]))
    return corners, sides, bends


def derivatives(corners: Array, sides: list[Curve], parts: int) -> tuple[Array, Array]:
    """X_u and X_v (m, n + 1, n + 1, 2) of Coons maps at the points of a grid, u first.

    Args:
        corners: (m, 4, 2).
        sides: 4 m curves, four for each quad.
        parts: n.
    """
    w = np.linspace(0.0, 1.0, parts + 1)
    count = len(corners)
    length = np.array([side.length for side in sides])
    flat = flattened(sides)
    which = np.repeat(np.arange(len(sides)), len(w))
    t = (length[:, None] * w).ravel()
    place = place_all(flat, which, t)[:, :2].reshape(count, 4, len(w), 2)
    slope = tangents(flat, which, t)[:, :2].reshape(count, 4, len(w), 2)
    slope = slope * length.reshape(count, 4, 1, 1)
    start, chord = corners, np.roll(corners, -1, axis=1) - corners
    d = place - start[:, :, None] - chord[:, :, None] * w[:, None]
    slope = slope - chord[:, :, None]
    v0, v1, v2, v3 = (corners[:, i, None, None] for i in range(4))
    u, v = w[None, :, None, None], w[None, None, :, None]
    # sides 2 and 3 run backwards in u and v
    d0, s0 = d[:, 0, :, None], slope[:, 0, :, None]
    d1, s1 = d[:, 1, None, :], slope[:, 1, None, :]
    d2, s2 = d[:, 2, ::-1, None], slope[:, 2, ::-1, None]
    d3, s3 = d[:, 3, None, ::-1], slope[:, 3, None, ::-1]
    along = (1 - v) * (v1 - v0) + v * (v2 - v3) + (1 - v) * s0 + d1 - v * s2 - d3
    across = (1 - u) * (v3 - v0) + u * (v2 - v1) - d0 + u * s1 + d2 - (1 - u) * s3
    return along, across
