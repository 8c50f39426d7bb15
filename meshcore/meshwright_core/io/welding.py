"""Merges points at the same place: of formats without shared points, and of parts that touch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.components import components as parts_of_graph
from meshwright_core.core.construction import halves_of, twins_of
from meshwright_core.errors import MeshError
from meshwright_core.io import cleaning
from meshwright_core.io.content import Content
from meshwright_core.io.surface import Ints, renumbered, restricted

_NEAR = 1e-6
"""Points nearer to each other than this part of the mesh's size are at the same place."""
_FOLDED = 0.99
"""Cosine beyond which two elements that meet in an edge lie on one another."""


def welded(content: Content, everywhere: bool) -> Content:
    """The content with points at the same place merged where that joins what was apart.

    everywhere: all such points, as formats without shared points need it; elements that lose a
    corner are dropped, with a line. Otherwise only those on the rims of different components, and
    only if the result is a manifold that does not lie on itself.
    """
    if everywhere:
        return _welded_everywhere(content)
    label = components(content)
    if label is None or label.max() == 0:
        return content
    rim = _rim_points(content)
    if not len(rim):
        return content
    number = np.arange(len(content.points))
    near = _near_pairs(content.points, rim, _tolerance(content, rim))
    near = near[label[near[:, 0]] != label[near[:, 1]]]
    if not len(near):
        return content
    number = _merged_numbers(near, len(content.points))
    first = np.unique(number)
    place = np.searchsorted(first, number)
    found = renumbered(content, place, first)
    merged = len(number) - len(first)
    parts = int(label.max()) + 1
    after = components(found)
    left = 1 if after is None else int(after.max()) + 1
    if reason := _unsound(found, content):
        said = (
            f"{merged} pairs of points of its {parts} separate parts are at the same places; they "
            f"are left apart, since {reason}"
        )
        return content._replace(warnings=(*content.warnings, said))
    what = "pairs of points at the same place are" if merged > 1 else "pair of points is"
    said = f"{merged} {what} merged, so that {parts} parts become {left}"
    return found._replace(warnings=(*content.warnings, said))


def _welded_everywhere(content: Content) -> Content:
    points = content.points + 0.0  # so that -0.0 is 0.0
    _, exact, inverse = np.unique(points, axis=0, return_index=True, return_inverse=True)
    number = exact[inverse.ravel()]
    near = _near_pairs(points, exact, _NEAR * _size(points))
    close = len(near)
    if close:
        merged = _merged_numbers(near, len(points))
        number = merged[number]
    first = np.unique(number)
    place = np.searchsorted(first, number)
    found = renumbered(content, place, first)
    said = list(content.warnings)
    if close:
        apart = len(exact) - len(first)
        said.append(
            f"{apart} point{'s' if apart > 1 else ''} that differ by rounding only are merged"
        )
    kept = {}
    lost = 0
    for kind, block in found.cells.items():
        order = np.sort(block, axis=1)
        sound = (order[:, 1:] != order[:, :-1]).all(axis=1)
        lost += int((~sound).sum())
        kept[kind] = np.flatnonzero(sound)
    if lost:
        found = restricted(found, kept)
        noun = "elements of no area are" if lost > 1 else "element of no area is"
        said.append(f"{lost} {noun} left out")
    if not any(len(block) for block in found.cells.values()):
        raise MeshError("all its elements have no area")
    return found._replace(warnings=tuple(said))


