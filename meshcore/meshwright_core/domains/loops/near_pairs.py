"""Pairs of shapes that are near each other, found piece by piece, in bounded memory and time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.time_limit import check_time
from meshwright_core.errors import MeshError

Ids = NDArray[np.int64]

MOST_PAIRS = 20_000_000
"""Pairs beyond which shapes are refused: they would take gigabytes."""
_AT_ONCE = 4_000_000
"""Pairs that one query may find, if each shape were near every other one."""


def chunks_of_pairs(
    shapes: Any,
    predicate: Literal["intersects", "dwithin", "within"],
    distance: NDArray[np.float64] | float | None = None,
    others: Any = None,
) -> Iterator[tuple[Ids, Ids]]:
    """Rows of `shapes` and of `others` near them, some shapes after the other.

    Args:
        shapes: (n,) of shapely.
        predicate: as for :meth:`shapely.STRtree.query`.
        distance: for "dwithin", one or (n,).
        others: (m,) of shapely; None: `shapes` themselves.

    Raises:
        MeshError: more than `MOST_PAIRS`; the time limit has passed.
    """
    shapes = np.asarray(shapes)
    tree = shapely.STRtree(shapes if others is None else others)
    size = max(1, _AT_ONCE // max(1, len(tree)))
    found = 0
    for start in range(0, len(shapes), size):
        check_time()
        part = shapes[start : start + size]
        reach = distance[start : start + size] if isinstance(distance, np.ndarray) else distance
        one, other = tree.query(part, predicate=predicate, distance=reach)
        found += len(one)
        if found > MOST_PAIRS:
            raise MeshError("Too many of its lines and curves meet or lie near each other.")
        yield one + start, other


def pairs_near(
    shapes: Any,
    predicate: Literal["intersects", "dwithin", "within"],
    distance: NDArray[np.float64] | float | None = None,
    others: Any = None,
) -> tuple[Ids, Ids]:
    """All pairs of :func:`chunks_of_pairs`, in the order of `shapes`."""
    found = list(chunks_of_pairs(shapes, predicate, distance, others))
    if not found:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    one, other = zip(*found, strict=True)
    return np.concatenate(one), np.concatenate(other)
