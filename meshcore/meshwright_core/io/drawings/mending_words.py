"""What was mended in a drawing, as sentences with places."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from meshwright_core.io.drawings.drawn import Points, counted, place_words
from meshwright_core.io.drawings.gaps import Repair
from meshwright_core.io.drawings.network import Network

_TOLD = 1e-7
"""Share of the drawing's size from which on it is told that ends were moved."""
_MOST = 8
"""Repairs of a kind that are told one by one."""
_KINDS = (
    ("gap", "a gap of {size} closed at {place}", "gaps closed"),
    ("reach", "an end {size} off drawn to the next curve at {place}", "ends drawn on"),
    ("hair", "a loose end of length {size} left out at {place}", "short loose ends left out"),
)


def mending_words(
    mends: Sequence[Repair],
    network: Network,
    kept: Collection[int],
    between: Collection[int],
    size: float,
    tolerance: float,
) -> list[str]:
    """Return a sentence for each thing that was mended where it is a part of a boundary.

    Args:
        mends: what was done at loose ends.
        network: of the drawing.
        kept: edges that bound something.
        between: edges between two regions: they are drawn twice on purpose.
        size: of the drawing.
        tolerance: below which lines and curves are too short.
    """
    ends = {node for i in kept for node in (network.edges[i].a, network.edges[i].b)}
    nodes = network.nodes[sorted(ends)]
    found = []
    for kind, text, texts in _KINDS:
        told = [
            mend
            for mend in mends
            if mend.kind == kind
            and (kind == "hair" or _nearest(nodes, mend.place) <= 3 * mend.size + tolerance)
        ]
        for mend in told[:_MOST]:
            found.append(text.format(size=f"{mend.size:.3g}", place=place_words(mend.place)))
        if len(told) > _MOST:
            found.append(f"{len(told) - _MOST} more {texts}")
    moved = network.moved[network.moved > _TOLD * size]
    if len(moved):
        found.append(
            f"{counted(len(moved), 'end')} moved by up to {moved.max():.2g} to meet others"
        )
    if network.hairs:
        found.append(f"{_curves(network.hairs)} shorter than {tolerance:.2g} left out")
    double = [network.edges[i] for i in sorted(kept) if i not in between]
    double = [edge for edge in double if len(edge.owners) > 1]
    if double:
        place = place_words(double[0].curve.start)
        verb = "counts" if len(double) == 1 else "count"
        found.append(
            f"{_curves(len(double))} drawn more than once {verb} once, the first at {place}"
        )
    return found


def _curves(count: int) -> str:
    return counted(count, "line or curve", "lines and curves")


def _nearest(nodes: Points, place: Points) -> float:
    return float(np.hypot(*(nodes - place).T).min()) if len(nodes) else np.inf