def _size(points: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0


def _near_pairs(points: NDArray[np.float64], among: Ints, near: float) -> Ints:
    """Pairs (p, 2) of points among these that are nearer than `near`."""
    from scipy.spatial import cKDTree

    if len(among) < 2:
        return np.zeros((0, 2), np.int64)
    tree = cKDTree(points[among])
    ball = tree.query(points[among], 2, distance_upper_bound=max(near, np.finfo(float).tiny))[0]
    if not np.isfinite(ball[:, 1]).any():
        return np.zeros((0, 2), np.int64)
    close = among[np.isfinite(ball[:, 1])]
    pairs = cKDTree(points[close]).query_pairs(near, output_type="ndarray")
    return np.asarray(close[pairs], np.int64).reshape(-1, 2)


def _merged_numbers(pairs: Ints, count: int) -> Ints:
    """The lowest of the points that each point (count,) is one with by the pairs."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    ones = np.ones(len(pairs), np.int8)
    links = coo_array((ones, (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    label = connected_components(links, directed=False)[1]
    lowest = np.full(int(label.max()) + 1, count)
    np.minimum.at(lowest, label, np.arange(count))
    return lowest[label]


def _tolerance(content: Content, rim: Ints) -> float:
    """A part of the size, and much less than any edge."""
    shortest = np.inf
    for block in content.cells.values():
        edge = content.points[block] - content.points[np.roll(block, -1, axis=1)]
        lengths = np.linalg.norm(edge, axis=2)
        positive = lengths[lengths > 0]
        shortest = min(shortest, float(positive.min()) if len(positive) else np.inf)
    return min(_NEAR * _size(content.points[rim]), 0.1 * shortest)


def sides_of(content: Content) -> Ints:
    """The sides (s, 2) of all elements, one after the other."""
    return np.concatenate(
        [
            np.stack([block, np.roll(block, -1, axis=1)], axis=2).reshape(-1, 2)
            for block in content.cells.values()
        ]
    )


def components(content: Content) -> Ints | None:
    """The connected component of each point (n,), numbered in order; of none an own one, behind."""
    ends, count = sides_of(content), len(content.points)
    return parts_of_graph(ends[:, 0], ends[:, 1], count)[1] if count else None


def _rim_points(content: Content) -> Ints:
    ends = np.sort(sides_of(content), axis=1)
    key = ends[:, 0] * len(content.points) + ends[:, 1]
    _, first, times = np.unique(key, return_index=True, return_counts=True)
    return np.unique(ends[first[times == 1]])


def _unsound(found: Content, before: Content) -> str:
    """Why points must not be merged: empty if they may."""
    for block in found.cells.values():
        order = np.sort(block, axis=1)
        if (order[:, 1:] == order[:, :-1]).any():
            return "an element would lose a corner"
    ends = np.sort(sides_of(found), axis=1)
    count = len(found.points)
    _, inverse, times = np.unique(
        ends[:, 0] * count + ends[:, 1], return_inverse=True, return_counts=True
    )
    if (times > 2).any():
        return "more than two elements would share an edge"
    if len(found.cells) == 1:
        (block,) = found.cells.values()
        try:
            turned = cleaning.oriented(found.points, block)
            halves_of(turned, twins_of(turned), count)
        except MeshError:
            return "the result would not be a manifold"
    owner = np.concatenate(
        [
            np.repeat(np.arange(len(block)) + first, block.shape[1])
            for block, first in zip(
                found.cells.values(),
                np.cumsum([0, *(len(block) for block in found.cells.values())]),
                strict=False,
            )
        ]
    )
    old = np.sort(sides_of(before), axis=1)
    _, old_inverse, old_times = np.unique(
        old[:, 0] * len(before.points) + old[:, 1], return_inverse=True, return_counts=True
    )
    fresh = (times[inverse.ravel()] == 2) & (old_times[old_inverse.ravel()] == 1)
    rows = np.flatnonzero(fresh)
    if not len(rows):
        return ""
    pairs = rows[np.argsort(inverse.ravel()[rows], kind="stable")].reshape(-1, 2)
    centre = np.concatenate([found.points[block].mean(axis=1) for block in found.cells.values()])
    a, b = found.points[ends[pairs[:, 0], 0]], found.points[ends[pairs[:, 0], 1]]
    along = (b - a) / np.maximum(np.linalg.norm(b - a, axis=1), 1e-300)[:, None]
    sides = []
    for column in (0, 1):
        out = centre[owner[pairs[:, column]]] - a
        out -= (out * along).sum(axis=1)[:, None] * along
        sides.append(out / np.maximum(np.linalg.norm(out, axis=1), 1e-300)[:, None])
    if ((sides[0] * sides[1]).sum(axis=1) > _FOLDED).any():
        return "they would lie on one another"
    return ""
