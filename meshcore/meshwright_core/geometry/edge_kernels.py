"""Kernels on one edge along a curve: its points, derivatives, and the area over its chord.

The edge from vertex a to vertex b on a curve C, at the parameters t_a and t_b, is

    E(w) = C(t_a + w (t_b - t_a)) + (1 - w) (a - C(t_a)) + w (b - C(t_b)),    0 <= w <= 1,

exactly the curve where both ends lie on it; where a user has dragged an end off, the edge follows.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import curve_length, place_in_span, place_on
from meshwright_core.geometry.turning import span_towards

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
"""Of the quadrature on each span."""


@kernel
def edge_offsets(curves, curve, span, ends, offsets):
    """Write how far the ends (2, 3) of an edge lie off its curve at the parameters `span` (2,)."""
    place, slope = np.zeros(3), np.zeros(3)
    for i in range(2):
        place_on(curves, curve, span[i], place, slope)
        for c in range(3):
            offsets[i, c] = ends[i, c] - place[c]


@bare_kernel
def place_on_edge(curves, curve, span, offsets, w, point, slope):
    """Write the point E(w) of an edge and the derivative by w; `span` and `offsets` of its ends.

    At a kink of the curve the derivative is that towards the inside of the edge.
    """
    step = span[1] - span[0]
    t = span[0] + w * step if w <= 0.5 else span[1] - (1.0 - w) * step
    place_on(curves, curve, t, point, slope)
    if w <= 0.0 or w >= 1.0:
        piece, u = span_towards(curves, curve, t, span[1] if w <= 0.0 else span[0])
        # its point is the same one
        place_in_span(curves, piece, u, point, slope)
        extent = curves.stop[piece] - curves.start[piece]
        for c in range(3):
            slope[c] /= extent
    for c in range(3):
        point[c] += (1.0 - w) * offsets[0, c] + w * offsets[1, c]
        slope[c] = step * slope[c] + offsets[1, c] - offsets[0, c]


@kernel
def end_tangents(curves, curve, span, ends):
    """(n, 2, 3) derivatives by w at both ends of edges, given as in :func:`bulges`."""
    found, place = np.zeros((len(curve), 2, 3)), np.zeros(3)
    offsets = np.zeros((2, 3))
    for i in range(len(curve)):
        edge_offsets(curves, curve[i], span[i], ends[i], offsets)
        for end in range(2):
            place_on_edge(curves, curve[i], span[i], offsets, float(end), place, found[i, end])
    return found


@kernel
def bulge(curves, curve, span, ends, nodes, weights, area):
    """Write the vector area (3,) between an edge with these ends (2, 3) and its chord.

    Gauss-Legendre quadrature on each span of the curve; exact to rounding for polylines, and to
    about 1e-14 of the area for arcs, whose spans turn by a quarter at most.
    """
    offsets, place, slope = np.zeros((2, 3)), np.zeros(3), np.zeros(3)
    edge_offsets(curves, curve, span, ends, offsets)
    for c in range(3):
        area[c] = 0.0
    here, stop = span[0], span[1]
    sign = 1.0 if stop > here else -1.0
    for _ in range(len(curves.start) + 2):
        if sign * (stop - here) <= 0.0:
            return
        piece, u = span_towards(curves, curve, here, stop)
        extent = curves.stop[piece] - curves.start[piece]
        room = (1.0 - u) * extent if sign > 0.0 else u * extent
        length = curve_length(curves, curve)
        until = here + sign * room
        if sign * (stop - until) <= 1e-15 * length:
            until = stop
        straight = curves.first_control[piece + 1] - curves.first_control[piece] == 2
        for i in range(1 if straight else len(nodes)):
            x = 0.5 if straight else 0.5 * (1.0 + nodes[i])
            weight = 1.0 if straight else 0.5 * weights[i]
            t = here + x * (until - here)
            w = (t - span[0]) / (span[1] - span[0])
            place_in_span(curves, piece, u + x * (until - here) / extent, place, slope)
            for c in range(3):
                place[c] += (1.0 - w) * offsets[0, c] + w * offsets[1, c] - ends[0, c]
                slope[c] = slope[c] / extent + (offsets[1, c] - offsets[0, c]) / (span[1] - span[0])
            for c in range(3):
                d, e = (c + 1) % 3, (c + 2) % 3
                across = place[d] * slope[e] - place[e] * slope[d]
                area[c] += 0.5 * weight * (until - here) * across
        here = until


@kernel
def bulges(curves, curve, span, ends, nodes, weights):
    """(n, 3) vector areas between edges and their chords, as :func:`bulge`; ends (n, 2, 3)."""
    areas = np.zeros((len(curve), 3))
    for i in range(len(curve)):
        bulge(curves, curve[i], span[i], ends[i], nodes, weights, areas[i])
    return areas
