"""Element quality of a mesh: histograms of two measures, inverted elements, number of blocks.

Imports no Qt; the window computes it on a separate thread.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.quality import TOLERANCE, Measure

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
    measure = Measure(mesh)
    ids = measure.ids
    jacobian, angle = np.empty(len(ids)), np.empty(len(ids))
    ideal = 1.0 if mesh.k == 4 else np.sqrt(0.75)
    for first in range(0, len(ids), CHUNK):
        if cancelled():
            return None
        part = slice(first, first + CHUNK)
        corners = measure.of(part)
        jacobian[part] = corners.sine.min(axis=1)
        angle[part] = np.degrees(corners.angle).min(axis=1)
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
