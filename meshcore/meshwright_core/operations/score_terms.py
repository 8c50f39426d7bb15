"""The terms of which the change of s is the sum: |Delta| of vertices before and after an edit."""

from __future__ import annotations

from meshwright_core.core.arrays import DEGREE, DESIRED
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.operations.vertex_merge import survivor


@bare_kernel
def degree_term(m, v, change):
    """The change of |Delta| at v when its degree changes by `change`."""
    delta = m.vertex[v, DEGREE] - m.vertex[v, DESIRED]
    return abs(delta + change) - abs(delta)


@bare_kernel
def merge_term(m, v, w, lost, k):
    """The change of |Delta| when v and w become one vertex whose degree is the sum less `lost`."""
    winner = survivor(m, v, w, k)
    before = abs(m.vertex[v, DEGREE] - m.vertex[v, DESIRED])
    before += abs(m.vertex[w, DEGREE] - m.vertex[w, DESIRED])
    degree = m.vertex[v, DEGREE] + m.vertex[w, DEGREE] - lost
    return abs(degree - m.vertex[winner, DESIRED]) - before
