"""Initial guesses for untangling: starting positions of a part.

Each start changes the positions of a movable part in place; the energy is minimised from there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from meshwright_core.geometry.movable_part import MovablePart

TANGLED = 0.1
"""Share of inverted elements above which the present positions are not tried first."""
SCATTERED, SMALL = 4, 500
"""Random starts after all others, for parts of so many elements at most."""

Start = Callable[[MovablePart], None]


def starts(part: MovablePart, rng: np.random.Generator) -> list[Start]:
    """The initial guesses in order: the present positions first, unless many are inverted."""
    tangled = part.inverted_rows().mean() > TANGLED
    first: list[Start] = [_embedded, as_they_are] if tangled else [as_they_are, _embedded]
    more = SCATTERED if len(part.elements) <= SMALL else 0
    return [*first, spread_and_embedded, *(_scattered(rng, 0.01 * (i + 1)) for i in range(more))]


def as_they_are(part: MovablePart) -> None:
    """Start from where the vertices are."""


def _embedded(part: MovablePart) -> None:
    """Start from every vertex at the mean of its neighbours, those on sides where they are."""
    # here, because few meshes need it and it takes a quarter of a second
    from scipy.sparse import coo_matrix, diags
    from scipy.sparse.linalg import splu

    n = len(part.vertices)
    a = part.elements.ravel()
    b = np.roll(part.elements, -1, axis=1).ravel()
    ones = np.ones(len(a))
    links = coo_matrix((ones, (a, b)), (n, n)).tocsr()
    links = ((links + links.T) > 0).astype(np.float64)
    free = part.free
    if not free.any():
        return
    degree = np.asarray(links.sum(axis=1)).ravel()
    inner = diags(degree[free]) - links[free][:, free]
    outer = links[free][:, ~free] @ part.points[~free]
    part.points[free] = splu(inner.tocsc()).solve(outer)


def spread(part: MovablePart) -> None:
    """Start from boundary vertices spread evenly on their sides, the others where they are."""
    for run in part.runs():
        even = np.linspace(run.low, run.high, len(run.members) + 2)[1:-1]
        part.seats.parameter[run.members] = even - run.shift
    part.settle()


def spread_and_embedded(part: MovablePart) -> None:
    """Start from boundary vertices spread evenly on their sides, the others at means."""
    spread(part)
    hold_single_quads(part)
    _embedded(part)


def _single(part: MovablePart) -> np.ndarray:
    """(n,) bool: sliding vertices of one quad only; they must sit at a bend of their side."""
    if part.elements.shape[1] == 3:
        return np.zeros(len(part.vertices), bool)
    uses = np.bincount(part.elements.ravel(), minlength=len(part.vertices))
    single: np.ndarray = part.sliding & (uses == 1)
    return single


def hold_single_quads(part: MovablePart) -> MovablePart:
    """Bring boundary vertices of a single quad to bends of their side, where they are not flat.

    Returns the part, on the same positions, with those vertices held: along a straight piece the
    energy does not see where its ends are.
    """
    single = _single(part)
    if not single.any():
        return part
    part = _first_on_closed_sides(part, single)
    t, held = part.seats.parameter, []
    for run in part.runs():
        if not single[run.members].any():
            continue
        now = t[run.members] + run.shift
        curve = int(part.seats.curve[run.members[0]])
        bends = part.bends(curve, run.low, run.high)
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
    part.settle()
    return part.holding(held)


def _first_on_closed_sides(part: MovablePart, single: np.ndarray) -> MovablePart:
    """The part with one vertex held at a bend on each closed side all of whose vertices slide."""
    t = part.seats.parameter
    for i in np.flatnonzero(single).tolist():
        if not part.sliding[i] or not part.encircles(i):
            continue
        curve, half = int(part.seats.curve[i]), 0.5 * float(np.ptp(part.seats.reach[i]))
        bends = part.bends(curve, t[i] - half, t[i] + half)
        if len(bends):
            t[i] = bends[np.argmin(np.abs(bends - t[i]))]
            part.settle()
            part = part.holding([i])
    return part


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


def in_order(t: np.ndarray, length: float) -> np.ndarray:
    """`t` (n,) if it increases strictly; else values near it that do, with the same ends."""
    least = 1e-6 * length / len(t)
    if np.all(np.diff(t) > least):
        return t
    blocks: list[list[float]] = []  # mean and size: isotonic regression by pooling
    for value in np.clip(t[1:-1], t[0], t[-1]):
        blocks.append([float(value), 1.0])
        while len(blocks) > 1 and blocks[-2][0] >= blocks[-1][0]:
            mean, size = blocks.pop()
            blocks[-1][0] = (blocks[-1][0] * blocks[-1][1] + mean * size) / (blocks[-1][1] + size)
            blocks[-1][1] += size
    pooled = np.repeat([mean for mean, _ in blocks], [int(size) for _, size in blocks])
    pooled = np.concatenate([t[:1], pooled, t[-1:]])
    # a touch of even spacing parts those that were pooled into one
    even = np.linspace(t[0], t[-1], len(t))
    return 0.9 * pooled + 0.1 * even


def _scattered(rng: np.random.Generator, share: float) -> Start:
    """Start from the means, each moved at random by `share` of the part's size or so."""

    def start(part: MovablePart) -> None:
        assert part.frame is not None
        spread_and_embedded(part)
        free = np.flatnonzero(part.free)
        size = np.ptp(part.points, axis=0).max() * share
        part.points[free] += size * rng.standard_normal((len(free), 2)) @ part.frame[:2]

    return start
