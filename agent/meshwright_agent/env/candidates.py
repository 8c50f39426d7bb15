"""The candidate half-edges of a decision: the paper's template, or a shortlist over the mesh.

Template (section 4.2.1): around every half-edge lies a template, a fixed pattern of half-edges; the
candidates are those of the template with the largest sum of |Delta|, ties broken at random.
Shortlist (ours): the half-edges near irregular vertices whose best operation lowers s most, ranked
with Gumbel noise. With many irregular vertices both consider one region around an irregular vertex
drawn at random, so that the cost of a decision does not grow with the mesh.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from meshwright_agent.env.local_patch import seen_vertex
from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    ELEMENTS,
    HALF,
    IRREGULAR,
    TWIN,
    following,
    preceding,
    turned,
)
from meshwright_core.core.compilation import bare_kernel, bare_shared_kernel, kernel
from meshwright_core.operations.catalogue import (
    GLOBAL_SPLIT,
    TRI_COLLAPSE,
    check,
    growth,
    score_change,
)
from meshwright_core.operations.global_split import crossings
from meshwright_core.operations.refusals import ALLOWED

LOOKED_AT = 64
"""Irregular vertices up to which all of them are considered."""
REGION = 256
"""Elements of the region that is considered on a mesh with more."""
LONGEST_CUT = 200
"""Largest number of quads that each half of an agent's global split may cut."""


@bare_kernel
def gather(m, h, k, source, turn, slots):
    """Write the half-edges of the template of h into `slots` (N,); -1 beyond the boundary."""
    slots[0] = h
    for i in range(1, len(source)):
        came = slots[source[i]]
        if came < 0:
            slots[i] = -1
        elif turn[i] < 0:
            slots[i] = m.edge[came, TWIN]
        else:
            slots[i] = came - came % k + (came + turn[i]) % k


@cache
def template_plan(k: int, levels: int) -> tuple[np.ndarray, np.ndarray]:
    """The template: the half-edges of the elements within `levels` steps, as instructions.

    Slot 0 is the half-edge itself. source (N,) int32: the slot from which a slot's half-edge is
    reached; turn (N,) int32: -1 if it is the twin of that, else by how many steps of `next` it
    follows in the same element.
    """
    paths: list[tuple[int, ...]] = [()]
    ring: list[tuple[int, ...]] = [()]
    for _ in range(levels):
        ring = [(*path, i) for path in ring for i in range(1 if path else 0, k)]
        paths += ring
    slot = {(path, i): n for n, (path, i) in enumerate((p, i) for p in paths for i in range(k))}
    source, turn = np.zeros(len(slot), np.int32), np.zeros(len(slot), np.int32)
    for (path, i), n in slot.items():
        if i == 0 and path:
            source[n], turn[n] = slot[path[:-1], path[-1]], -1
        else:
            source[n], turn[n] = slot[path, 0], i
    return source, turn


@bare_kernel
def permitted(m, operation, h, cap, floor, ceiling, extended):
    """Whether the action mask allows `operation` at h.

    It must be valid (:func:`meshwright_core.operations.catalogue.check`), belong to the action set,
    and leave the number of elements between floor and ceiling.
    """
    elements = m.counters[ELEMENTS]
    change = growth(m, operation, h)
    if operation == TRI_COLLAPSE and not extended and m.edge[h, TWIN] < 0:
        return False
    if change < 0:
        if elements + change < floor:
            return False
    elif elements + 2 > ceiling:
        return False
    if operation == GLOBAL_SPLIT:
        t = m.edge[h, TWIN]
        if t < 0:
            return False
        first = crossings(m, m.edge[following(h, 4), TWIN], h, LONGEST_CUT)
        if first < 0:
            return False
        second = crossings(m, m.edge[preceding(t, 4), TWIN], h, LONGEST_CUT)
        if second < 0 or elements + first + second + 1 > ceiling:
            return False
    return check(m, operation, h, cap) == ALLOWED


@bare_kernel
def best_change(m, h, first, count, cap, floor, ceiling, extended):
    """The lowest change of s among the permitted operations first ... first + count - 1 at h.

    99 if there is none. For a global split only its change of s counts: whether it is permitted
    would need a walk along the whole split.
    """
    best = 99
    for operation in range(first, first + count):
        if operation == GLOBAL_SPLIT:
            if m.edge[h, TWIN] >= 0:
                best = min(best, score_change(m, operation, h))
        elif permitted(m, operation, h, cap, floor, ceiling, extended):
            best = min(best, score_change(m, operation, h))
    return best


@bare_kernel
def _collect(m, e, found, count):
    """Add element e to `found` unless it is marked; returns the new count."""
    if m.element_mark[e] or count >= len(found):
        return count
    m.element_mark[e] = 1
    found[count] = e
    return count + 1


