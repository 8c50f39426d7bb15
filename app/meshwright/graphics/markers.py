"""Markers of vertices and the boundary, the same in the window, in pictures and in films."""

from dataclasses import dataclass

import numpy as np

from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.irregularity import usual_desired_degree

BASE_RADIUS = 10.0
"""Radius in pixels of the disc of a vertex with |delta| = 1, where there is room."""
GROWTH = 2.5
"""Pixels added to the radius for each further unit of |delta|."""
LARGEST = 16.0
PIN = (5.0, 10.0, 3.2)
"""The mark of a pinned vertex: a needle to this far right of it and above it, and the radius of the
head there, in pixels.
"""
SMALLEST = 2.5
CROWDED = 0.36
"""The largest radius of a disc, relative to the shortest edge at its vertex."""
READABLE = 7.5
"""Discs smaller than this radius in pixels carry no number."""


@dataclass(frozen=True)
class Markers:
    """Irregular vertices (n,), with their delta (n,), places (n, 2), length of their shortest edges
    ``reach`` (n,), and whether they are corners or anchors (n,); places of all corners, anchors,
    locked and pinned vertices; boundary loops (m, 2), each ending with its first point.

    Anchors are vertices that an operation keeps as it keeps corners, but where the side goes
    straight on: the tangent point of a line and an arc.
    """

    vertices: np.ndarray
    delta: np.ndarray
    places: np.ndarray
    reach: np.ndarray
    corners: np.ndarray
    anchors: np.ndarray
    corner_places: np.ndarray
    anchor_places: np.ndarray
    locked_places: np.ndarray
    pinned_places: np.ndarray
    loops: tuple[np.ndarray, ...]

    @property
    def sized(self) -> bool:
        """Whether the sizes of the discs are known."""
        return len(self.reach) == len(self.vertices)

    def radii(self, viewport: Viewport) -> np.ndarray:
        """Radii of the discs (n,) in pixels: larger with |delta|, smaller where edges are short."""
        wanted = np.minimum(BASE_RADIUS + GROWTH * (np.abs(self.delta) - 1), LARGEST)
        room = CROWDED * self.reach * viewport.pixels
        return np.maximum(np.minimum(wanted, room), SMALLEST)


def markers(mesh: HalfEdgeMesh, sized: bool = True) -> Markers:
    """The markers of ``mesh`` in its present state.

    ``sized``: otherwise ``reach`` is empty, for views that draw all discs in one size; it takes
    longer than everything else.
    """
    delta = mesh.irregularity()
    points = mesh.points[:, :2]
    vertices = np.flatnonzero(delta)
    fixed = mesh.vertices()[mesh.geometric()[mesh.vertices()]]
    usual = [usual_desired_degree(mesh.k, boundary) for boundary in (True, False)]
    anchors = mesh.desired()[fixed] == np.where(mesh.boundary()[fixed], *usual)
    locked = mesh.vertices()[mesh.locked()[mesh.vertices()]]
    pinned = mesh.vertices()[mesh.pinned()[mesh.vertices()]]
    return Markers(
        vertices=vertices,
        delta=delta[vertices],
        places=points[vertices],
        reach=_shortest_edges(mesh.elements(), points, vertices) if sized else np.zeros(0),
        corners=np.isin(vertices, fixed[~anchors]),
        anchors=np.isin(vertices, fixed[anchors]),
        corner_places=points[fixed[~anchors]],
        anchor_places=points[fixed[anchors]],
        locked_places=points[locked],
        pinned_places=points[pinned],
        loops=tuple(points[np.append(loop, loop[0])] for loop in mesh.boundary_loops()),
    )


def label(delta: int) -> str:
    """``+1``, with a true minus sign for negative numbers."""
    return f"+{delta}" if delta > 0 else f"\u2212{-delta}" if delta < 0 else "0"


def _shortest_edges(elements: np.ndarray, points: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Length of the shortest edge at each of ``vertices`` (n,)."""
    shortest = np.full(len(points), np.inf)
    wanted = np.zeros(len(points), dtype=bool)
    wanted[vertices] = True
    near = elements[wanted[elements].any(axis=1)]
    ends = np.roll(near, -1, axis=1)
    lengths = np.hypot(*np.moveaxis(points[near] - points[ends], -1, 0))
    at_corner = np.minimum(lengths, np.roll(lengths, 1, axis=1))
    # with one-dimensional indices this is several times faster
    np.minimum.at(shortest, near.ravel(), at_corner.ravel())
    return shortest[vertices]
