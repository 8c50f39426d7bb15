"""Initial guesses for untangling: starting positions of a region.

Each start changes the positions of a region in place; the energy is minimised from there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from meshwright_core.geometry.quality import TOLERANCE
from meshwright_core.geometry.movable_part import Region
from meshwright_core.geometry.sides import in_order
from meshwright_core.geometry.unfixable import turns

TANGLED = 0.1
"""Share of inverted elements above which the present positions are not tried first."""
SCATTERED, SMALL = 4, 500
"""Random starts after all others, for regions of so many elements at most."""

Start = Callable[[Region], None]


def starts(region: Region, rng: np.random.Generator) -> list[Start]:
    """The initial guesses in order: the present positions first, unless many are inverted."""
    tangled = region.inverted_rows().mean() > TANGLED
    first: list[Start] = [_embedded, _present] if tangled else [_present, _embedded]
    more = SCATTERED if len(region.elements) <= SMALL else 0
    return [*first, _spread, *(_scattered(rng, 0.01 * (i + 1)) for i in range(more))]


def _present(region: Region) -> None:
    """Start from where the vertices are."""


def _embedded(region: Region) -> None:
    """Start from every vertex at the mean of its neighbours, those on sides where they are."""
    # here, because few meshes need it and it takes a quarter of a second
    from scipy.sparse import coo_matrix, diags
    from scipy.sparse.linalg import splu

    n = len(region.vertices)
    a = region.elements.ravel()
    b = np.roll(region.elements, -1, axis=1).ravel()
    ones = np.ones(len(a))
    links = coo_matrix((ones, (a, b)), (n, n)).tocsr()
    links = ((links + links.T) > 0).astype(np.float64)
    free = region.free
    if not free.any():
        return
    degree = np.asarray(links.sum(axis=1)).ravel()
    inner = diags(degree[free]) - links[free][:, free]
    outer = links[free][:, ~free] @ region.points[~free]
    region.points[free] = splu(inner.tocsc()).solve(outer)


def _spread(region: Region) -> None:
    """Start from boundary vertices spread evenly on their sides, the others at means."""
    for run in region.runs():
        even = np.linspace(run.low, run.high, len(run.members) + 2)[1:-1]
        region.seats.parameter[run.members] = even - run.shift
    hold_single_quads(region)
    _embedded(region)


def _single(region: Region) -> np.ndarray:
    """(n,) bool: sliding vertices of one quad only; they must sit at a bend of their side."""
    if region.elements.shape[1] == 3:
        return np.zeros(len(region.vertices), bool)
    uses = np.bincount(region.elements.ravel(), minlength=len(region.vertices))
    single: np.ndarray = region.sliding & (uses == 1)
    return single


def hold_single_quads(region: Region) -> Region:
    """Bring boundary vertices of a single quad to bends of their side, where they are not flat.

    Returns the region, on the same positions, with those vertices held: along a straight piece the
    energy does not see where its ends are.
    """
    single = _single(region)
    if not single.any():
        return region
    t, held = region.seats.parameter, []
    for run in region.runs():
        if not single[run.members].any():
            continue
        now = t[run.members] + run.shift
        bends = _outward_bends(region, int(region.seats.side[run.members[0]]))
        bends = bends[(bends > run.low) & (bends < run.high)]
        corners = np.flatnonzero(single[run.members])
        chosen = _nearest_in_order(now[corners], bends)
        corners = corners[: len(chosen)]
        anchors = [-1, *corners.tolist(), len(now)]
        ends = [run.low, *chosen.tolist(), run.high]
        now[corners] = chosen
        for a, b, low, high in zip(anchors, anchors[1:], ends, ends[1:], strict=False):
            piece = np.concatenate([[low], now[a + 1 : b], [high]])
            now[a + 1 : b] = in_order(piece, high - low)[1:-1]
        t[run.members] = now - run.shift
        held.extend(run.members[corners].tolist())
    region.settle()
    return region.holding(held)


def _nearest_in_order(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(min(n, p),) increasing ones of `places` (p,), each near one of the `values` (n,) in
    order.
    """
    chosen, first = [], 0
    count = min(len(values), len(places))
    for i in range(count):
        last = len(places) - (count - i)  # leaves enough for the values that follow
        best = first + int(np.argmin(np.abs(places[first : last + 1] - values[i])))
        chosen.append(places[best])
        first = best + 1
    return np.array(chosen)


def _outward_bends(region: Region, side: int) -> np.ndarray:
    """(b,) arc lengths where a side turns outwards; on closed sides of two rounds."""
    assert region.frame is not None
    sides = region.sides
    rows = slice(sides.first[side], sides.first[side + 1])
    angles = turns(sides.points[rows] @ region.frame[:2].T, bool(sides.closed[side]))
    arc = sides.arc[rows][1 : len(angles) + 1]
    bends: np.ndarray = arc[angles > TOLERANCE]
    return np.concatenate([bends, bends + sides.arc[rows][-1]]) if sides.closed[side] else bends


def _scattered(rng: np.random.Generator, share: float) -> Start:
    """Start from the means, each moved at random by `share` of the region's size or so."""

    def start(region: Region) -> None:
        assert region.frame is not None
        _spread(region)
        free = np.flatnonzero(region.free)
        size = np.ptp(region.points, axis=0).max() * share
        region.points[free] += size * rng.standard_normal((len(free), 2)) @ region.frame[:2]

    return start
