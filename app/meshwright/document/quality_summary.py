"""Quality of a mesh in numbers: histograms of three measures, inverted elements, bound on shape,
number of blocks.

Imports no Qt; the window computes it on a separate thread.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwright.document.element_quality import ElementQuality
from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.quality import TOLERANCE
from meshwright_core.geometry.shape_bound import shape_bound

BINS = 20
GOOD, NEARLY = 0.5, 0.9
"""The shape of a mesh is in order from min(GOOD, NEARLY q*) on: the default target of searches."""


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
    """Histograms of the scaled Jacobian, of the shape and of the smallest angle in degrees; ids of
    the inverted elements, ascending; q*, the largest worst scaled Jacobian that the corners permit
    (:func:`meshwright_core.geometry.shape_bound.shape_bound`); blocks of a quad mesh, None for
    triangles or where they were not counted.

    ``values`` are the measures by element id: a copy that nobody changes.
    """

    jacobian: Spread
    shape: Spread
    angle: Spread
    inverted: np.ndarray
    bound: float
    blocks: int | None
    values: ElementValues


@dataclass(frozen=True)
class ElementValues:
    """Scaled Jacobian and shape (slots,) by element id, nan where there is no element."""

    jacobian: np.ndarray
    shape: np.ndarray


def summarise(
    mesh: HalfEdgeMesh,
    cancelled: Callable[[], bool] = lambda: False,
    quality: ElementQuality | None = None,
) -> QualitySummary | None:
    """Measure ``mesh``; None once ``cancelled()``.

    The mesh must not change during the call: pass a copy to another thread. ``quality`` holds the
    values of the last call, so that only what has changed is measured.
    """
    quality = ElementQuality() if quality is None else quality
    if not quality.follow(mesh, cancelled):
        return None
    ids = quality.ids
    jacobian = quality.jacobian[ids]
    sound = jacobian > TOLERANCE
    bound = shape_bound(mesh)
    blocks = None
    if mesh.k == 4 and not cancelled():
        from meshwright_core.analysis.blocks import block_count  # brings in parts of scipy

        blocks = block_count(mesh)
    if cancelled():
        return None
    return QualitySummary(
        jacobian=_spread(jacobian, sound, ids, 1.0, everywhere=True),
        shape=_spread(quality.shape[ids], sound, ids, 1.0, everywhere=True),
        angle=_spread(quality.angle[ids], sound, ids, 180.0 - 360.0 / mesh.k, everywhere=False),
        inverted=ids[~sound],
        bound=bound,
        blocks=blocks,
        values=ElementValues(quality.jacobian, quality.shape),
    )


def decimal(value: float) -> str:
    """A measure between -1 and 1 in two decimals: ``.72``, ``\u2212.05``; a dash for nan."""
    if np.isnan(value):
        return "\u2013"
    text = f"{abs(value):.2f}".removeprefix("0")
    return f"\u2212{text}" if value < 0 and text != ".00" else text


def shape_words(worst: float, bound: float) -> str:
    """``.72 of at most .72``: the worst scaled Jacobian, and what regular corners permit.

    With irregular corners it may be better than that.
    """
    if worst > bound + 0.005:
        return f"{decimal(worst)}; regular corners permit {decimal(bound)}"
    return f"{decimal(worst)} of at most {decimal(bound)}"


def shape_in_order(worst: float, bound: float) -> bool:
    """Whether the worst scaled Jacobian reaches what counts as good: the solver's target of half,
    or .9 of what the corners permit.
    """
    return worst >= min(GOOD, NEARLY * bound)


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
