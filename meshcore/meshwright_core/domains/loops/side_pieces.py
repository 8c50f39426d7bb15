"""Pieces of the sides of a domain: curves in closed chains, cut where they have corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwright_core.curves.curve import Curve, polygon_area
from meshwright_core.curves.many_curves import end_tangents, points_at
from meshwright_core.domains.loops.ring_checks import LARGEST
from meshwright_core.errors import MeshError, capitalised

Points = NDArray[np.float64]

CURVED_CORNER_ANGLE = 1.0
"""Degrees by which the tangent must turn at a corner where a curved piece begins or ends: files
round their numbers, and an arc that is meant to be tangent seldom is so to the last digit."""
GAP = 1e-6
"""Gap between two pieces that is closed, relative to the size of the domain."""
_NO_AREA = 1e-12
_FEW = 5
"""Samples of each curve of a chain that hardly turns."""


@dataclass(frozen=True)
class Piece:
    """A curve of a loop, with the region on its left and the one on its right (-1: outside)."""

    curve: Curve
    name: str
    label: str
    """What messages call the loop that it belongs to."""
    left: int = 0
    right: int = -1

    @property
    def reversed(self) -> Piece:
        """The same, run through the other way."""
        return replace(self, curve=self.curve.reversed, left=self.right, right=self.left)


def is_smooth_piece(curve: Curve) -> bool:
    """Whether it bends: no segment, and no polyline, whose edges are straight."""
    return curve.kind != "polyline" and not curve.straight


def end_directions(curves: Sequence[Curve]) -> Points:
    """(n, 2, 2) unit tangents of n curves at start and end."""
    found = end_tangents(curves)
    for i, end in np.argwhere(~np.isfinite(found).all(axis=2)).tolist():
        # control points that coincide there
        curve = curves[i]
        t, step = (curve.length, -1e-6) if end else (0.0, 1e-6)
        way = (curve.point(t + step * curve.length) - curve.point(t)) * np.sign(step)
        found[i, end] = way / np.hypot(*way)
    return found


def turn_between(come: ArrayLike, go: ArrayLike) -> float:
    """Degrees from direction `come` to `go` (2,), counter-clockwise, in (-180, 180]."""
    (a, b), (c, d) = np.asarray(come, float), np.asarray(go, float)
    return float(np.degrees(np.arctan2(a * d - b * c, a * c + b * d)))


def angle_at_corner(one: Curve, other: Curve, corner_angle: float) -> float:
    """Degrees by which the boundary must turn where these two curves meet to have a corner."""
    if is_smooth_piece(one) or is_smooth_piece(other):
        return max(corner_angle, CURVED_CORNER_ANGLE)
    return corner_angle


def cut_at_corners(piece: Piece, corner_angle: float) -> list[Piece]:
    """The piece in parts that have no corners inside."""
    if piece.curve.kind in ("line", "arc", "ellipse") or not len(piece.curve.kinks):
        return [piece]
    kinks = piece.curve.kinks
    ends = end_directions(piece.curve.split(kinks))
    least = angle_at_corner(piece.curve, piece.curve, corner_angle)
    turns = [abs(turn_between(a[1], b[0])) for a, b in pairwise(ends)]
    corners = kinks[np.array(turns) > least]
    parts = piece.curve.split(corners) if len(corners) else (piece.curve,)
    return [replace(piece, curve=part) for part in parts]


def extent(loops: Sequence[Sequence[Curve]]) -> float:
    """Diagonal of the box around curves; 0 without any."""
    boxes = np.array([curve.box for loop in loops for curve in loop])
    if not len(boxes):
        return 0.0
    return float(np.hypot(*(boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0))))


def closed_chain(
    curves: Sequence[Curve], names: Sequence[str], label: str, size: float
) -> list[Piece]:
    """The pieces of one loop, each beginning exactly where the one before it ends.

    Args:
        curves: end to end; gaps up to 1e-6 of `size` are closed.
        names: of the curves.
        label: what to call the loop in messages.
        size: of the whole domain.

    Raises:
        MeshError: no curve, numbers that are not finite, a gap, no area.
    """
    if not len(curves) or not all(isinstance(curve, Curve) for curve in curves):
        raise MeshError(f"{capitalised(label)} is not a list of curves.")
    if len(names) != len(curves):
        raise MeshError(f"{len(names)} names for the {len(curves)} pieces of {label}.")
    for curve in curves:
        if not (np.abs(curve.box) < LARGEST).all():
            raise MeshError(f"A piece of {label} reaches places that are not finite.")
    joints = []
    for i, curve in enumerate(curves):
        before = curves[i - 1]
        gap = float(np.hypot(*(curve.start - before.end)))
        if gap > GAP * size:
            (x, y), (z, w) = before.end, curve.start
            raise MeshError(
                f"{capitalised(label)} is not closed: a gap of {gap:.3g} between"
                f" ({x:.6g}, {y:.6g}) and ({z:.6g}, {w:.6g})."
            )
        # straight pieces keep their direction: the ends of others move
        joints.append(curve.start if curve.straight and not before.straight else before.end)
    joints.append(joints[0])
    pieces = []
    for curve, name, (start, end) in zip(curves, names, pairwise(joints), strict=True):
        if (start == end).all() and np.hypot(*(curve.end - curve.start)) > GAP * size:
            continue
        pieces.append(Piece(curve.moved_ends(start, end), str(name), label))
    area = polygon_area([piece.curve for piece in pieces])
    if abs(area) <= _NO_AREA * size * size:
        raise MeshError(f"{capitalised(label)} encloses no area.")
    return pieces


def reversed_chain(pieces: Sequence[Piece]) -> list[Piece]:
    """A chain run through the other way."""
    return [piece.reversed for piece in reversed(pieces)]


def sample_parameters(curve: Curve, turn_degrees: float) -> NDArray[np.float64]:
    """(n,) parameters, both ends among them, between which it turns by `turn_degrees` at most."""
    stops = curve.stops
    if curve.kind in ("line", "polyline"):
        return stops
    if curve.kind == "arc":
        count = max(1, int(np.ceil(np.degrees(abs(curve.data["sweep"])) / turn_degrees - 1e-9)))
        found = np.arange(count + 1) * (stops[-1] / count)
        found[-1] = stops[-1]
        return found
    dense = (stops[:-1, None] + np.diff(stops)[:, None] * np.linspace(0.0, 1.0, 17)[:-1]).ravel()
    dense = np.append(dense, stops[-1])
    inner = 0.5 * (dense[:-1] + dense[1:])
    with np.errstate(invalid="ignore"):
        direction = np.nan_to_num(curve.tangent(inner))
    angle = np.arctan2(direction[:, 1], direction[:, 0])
    turn = np.concatenate([[0.0], np.cumsum(np.abs(np.angle(np.exp(1j * np.diff(angle))))), [0.0]])
    turn[-1] = turn[-2]
    total = float(turn[-1]) * (1.0 + 1.0 / len(inner))
    count = max(1, int(np.ceil(np.degrees(total) / turn_degrees)))
    # turning and length count alike: nearly straight stretches of splines are sampled too
    measure = turn / max(float(turn[-1]), 1e-300) + np.linspace(0.0, 1.0, len(turn)) * 0.25
    return np.unique(np.interp(np.linspace(0.0, measure[-1], count + 1), measure, dense))


def samples(curves: Sequence[Curve], turn_degrees: float) -> list[Points]:
    """(n, 2) points of each curve at its :func:`sample_parameters`."""
    return points_at(curves, [sample_parameters(curve, turn_degrees) for curve in curves])


def sampled_chains(chains: Sequence[Sequence[Curve]], turn_degrees: float = 5.0) -> list[Points]:
    """(n, 2) points along each closed chain of curves, at least three, the first one once."""
    rows = [points[:-1] for points in samples([c for chain in chains for c in chain], turn_degrees)]
    stops = np.cumsum([0, *map(len, chains)]).tolist()
    found = [np.concatenate(rows[low:high]) for low, high in pairwise(stops)]
    return [
        points if len(points) > 2 else _evenly(chain)
        for points, chain in zip(found, chains, strict=True)
    ]


def _evenly(chain: Sequence[Curve]) -> Points:
    """Some points along each of a few curves that hardly turn, the ends of the chain once."""
    parts = [np.linspace(0.0, sample_parameters(curve, 360.0)[-1], _FEW) for curve in chain]
    return np.concatenate([points[:-1] for points in points_at(chain, parts)])
