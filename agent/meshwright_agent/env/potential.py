"""Potentials of the irregularities: features that reach further than the convolution.

Irregular vertices of opposite sign cancel when they meet, as charges do. Delta and |Delta| are
therefore taken as the charges of a screened Poisson problem on the graph of vertices and edges. A
few Jacobi sweeps give each vertex a value whose gradient points towards irregular vertices, also
towards those beyond the field of view of the convolution (section 4.2). Not in the paper.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import DEGREE, DESIRED, ELEMENT_SLOTS, ORIGIN, TWIN, following
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.references import by_reference

SWEEPS = 16
"""Jacobi sweeps; a charge has an effect over as many edges."""
NEIGHBOURHOOD = 1024
"""Largest number of elements over which the potentials are computed; it bounds their cost."""
SCREENING = 0.2
"""Screening, added to the degree: a potential falls to a third in about 5 edges."""
_SOFT = 0.05
_SCALE = 25.0


@by_reference
class Field(NamedTuple):
    """Work arrays of one computation, whose vertices and edges are numbered from 0."""

    place_of: np.ndarray
    """(vertex slots,) number + 1 of a vertex with a potential, 0 for others and between calls."""
    elements: np.ndarray
    ends: np.ndarray
    charge: np.ndarray
    value: np.ndarray
    """(N, 2): the potentials of Delta and of |Delta|."""
    next_value: np.ndarray
    valence: np.ndarray


def field(vertex_slots: int) -> Field:
    """Allocate the arrays for meshes with at most so many vertex slots."""
    most = 4 * NEIGHBOURHOOD
    return Field(
        np.zeros(vertex_slots, np.int32),
        np.zeros(NEIGHBOURHOOD, np.int32),
        np.zeros((2 * most, 2), np.int32),
        np.zeros((most, 2), np.float32),
        np.zeros((most, 2), np.float32),
        np.zeros((most, 2), np.float32),
        np.zeros(most, np.float32),
    )


@bare_kernel
def neighbourhood(m, k, near, elements):
    """List elements: all, if they fit into `elements` (N,), else those closest to the half-edges
    `near` (K,), -1 for none. Leaves them marked; returns their number.
    """
    count = 0
    if m.counters[ELEMENT_SLOTS] <= len(elements):
        for e in range(m.counters[ELEMENT_SLOTS]):
            if m.edge[e * k, ORIGIN] >= 0:
                m.element_mark[e] = 1
                elements[count] = e
                count += 1
        return count
    for h in near:
        if h >= 0 and m.element_mark[h // k] == 0 and count < len(elements):
            m.element_mark[h // k] = 1
            elements[count] = h // k
            count += 1
    at = 0
    while at < count and count < len(elements):
        for h in range(elements[at] * k, elements[at] * k + k):
            t = m.edge[h, TWIN]
            if t >= 0 and m.element_mark[t // k] == 0 and count < len(elements):
                m.element_mark[t // k] = 1
                elements[count] = t // k
                count += 1
        at += 1
    return count


@bare_kernel
def _number(m, v, field, count):
    """Number vertex v, with its charges and potentials of zero; returns the new count."""
    if field.place_of[v] == 0:
        field.place_of[v] = count + 1
        amount = np.float32(m.vertex[v, DEGREE] - m.vertex[v, DESIRED])
        field.charge[count, 0] = amount
        field.charge[count, 1] = abs(amount)
        field.value[count, 0] = 0.0
        field.value[count, 1] = 0.0
        field.valence[count] = SCREENING
        return count + 1
    return count


@bare_kernel
def solve_potential(m, k, near, field):
    """Compute the potentials of Delta and of |Delta| around the half-edges `near` (K,).

    Returns the number of elements, which :func:`forget` needs afterwards.
    """
    elements, ends, value = field.elements, field.ends, field.value
    charge, next_value, valence = field.charge, field.next_value, field.valence
    listed = neighbourhood(m, k, near, elements)
    vertices = edges = 0
    for i in range(listed):
        for h in range(elements[i] * k, elements[i] * k + k):
            vertices = _number(m, m.edge[h, ORIGIN], field, vertices)
    for i in range(listed):
        for h in range(elements[i] * k, elements[i] * k + k):
            a = field.place_of[m.edge[h, ORIGIN]] - 1
            b = field.place_of[m.edge[following(h, k), ORIGIN]] - 1
            ends[edges, 0], ends[edges, 1] = a, b
            valence[a] += 1.0
            edges += 1
            t = m.edge[h, TWIN]
            # the other half-edge of this edge is not listed: add its direction here
            if t < 0 or m.element_mark[t // k] == 0:
                ends[edges, 0], ends[edges, 1] = b, a
                valence[b] += 1.0
                edges += 1
    for i in range(listed):
        m.element_mark[elements[i]] = 0
    for _ in range(SWEEPS):
        for v in range(vertices):
            next_value[v, 0] = charge[v, 0]
            next_value[v, 1] = charge[v, 1]
        for i in range(edges):
            a, b = ends[i, 0], ends[i, 1]
            next_value[a, 0] += value[b, 0]
            next_value[a, 1] += value[b, 1]
        for v in range(vertices):
            value[v, 0] = next_value[v, 0] / valence[v]
            value[v, 1] = next_value[v, 1] / valence[v]
    return listed


@bare_kernel
def forget(m, k, field, listed):
    """Reset place_of to zero after :func:`solve_potential`."""
    for i in range(listed):
        for h in range(field.elements[i] * k, field.elements[i] * k + k):
            field.place_of[m.edge[h, ORIGIN]] = 0


@bare_kernel
def as_feature(value):
    """Quantise a potential to an integer from -127 to 127.

    Linear near zero and logarithmic beyond, so that distant charges still yield a direction.
    """
    return min(max(np.rint(_SCALE * np.arcsinh(value / _SOFT)), -127.0), 127.0)
