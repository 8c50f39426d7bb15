"""Writes frames to a GIF or an MP4 file, one at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from meshwright.graphics.mesh_figure import FigureOptions
from meshwright.graphics.theme import Theme
from meshwright_core.errors import MeshError

ENDINGS = (".gif", ".mp4")
RATE = 20
"""Frames per second of an MP4; figures that last longer are repeated."""
QUALITY = "18"
"""The constant rate factor of the encoder; at 18 no loss is visible."""
LEVELS = 14
"""Shades in the palette of a GIF between two adjacent colours."""
NEAR = 4
"""Shades that differ by less in every channel share an entry of the palette."""
SHORTEST = 0.02
"""The shortest duration of a GIF frame in seconds; viewers slow down shorter ones."""

Frames = Iterable[tuple[Any, float]]
ReportProgress = Callable[[int, int], None]


def checked_ending(path: str | Path) -> str:
    """The ending of a film's file in lower case; MeshError unless it is one of ENDINGS."""
    ending = Path(path).suffix.lower()
    if ending not in ENDINGS:
        found = f"the ending {ending}" if ending else "a name without an ending"
        raise MeshError(f"{path}: a film cannot have {found}; use {' or '.join(ENDINGS)}.")
    return ending


def save(
    path: Path,
    frames: Frames,
    count: int,
    options: FigureOptions,
    progress: ReportProgress | None = None,
) -> None:
    """Write ``count`` frames, each a Pillow image of ``options.size`` and its seconds, to ``path``.

    ``progress(done, count)`` is called after each and may raise to cancel, which leaves a partial
    file; :func:`meshwright.graphics.export.export_job.write_export` writes atomically. Raises
    MeshError for another ending or a size that cannot be encoded, OSError if the file cannot be
    written.
    """
    followed = _followed(frames, count, progress)
    if checked_ending(path) == ".gif":
        _save_gif(path, followed, options)
    else:
        _save_mp4(path, followed, options)


def _followed(
    frames: Frames, count: int, progress: ReportProgress | None
) -> Iterator[tuple[Any, float]]:
    for done, frame in enumerate(frames, start=1):
        yield frame
        if progress is not None:
            progress(done, count)


# GIF


def _save_gif(path: Path, frames: Iterator[tuple[Any, float]], options: FigureOptions) -> None:
    """Write frames with one palette, each cropped to the pixels that differ from the last one."""
    from PIL.GifImagePlugin import getdata

    before: Any = None
    with path.open("wb") as file:
        for image, seconds in frames:
            small = quantised(image, options.palette)
            place, shown = (0, 0), small
            if before is None:
                file.write(_gif_header(small))
            else:
                box = _differing(small, before)
                place, shown = box[:2], small.crop(box)
            duration = round(1000 * max(seconds, SHORTEST))
            for block in getdata(shown, place, duration=duration, disposal=1):
                file.write(block)
            before = small
        file.write(b";")


def _differing(image: Any, before: Any) -> tuple[int, int, int, int]:
    """The bounding box of pixels that differ; one pixel if none do, as a frame needs some."""
    differs = np.asarray(image) != np.asarray(before)
    rows, columns = np.flatnonzero(differs.any(axis=1)), np.flatnonzero(differs.any(axis=0))
    if len(rows) == 0:
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def quantised(image: Any, colours: Theme) -> Any:
    """A Pillow image in the 256 colours of a theme's :func:`palette`."""
    from PIL import Image

    few = Image.new("P", (1, 1))
    few.putpalette(palette(colours))
    return image.quantize(palette=few, dither=Image.Dither.NONE)


@cache
def palette(colours: Theme) -> tuple[int, ...]:
    """256 colours as 768 numbers: those of a theme, and shades between adjacent ones."""
    t = colours
    meeting = (
        (t.background, t.fill),
        (t.fill, t.edge),
        (t.fill, t.boundary),
        (t.background, t.boundary),
        (t.background, t.plus),
        (t.background, t.minus),
        (t.plus, t.marker_text),
        (t.minus, t.marker_text),
        (t.background, t.text),
        (t.background, t.muted),
        (t.background, t.accent),
        (t.fill, t.accent),
        (t.edge, t.accent),
        (t.edge, t.boundary),
        (t.boundary, t.accent),
        (t.background, t.faint),
        (t.fill, t.faint),
        (t.background, t.line),
        (t.fill, t.warning),
        *((tint, t.edge) for tint in t.tints[1:]),
    )
    shares = np.linspace(0.0, 1.0, LEVELS)[:, None]
    mixed = [(1 - shares) * _rgb(a) + shares * _rgb(b) for a, b in meeting]
    pure = [_rgb(colour)[None] for pair in meeting for colour in pair]
    whole = np.zeros((256, 3), dtype=int)
    count = 0
    for row in np.round(np.concatenate([*pure, *mixed])).astype(int):
        if count < 256 and (count == 0 or np.abs(whole[:count] - row).max(axis=1).min() >= NEAR):
            whole[count] = row
            count += 1
    whole[count:] = whole[0]
    return tuple(whole.ravel().tolist())


def _rgb(colour: str) -> np.ndarray:
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)], dtype=float)


def _gif_header(image: Any) -> bytes:
    """The header: size, the shared palette, and an endless loop."""
    width, height = image.size
    size = width.to_bytes(2, "little") + height.to_bytes(2, "little")
    table = bytes(image.getpalette()[:768]).ljust(768, b"\0")
    again = b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00"
    return b"GIF89a" + size + b"\xf7\x00\x00" + table + again


# MP4


def _save_mp4(path: Path, frames: Iterator[tuple[Any, float]], options: FigureOptions) -> None:
    """Write H.264 in YUV 4:2:0, which all players support; odd sides are cropped to even ones."""
    import av
    from av.error import FFmpegError

    try:
        with av.open(str(path), "w", format="mp4", options={"movflags": "faststart"}) as file:
            stream = file.add_stream("libx264", rate=RATE)
            stream.width, stream.height = (side - side % 2 for side in options.size)
            stream.pix_fmt = "yuv420p"
            stream.options = {"crf": QUALITY, "preset": "veryfast", "tune": "animation"}
            for image, times in _repeated(frames):
                frame = av.VideoFrame.from_image(image.crop((0, 0, stream.width, stream.height)))
                for _ in range(times):
                    frame.pts = None
                    file.mux(stream.encode(frame))
            file.mux(stream.encode(None))
    except (FFmpegError, ValueError) as error:
        if isinstance(error, OSError):
            raise
        raise MeshError(f"the film cannot be encoded ({error}).") from error


def _repeated(frames: Iterator[tuple[Any, float]]) -> Iterator[tuple[Any, int]]:
    """Each frame and how often it is repeated; rounding errors do not add up."""
    due, shown = 0.0, 0
    for image, seconds in frames:
        due += seconds * RATE
        times = max(1, round(due) - shown)
        shown += times
        yield image, times
