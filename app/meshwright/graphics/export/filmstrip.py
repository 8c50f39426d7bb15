"""A sequence of operations as one picture: the mesh at the start, half-way and at the end."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.graphics.drawing import raster
from meshwright.graphics.mesh_figure import FigureOptions, HistoryMoment, elements, figure
from meshwright_core.io.atomic_write import replacing

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh, Operation

FRAME_SIZE = (800, 800)


def write(
    path: Path,
    mesh: HalfEdgeMesh,
    operations: Sequence[tuple[Operation, int]],
    theme: str = "light",
    size: tuple[int, int] = FRAME_SIZE,
) -> None:
    """Write the three states side by side as a PNG of ``3 * size``; the mesh is not changed.

    Raises MeshError, one sentence that begins with the path, if the file cannot be written.
    """
    from meshwright_core.geometry import smoothing

    work = mesh.copy()
    options = FigureOptions(size, theme)
    frames = []
    done = 0
    for stop in (0, len(operations) // 2, len(operations)):
        for operation, halfedge in operations[done:stop]:
            work.apply(operation, halfedge)
        done = stop
        smoothing.relax(work)
        words = f"{done:,} of {len(operations):,} operations" if operations else ""
        frames.append(raster(figure(work, options, HistoryMoment(elements(work), words))))
    with replacing(path) as temporary:
        side_by_side(frames).save(temporary, format="PNG")


def side_by_side(images: Sequence[Any]) -> Any:
    """Return one Pillow image with these of the same height from left to right."""
    from PIL import Image

    whole = Image.new("RGB", (sum(i.width for i in images), images[0].height))
    left = 0
    for image in images:
        whole.paste(image, (left, 0))
        left += image.width
    return whole
