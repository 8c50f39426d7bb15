"""A run of operations as one picture: the mesh at the start, half-way and at the end."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from app.outputs import replacing

if TYPE_CHECKING:
    from meshcore.operations import Operation

    from meshcore import HalfEdgeMesh

FRAME_SIZE = (800, 800)


def write(
    path: Path,
    mesh: HalfEdgeMesh,
    operations: Sequence[tuple[Operation, int]],
    theme: str = "light",
    size: tuple[int, int] = FRAME_SIZE,
) -> None:
    """Write the three states side by side as a PNG; the mesh itself is not changed.

    Raises UserError if the file cannot be written.
    """
    from PIL import Image

    from app import scene
    from meshcore import smoothing

    stops = (0, len(operations) // 2, len(operations))
    work = mesh.copy()
    done = 0
    frames = []
    with tempfile.TemporaryDirectory() as folder:
        for number, stop in enumerate(stops):
            for operation, halfedge in operations[done:stop]:
                work.apply(operation, halfedge)
            done = stop
            smoothing.relax(work)
            frame = Path(folder) / f"{number}.png"
            scene.picture(work, frame, size=size, theme=theme)
            with Image.open(frame) as image:
                frames.append(image.convert("RGB"))
    strip = Image.new("RGB", (sum(f.width for f in frames), max(f.height for f in frames)))
    left = 0
    for image in frames:
        strip.paste(image, (left, 0))
        left += image.width
    with replacing(path) as temporary:
        strip.save(temporary, format="PNG")
