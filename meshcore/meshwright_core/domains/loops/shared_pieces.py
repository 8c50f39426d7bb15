"""Finds where the loops of several regions run along each other: the interfaces of the regions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.time_limit import check_time
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.domains.loops.side_pieces import GAP, Piece
from meshwright_core.errors import MeshError, capitalised

Points = NDArray[np.float64]

_MIDDLES = np.array([0.25, 0.5, 0.75])


def cut_at_ends(pieces: Sequence[Piece], size: float) -> list[Piece]:
    """Pieces cut where a piece of another region begins or ends on them.

    Ends that are nearly the same, within 2e-6 of `size`, become the same.
    """
    return _with_exact_ends(_cut(pieces, size), size)


def merged(pieces: Sequence[Piece], size: float) -> list[Piece]:
    """Pieces of which each two that run along each other are one, with a region on each side.

    Raises:
        MeshError: two regions are on the same side of a piece, or one is on both sides.
    """
    groups: dict[tuple[tuple[float, ...], ...], list[Piece]] = {}
    for piece in pieces:
        ends = [tuple(piece.curve.start.tolist()), tuple(piece.curve.end.tolist())]
        groups.setdefault(tuple(sorted(ends)), []).append(piece)
    found: list[Piece] = []
    for group in groups.values():
        while group:
            piece, rest = group[0], group[1:]
            along = [other for other in rest if _same(piece.curve, other.curve, size)]
            group = [other for other in rest if not any(other is one for one in along)]
            found.append(_merged(piece, along))
    return found


def _merged(piece: Piece, along: list[Piece]) -> Piece:
    if not along:
        return piece
    other = along[0]
    x, y = piece.curve.point(0.5 * piece.curve.length)
    place = f"near ({x:.6g}, {y:.6g})"
    if piece.left == other.left:
        if piece.label == other.label:
            raise MeshError(f"{capitalised(piece.label)} runs twice along itself {place}.")
        raise MeshError(f"{capitalised(other.label)} runs along {piece.label} {place}.")
    if len(along) > 1 or _same_way(piece.curve, other.curve):
        raise MeshError(
            f"The regions overlap: {piece.label} and {along[-1].label} lie on the same side of a"
            f" curve {place}."
        )
    return replace(piece, right=other.left, name=piece.name or other.name)


def _cut(pieces: Sequence[Piece], size: float) -> list[Piece]:
    """Pieces cut at the ends of those of other regions that lie on them."""
    ends = np.array([[piece.curve.start, piece.curve.end] for piece in pieces]).reshape(-1, 2)
    owner = np.repeat([piece.left for piece in pieces], 2)
    tree = shapely.STRtree(shapely.points(ends))
    found: list[Piece] = []
    for piece in pieces:
        check_time()
        curve = piece.curve
        margin = GAP * size
        box = shapely.box(*(curve.box[0] - margin), *(curve.box[1] + margin))
        near = tree.query(box)
        near = near[owner[near] != piece.left]
        cuts: list[float] = []
        if len(near):
            t, distance = curve.project(ends[near])
            inside = (distance <= margin) & (t > margin) & (t < curve.length - margin)
            for at in np.sort(t[inside]).tolist():
                if not cuts or at - cuts[-1] > margin:
                    cuts.append(at)
        parts = curve.split(cuts) if cuts else (curve,)
        found += [replace(piece, curve=part) for part in parts]
    return found


def _with_exact_ends(pieces: Sequence[Piece], size: float) -> list[Piece]:
    """Pieces whose ends, where they are nearly the same, are exactly the same."""
    ends = np.array([[piece.curve.start, piece.curve.end] for piece in pieces]).reshape(-1, 2)
    unique, number = np.unique(ends, axis=0, return_inverse=True)
    number = number.ravel()
    first = np.arange(len(unique))
    spots = shapely.points(unique)
    near = pairs_near(spots, "dwithin", 2.0 * GAP * size)
    np.minimum.at(first, near[1], near[0])
    while (first[first] != first).any():
        first = first[first]
    places = unique[first[number]].reshape(-1, 2, 2)
    found = []
    for piece, (start, end) in zip(pieces, places, strict=True):
        if piece.curve.closed or (start != end).any():  # else too short to be told from a point
            found.append(replace(piece, curve=piece.curve.moved_ends(start, end)))
    return found


def _same(one: Curve, other: Curve, size: float) -> bool:
    """Whether curves with the same two ends run along each other."""
    margin = 2.0 * GAP * size
    return all(
        float(b.project(a.point(_MIDDLES * a.length))[1].max()) <= margin
        for a, b in ((one, other), (other, one))
    )


def _same_way(one: Curve, other: Curve) -> bool:
    """Whether curves that run along each other have the same direction."""
    middle = one.point(0.5 * one.length)
    t, _ = other.project(middle)
    return float(one.tangent(0.5 * one.length) @ other.tangent(float(t[0]))) > 0.0
