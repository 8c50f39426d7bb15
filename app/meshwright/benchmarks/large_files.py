"""Files of a million elements: seconds to read and write each format, beside meshio."""

from __future__ import annotations

import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from meshwright.console import Update, no_update
from meshwright_core.domains import meshing
from meshwright_core.io.content import Content
from meshwright_core.io.formats import FORMATS, Format, contained

SUMMARY = "files of a million elements: seconds to read and write them, beside meshio"
ELEMENTS, QUICK = 1_000_000, 400
_ALIKE = (".nas", ".fem", ".tec", ".gltf", ".xmf")
"""Other endings of formats that are measured."""


def run(seed: int, quick: bool, update: Update = no_update) -> dict[str, Any]:
    """Write and read a grid of a million triangles (``quick``: 400) in each format.

    By ending: seconds of processor time of ``write`` and ``read`` of points, elements and names,
    before a mesh is built of them; ``meshio_write`` and ``meshio_read``, of the same mesh and of
    our file, by meshio, None where it cannot; and ``megabytes`` of our file.
    """
    points, elements, _ = meshing.grid_arrays("tri", QUICK if quick else ELEMENTS)
    places = np.column_stack([points, np.zeros(len(points))])
    content = Content(places, {"triangle": np.asarray(elements, np.int64)}, {})
    results: dict[str, Any] = {"elements": len(elements)}
    with tempfile.TemporaryDirectory() as folder:
        for ending, form in FORMATS.items():
            if ending in _ALIKE or form.needs or not form.kinds:
                continue
            update(len(results), ending)
            path = Path(folder) / f"grid{ending}"
            results[ending] = _measured(path, form, content)
            for file in Path(folder).iterdir():
                file.unlink()
    return results


def _measured(path: Path, form: Format, content: Content) -> dict[str, Any]:
    with contained():
        write = _seconds(lambda: form.write(path, content))
    read = _seconds(lambda: form.read(path))
    own = path.with_stem("meshio")
    megabytes = round(path.stat().st_size / 1e6, 1)
    return {
        "write": write,
        "read": read,
        "meshio_write": _by_meshio(lambda meshio: _meshio_mesh(meshio, content).write(own)),
        "meshio_read": _by_meshio(lambda meshio: meshio.read(path)),
        "megabytes": megabytes,
    }


def _meshio_mesh(meshio: Any, content: Content) -> Any:
    return meshio.Mesh(content.points, list(content.cells.items()))


def _by_meshio(work: Callable[[Any], object]) -> float | None:
    """Seconds that it takes; None if meshio cannot."""
    try:
        with contained(), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            import meshio

            return _seconds(lambda: work(meshio))
    except ValueError:
        return None


def _seconds(work: Callable[[], object]) -> float:
    began = time.process_time()
    work()
    return round(time.process_time() - began, 2)
