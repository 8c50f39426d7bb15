"""Outlines that are not closed: where the gap is, and how wide."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import shapely

from meshwright_core.io.drawings.drawn import Points, place_words
from meshwright_core.io.drawings.tracing import measures
from meshwright_core.io.drawings.tracing.network import Network

_OPEN = 0.5
"""Width of all gaps, as a share of the length drawn, up to which lines are an open outline."""
_FLAT = 1e-4
"""Extent, as a share of the drawing's size squared, below which lines are no outline."""
_MOST = 2_000
"""Loose parts, and ends of one, beyond which no gap is looked for."""


@dataclass
class _Part:
    """Connected loose curves: their loose ends (k, 2), length, and some points."""

    ends: list[Points] = field(default_factory=list)
    length: float = 0.0
    points: list[Points] = field(default_factory=list)


def opened(
    network: Network, stray: list[int], largest: float, size: float
) -> list[tuple[str, bool]]:
    """Return a sentence for each outline that is open, and whether it matters for the whole.

    Args:
        network: of the drawing.
        stray: edges of it that enclose nothing.
        largest: area of the largest region; an open outline around more than that matters.
        size: of the drawing.
    """
    parts = _parts(network, stray)[:_MOST]
    found = []
    for group in _grouped(parts):
        ends = np.array([end for part in group for end in part.ends])
        if len(ends) < 2:
            continue
        gaps = _gaps(ends[:_MOST])
        length = sum(part.length for part in group)
        hull = shapely.convex_hull(
            shapely.MultiPoint(np.concatenate([p for part in group for p in part.points]))
        )
        if hull.area < _FLAT * size**2 and largest > 0.0:
            continue
        if sum(width for width, _, _ in gaps) > _OPEN * length and largest > 0.0:
            continue
        width, one, other = max(gaps, key=lambda gap: gap[0])
        serious = hull.area > largest
        what = "the outline is open" if serious else "an inner outline is open"
        more = f" (one of {len(gaps)} gaps)" if len(gaps) > 1 else ""
        text = (
            f"{what}: a line ends at {place_words(one)} and none continues there; the next end, at "
            f"{place_words(other)}, is {width:.6g} away{more}"
        )
        found.append((hull.area, text, serious))
    found.sort(key=lambda entry: -entry[0])
    return [(text, serious) for _, text, serious in found]


def _parts(network: Network, stray: list[int]) -> list[_Part]:
    """Loose curves that hang together, the longest first."""
    degree = network.degrees()
    label: dict[int, int] = {}
    parts: dict[int, _Part] = {}

    def root(node: int) -> int:
        while label.setdefault(node, node) != node:
            label[node] = label[label[node]]
            node = label[node]
        return node

    for i in stray:
        label[root(network.edges[i].a)] = root(network.edges[i].b)
    for i in stray:
        edge = network.edges[i]
        part = parts.setdefault(root(edge.a), _Part())
        part.length += edge.curve.length
        part.points.append(measures.samples(edge.curve, 30.0))
        part.ends += [network.nodes[node] for node in (edge.a, edge.b) if degree[node] == 1]
    return sorted(parts.values(), key=lambda part: -part.length)


def _grouped(parts: list[_Part]) -> list[list[_Part]]:
    """Parts whose ends are each other's nearest, together: pieces of one outline."""
    ends = [(end, i) for i, part in enumerate(parts) for end in part.ends]
    group = list(range(len(parts)))
    if len(ends) > 1:
        from scipy.spatial import cKDTree  # here: it takes half a second, and most are closed

        places = np.array([end for end, _ in ends])
        away, near = cKDTree(places).query(places, k=2)
        # a point at the same place may be listed first
        other = np.where(near[:, 0] == np.arange(len(ends)), near[:, 1], near[:, 0])
        for k, j in enumerate(other.tolist()):
            one, two = ends[k][1], ends[j][1]
            shorter = min(parts[one].length, parts[two].length)
            if other[j] == k and float(away[k, 1]) <= _OPEN * shorter and group[one] != group[two]:
                old, new = group[two], group[one]
                group = [new if label == old else label for label in group]
    found: dict[int, list[_Part]] = {}
    for label, part in zip(group, parts, strict=True):
        found.setdefault(label, []).append(part)
    return list(found.values())


def _gaps(ends: Points) -> list[tuple[float, Points, Points]]:
    """Pairs of ends, the nearest first, with their distances."""
    away = np.hypot(*(ends[:, None] - ends[None]).T)
    i, j = np.triu_indices(len(ends), 1)
    left = np.ones(len(ends), dtype=bool)
    gaps = []
    for k in np.argsort(away[i, j], kind="stable").tolist():
        one, other = int(i[k]), int(j[k])
        if left[one] and left[other]:
            left[[one, other]] = False
            gaps.append((float(away[one, other]), ends[one], ends[other]))
    return gaps
