"""Element quality of a mesh: histograms of two measures, inverted elements, number of blocks.

Imports no Qt; the window computes it on a separate thread.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from meshwright_core.geometry.outline import Outline

from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.quality import TOLERANCE, reference_normals

CHUNK = 1 << 12
"""Elements measured at a time; the work can be cancelled in between."""
BINS = 20


@dataclass(frozen=True)
class Spread:
    """Histogram of one measure over the elements that are not inverted.

    ``counts`` (bins,) sound elements in bins of one width from ``low`` to ``high``; ``worst`` the
    lowest value among all elements that have one, nan for none, and ``worst_element`` its id.
    """

    low: float
    high: float
    counts: np.ndarray
    worst: float
    worst_element: int

    def edges(self, number: int) -> tuple[float, float]:
        """Lower and upper bound of bin ``number``."""
        width = (self.high - self.low) / len(self.counts)
        return self.low + number * width, self.low + (number + 1) * width


@dataclass(frozen=True)
class QualitySummary:
    """Histograms of the scaled Jacobian and of the smallest angle in degrees; ids of the inverted
    elements, ascending; blocks of a quad mesh, None for triangles.
    """

    jacobian: Spread
    angle: Spread
    inverted: np.ndarray
    blocks: int | None


def summarise(
    mesh: HalfEdgeMesh, cancelled: Callable[[], bool] = lambda: False
) -> QualitySummary | None:
    """Measure ``mesh``; None once ``cancelled()``.

    The mesh must not change during the call: pass a copy to another thread.
    """
    elements, ids = mesh.elements(), mesh.element_ids()
    points = mesh.points
    used = points if len(points) == mesh.n_vertices else points[mesh.vertices()]
    normal = Outline.of(mesh).normal(used)
    curved = reference_normals(points, elements) if normal is None else None
    jacobian, angle = np.empty(len(elements)), np.empty(len(elements))
    ideal = 1.0 if mesh.k == 4 else np.sqrt(0.75)
    for first in range(0, len(elements), CHUNK):
        if cancelled():
            return None
        part = slice(first, first + CHUNK)
        reference = normal if curved is None else curved[part]
        assert reference is not None
        sine, cosine = _corners(points[elements[part]], reference)
        jacobian[part] = sine.min(axis=1)
        angle[part] = np.degrees(np.arctan2(sine, cosine)).min(axis=1)
    sound = jacobian > TOLERANCE
    blocks = None
    if mesh.k == 4 and not cancelled():
        from meshwright_core.analysis.blocks import block_count  # brings in parts of scipy

        blocks = block_count(mesh)
    if cancelled():
        return None
    return QualitySummary(
        jacobian=_spread(jacobian / ideal, sound, ids, 1.0, everywhere=True),
        angle=_spread(angle, sound, ids, 180.0 - 360.0 / mesh.k, everywhere=False),
        inverted=ids[~sound],
        blocks=blocks,
    )


def _corners(p: np.ndarray, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sine and cosine (m, k) at the corners of elements with corners ``p`` (m, k, 3).

    The sine is negative where a corner turns clockwise seen against ``reference`` (3,) or (m, 3);
    both are 0 at a side of no length.
    """
    forward = np.roll(p, -1, axis=1) - p
    backward = np.roll(p, 1, axis=1) - p
    if reference.ndim == 1 and not reference[:2].any():
        area = forward[..., 0] * backward[..., 1] - forward[..., 1] * backward[..., 0]
        area *= reference[2]
    else:
        across = np.cross(forward, backward)
        area = np.einsum("ikj,ij->ik", across, np.broadcast_to(reference, (len(p), 3)))
    along = np.einsum("ikj,ikj->ik", forward, backward)
    squares = np.einsum("ikj,ikj->ik", forward, forward)
    lengths = np.sqrt(squares * np.roll(squares, 1, axis=1))
    lengths[lengths == 0.0] = np.inf
    return area / lengths, along / lengths


def _spread(
    values: np.ndarray, sound: np.ndarray, ids: np.ndarray, high: float, everywhere: bool
) -> Spread:
    """The histogram of ``values`` (m,); ``everywhere``: the worst value is that of all elements,
    not only of those that are not inverted.
    """
    bins = np.clip(np.floor(values[sound] * (BINS / high)).astype(np.int64), 0, BINS - 1)
    counts = np.bincount(bins, minlength=BINS)
    candidates = np.arange(len(values)) if everywhere else np.flatnonzero(sound)
    if len(candidates) == 0:
        return Spread(0.0, high, counts, float("nan"), -1)
    worst = int(candidates[np.argmin(values[candidates])])
    return Spread(0.0, high, counts, float(values[worst]), int(ids[worst]))
