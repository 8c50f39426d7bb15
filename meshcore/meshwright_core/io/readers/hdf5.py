"""HDF5 files, opened in memory, with every array compared with the size of the file."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content

_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_EXPANDED = 100
"""Times that an array may be larger than the whole file, where that is compressed."""
_FAULTS = (
    OSError,
    RuntimeError,
    LookupError,
    AttributeError,
    TypeError,
    ValueError,
    ArithmeticError,
)
"""What the library, and the use of what it gives, raise on damaged files."""


def content_of(path: Path, title: str, take: Callable[[Any, int], Content]) -> Content:
    """The content of an HDF5 file.

    Args:
        path: the file.
        title: what it is to be, in messages.
        take: from the open file, and the most bytes of an array, to the content.

    Raises:
        MeshError: it is no HDF5 file, or damaged.
    """
    import h5py

    data = path.read_bytes()
    if not data.startswith(_SIGNATURE):
        raise MeshError(f"it is no {title} file: it does not begin as HDF5 does")
    try:
        with h5py.File(io.BytesIO(data), "r") as file:
            return take(file, _EXPANDED * len(data) + 2**20)
    except MeshError:
        raise
    except _FAULTS as error:
        raise MeshError("it is cut off or damaged: its HDF5 structure") from error


def array(data: Any, most: int) -> Any:
    """A dataset as a flat array of float64 or int64, if it is not larger than `most` bytes."""
    if data.size * data.dtype.itemsize > most:
        raise MeshError("it is damaged: an array is larger than the file can hold")
    found = np.asarray(data[()]).ravel()
    return found.astype(np.float64 if found.dtype.kind == "f" else np.int64)