@kernel
def near_irregular(m, k, rng, found):
    """Write the elements that one decision considers into `found` (N,); returns their number.

    With up to LOOKED_AT irregular vertices: the elements at each of them, and their neighbours.
    With more: a connected region of REGION elements around one of them, drawn at random.
    """
    total = m.counters[IRREGULAR]
    count = 0
    if total <= LOOKED_AT:
        for i in range(total):
            count = _collect_around(m, m.irregular[i], k, found, count)
    else:
        v = m.irregular[int(rng.random() * total)]
        count = _collect_around(m, v, k, found, count)
        at = 0
        while at < count and count < REGION:
            for side in range(found[at] * k, found[at] * k + k):
                if m.edge[side, TWIN] >= 0:
                    count = _collect(m, m.edge[side, TWIN] // k, found, count)
            at += 1
    for i in range(count):
        m.element_mark[found[i]] = 0
    return count


@bare_kernel
def _collect_around(m, v, k, found, count):
    """Collect the elements at v and their neighbours."""
    start = m.vertex[v, HALF]
    h = start
    for _ in range(m.vertex[v, DEGREE]):
        count = _collect(m, h // k, found, count)
        first = h - h % k
        for side in range(first, first + k):
            if m.edge[side, TWIN] >= 0:
                count = _collect(m, m.edge[side, TWIN] // k, found, count)
        h = turned(m, h, k)
        if h < 0 or h == start:
            break
    return count


@kernel
def _least_of_largest(keys, total, wanted):
    """The smallest of the `wanted` largest of the first `total` keys.

    By insertion into a short sorted list: numba takes two seconds to compile its sort.
    """
    largest = np.empty(wanted)
    held = 0
    for i in range(total):
        if held == wanted:
            if keys[i] <= largest[0]:
                continue
            at = 0
            while at + 1 < held and largest[at + 1] < keys[i]:
                largest[at] = largest[at + 1]
                at += 1
        else:
            at = held
            held += 1
            while at > 0 and largest[at - 1] > keys[i]:
                largest[at] = largest[at - 1]
                at -= 1
        largest[at] = keys[i]
    return largest[0]


@kernel
def shortlist(m, k, first, count, cap, floor, ceiling, extended, noise, rng, found, keys, chosen):
    """Fill `chosen` (K,) with half-edges, -1 where there are fewer; returns their number.

    The ranking key is minus the best change of s, plus Gumbel noise scaled by `noise`. found (N,),
    keys (k N,): scratch.
    """
    elements = near_irregular(m, k, rng, found)
    for i in range(elements):
        for j in range(k):
            h = found[i] * k + j
            change = best_change(m, h, first, count, cap, floor, ceiling, extended)
            if change == 99:
                keys[i * k + j] = -np.inf
            else:
                keys[i * k + j] = -change - noise * np.log(-np.log(1e-12 + rng.random()))
    total = elements * k
    wanted = min(len(chosen), total)
    taken = 0
    if total > 0:
        least = _least_of_largest(keys, total, wanted)
        for i in range(total):
            if keys[i] >= least and keys[i] > -np.inf and taken < wanted:
                chosen[taken] = found[i // k] * k + i % k
                taken += 1
    for i in range(taken, len(chosen)):
        chosen[i] = -1
    return taken


@bare_kernel
def local_score(m, h, k, source, turn, slots):
    """The local score (section 4.2.1): the sum of |Delta| over the template of h."""
    gather(m, h, k, source, turn, slots)
    total = 0
    for i in range(len(source)):
        if slots[i] >= 0:
            v = seen_vertex(m, slots[i], k)
            total += abs(m.vertex[v, DEGREE] - m.vertex[v, DESIRED])
    return total


@kernel
def best_template(m, k, source, turn, rng, found, slots, chosen):
    """Fill `chosen` (K,) with the template of highest local score (section 4.2.1).

    -1 beyond the boundary and for repetitions; returns the number of the others. Only templates
    near irregular vertices are compared, since all others have a lower score.
    """
    elements = near_irregular(m, k, rng, found)
    best, tied, at = -1, 0, -1
    for i in range(elements):
        for j in range(k):
            h = found[i] * k + j
            score = local_score(m, h, k, source, turn, slots)
            if score > best:
                best, tied, at = score, 1, h
            elif score == best:
                tied += 1
                if rng.random() * tied < 1.0:
                    at = h
    if at < 0:
        chosen[:] = -1
        return 0
    gather(m, at, k, source, turn, chosen)
    real = 0
    for i in range(len(chosen)):
        # around a vertex of low degree the template contains a half-edge more than once
        for j in range(i):
            if chosen[i] == chosen[j]:
                chosen[i] = -1
        if chosen[i] >= 0:
            real += 1
    return real


@bare_shared_kernel
def masks(m, chosen, first, count, cap, floor, ceiling, extended, mask, changes):
    """Fill `mask` (K, A) and `changes` (K, A), the exact change of s of permitted operations.

    Returns whether any operation is permitted.
    """
    some = False
    for i in range(len(chosen)):
        h = chosen[i]
        for j in range(count):
            mask[i, j] = False
            changes[i, j] = 0
            if h >= 0 and permitted(m, first + j, h, cap, floor, ceiling, extended):
                mask[i, j] = True
                changes[i, j] = score_change(m, first + j, h)
                some = True
    return some
