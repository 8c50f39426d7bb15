"""Named arrays from a file, which may hold anything."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from meshwright_core.errors import MeshError

Arrays = dict[str, np.ndarray]


def stored(
    arrays: Mapping[str, np.ndarray], name: str, kind: type, shape: tuple[int, ...]
) -> np.ndarray:
    """The array of that name as `kind`, -1 for any length; MeshError if it is another one."""
    found = arrays.get(name)
    if found is None:
        raise MeshError(f"it lacks its {name}")
    fits = found.ndim == len(shape) and all(
        wanted in (-1, length) for wanted, length in zip(shape, found.shape, strict=True)
    )
    if found.dtype != kind or not fits:
        raise MeshError(f"its {name} are not as they should be")
    return np.ascontiguousarray(found)
