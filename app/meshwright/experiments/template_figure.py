"""Drawing of the template of a half-edge in a fixed layout, like the paper's figure of it.

The first element is a regular triangle or square with the half-edge at the bottom. Every element
that is reached through a side of another is attached to that side, and smaller, so that no two
overlap.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from meshwright.graphics.drawing import Disc, Drawing, Line, Polygon, Segments, Text
from meshwright.graphics.halfedge_arrow import arrow
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme

_DEPTH = {3: (0.0, 0.72, 0.5), 4: (0.0, 0.64, 0.27)}
"""How far the elements of each ring reach, relative to a side of the first; later ones as the
last."""
_NARROW = (1.0, 0.5, 0.3)
"""The far side of a quad of each ring, relative to its near side; later ones as the last."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Positions of the corners of a template; the unit is half a side of the first element."""

    corners: np.ndarray
    """(elements, k, 2), counter-clockwise; the half-edge of slot k e + i runs from corner i of
    element e."""
    rings: np.ndarray
    """(elements,) the number of sides between each and the first."""
    own: np.ndarray
    """(elements, k) bool: whether no earlier element has this corner."""


@cache
def layout(k: int, elements: int) -> Layout:
    """The layout of a template of 1, 1 + k, 1 + k + k (k - 1), ... elements."""
    corners = np.zeros((elements, k, 2))
    rings = np.zeros(elements, int)
    own = np.zeros((elements, k), bool)
    angle = 2.0 * np.pi * (np.arange(k) - 0.5) / k - np.pi / 2.0
    corners[0] = np.column_stack([np.cos(angle), np.sin(angle)]) / np.sin(np.pi / k)
    own[0] = True
    sides = [(0, i) for i in range(k)]
    for e in range(1, elements):
        came, side = sides.pop(0)
        ring = rings[came] + 1
        p, q = corners[came, side], corners[came, (side + 1) % k]
        along, middle = q - p, (p + q) / 2.0
        outward = np.array([along[1], -along[0]]) / max(float(np.hypot(*along)), 1e-12)
        depths = _DEPTH[k]
        far = middle + 2.0 * depths[min(ring, len(depths) - 1)] * outward
        half = 0.5 * _NARROW[min(ring, 2)] * along if k == 4 else np.zeros(2)
        # its first half-edge is the twin: it runs back from q to p
        corners[e] = [q, p, far] if k == 3 else [q, p, far - half, far + half]
        rings[e], own[e, 2:] = ring, True
        sides += [(e, i) for i in range(1, k)]
    return Layout(corners, rings, own)


def slot_of_corner(k: int, element: int, corner: int) -> int:
    """The slot of the half-edge that is associated with this corner (section 3.1): in a quad the
    half-edge that starts there, in a triangle the opposite one.
    """
    return k * element + (corner if k == 4 else (corner + 1) % 3)


def template_figure(
    k: int, vertices: np.ndarray, delta: np.ndarray, size: tuple[int, int], theme: Theme
) -> Drawing:
    """Draw a template.

    Args:
        k: sides of an element.
        vertices: (N,) the vertex of each slot, -1 beyond the boundary.
        delta: (V,) the irregularity of each vertex of the mesh.
        size: width and height in pixels.
        theme: the colours.
    """
    drawing = Drawing(size, theme.background, "the template, laid out flat")
    plan = layout(k, len(vertices) // k)
    low, high = plan.corners.reshape(-1, 2).min(axis=0), plan.corners.reshape(-1, 2).max(axis=0)
    scale = float(((np.array(size) - 72.0) / (high - low)).min())
    places = (plan.corners - (low + high) / 2.0) * (scale, -scale) + np.array(size) / 2.0
    middle = places[0].mean(axis=0)
    for e in range(len(places) - 1, -1, -1):
        _add_element(drawing, theme, places[e], int(plan.rings[e]), _there(k, vertices, e))
    tail, head, point = arrow(places[0], 0)
    drawing.add(Line(np.array([tail, head]), theme.arrow, 2.6), Polygon(point, theme.arrow))
    for e in range(len(places)):
        for i in np.flatnonzero(plan.own[e]).tolist():
            slot = slot_of_corner(k, e, i)
            v = int(vertices[slot])
            amount = int(delta[v]) if v >= 0 else None
            # the slots of the first element are written inside it, as there is no room outside
            outward = (middle - places[e, i]) if e == 0 else (places[e, i] - middle)
            _add_vertex(drawing, theme, places[e, i], outward, slot, amount, e == 0)
    return drawing


def _there(k: int, vertices: np.ndarray, element: int) -> bool:
    return bool((vertices[k * element : k * element + k] >= 0).all())


def _add_element(
    drawing: Drawing, theme: Theme, corners: np.ndarray, ring: int, there: bool
) -> None:
    sides = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    if there:
        drawing.add(Polygon(corners, theme.accent_soft if ring == 0 else theme.fill))
        drawing.add(Segments(sides, theme.boundary if ring == 0 else theme.edge, 1.2))
    else:
        drawing.add(Segments(sides, theme.faint, 1.0, 3.0))


def _add_vertex(
    drawing: Drawing, theme: Theme, at: np.ndarray, outward: np.ndarray, slot: int,
    delta: int | None, first: bool,
) -> None:  # fmt: skip
    """A disc with delta; a dot if it is regular; an empty ring beyond the boundary."""
    x, y = at.tolist()
    if delta is None:
        drawing.add(Disc((x, y), 5.0, theme.background), Disc((x, y), 5.0, theme.faint, 1.2))
    elif delta == 0:
        drawing.add(Disc((x, y), 4.0, theme.boundary))
    else:
        drawing.add(
            Disc((x, y), 11.2, theme.background),
            Disc((x, y), 10.0, theme.plus if delta > 0 else theme.minus),
            Text(label(delta), (x, y), 11.5, theme.marker_text, "middle"),
        )
    length = max(float(np.hypot(*outward)), 1e-9)
    tag = at + outward / length * (24.0 if first else 18.0)
    colour = theme.faint if delta is None else theme.accent
    drawing.add(Text(str(slot), (float(tag[0]), float(tag[1])), 10.5, colour, "middle"))
