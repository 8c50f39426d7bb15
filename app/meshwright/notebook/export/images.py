"""Images and animations of a document as bytes, and as files where a path is given."""

from __future__ import annotations

import os
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from meshwright.document.document import Document
from meshwright.graphics.export.export_job import ExportOptions, save_export
from meshwright.graphics.export.film import Film
from meshwright.graphics.export.video import ReportProgress
from meshwright.graphics.theme import THEMES
from meshwright_core import MeshError
from meshwright_core.arguments import is_whole_number
from meshwright_core.io import atomic_write

SIZE = (960, 720)
"""Default size in pixels."""
SMALLEST, LARGEST = 32, 8192
"""Bounds of width and height in pixels."""
SECONDS = 0.25
"""Default duration of a frame in seconds."""
LONGEST = 60.0
"""Longest duration of a frame in seconds."""

File = str | os.PathLike[str] | None


def png(
    document: Document,
    size: tuple[int, int] = SIZE,
    path: File = None,
    theme: str = "light",
    halfedge: int = -1,
) -> bytes:
    """An image of the present state as PNG, ``size`` in pixels; also written to ``path``.

    ``halfedge`` is shown as an arrow, -1 for none.
    This and all others raise MeshError where there is no mesh, a number is out of range, or
    ``path`` cannot be written; an existing file is unchanged then.
    """
    return _made(document, ".png", size, path, theme, halfedge=halfedge)


def svg(
    document: Document,
    size: tuple[int, int] = SIZE,
    path: File = None,
    theme: str = "light",
    halfedge: int = -1,
) -> str:
    """An image of the present state as SVG; also written to ``path``."""
    return _made(document, ".svg", size, path, theme, halfedge=halfedge).decode("utf-8")


def gif(
    document: Document,
    seconds: float = SECONDS,
    size: tuple[int, int] = SIZE,
    path: File = None,
    theme: str = "light",
    progress: ReportProgress | None = None,
) -> bytes:
    """The history as GIF, each frame ``seconds`` long; also written to ``path``.

    A long history is shown in a few hundred frames of several steps each. ``progress(done, total)``
    is called after each frame. An interrupt ends it, and leaves an existing file unchanged.
    """
    return _made(document, ".gif", size, path, theme, seconds, progress)


def mp4(
    document: Document,
    path: File = None,
    seconds: float = SECONDS,
    size: tuple[int, int] = SIZE,
    theme: str = "light",
    progress: ReportProgress | None = None,
) -> bytes:
    """The history as MP4 (H.264); otherwise as :func:`gif`."""
    return _made(document, ".mp4", size, path, theme, seconds, progress)


def _made(
    document: Document,
    ending: str,
    size: tuple[int, int],
    path: File,
    theme: str,
    seconds: float = SECONDS,
    progress: ReportProgress | None = None,
    halfedge: int = -1,
) -> bytes:
    """The bytes of an image or animation; without ``path`` through a temporary folder."""
    options = ExportOptions(
        ending,
        _checked_size(size),
        _checked_theme(theme),
        seconds=_checked_seconds(seconds),
        halfedge=_checked_halfedge(document, halfedge),
    )
    if path is not None:
        _check_ending(path, ending)
    film = Film(document)
    if path is not None:
        with atomic_write.replacing(path) as temporary:
            save_export(film, options, temporary, progress)
            return temporary.read_bytes()
    try:
        with TemporaryDirectory(prefix="meshwright-") as folder:
            made = Path(folder) / f"picture{ending}"
            save_export(film, options, made, progress)
            return made.read_bytes()
    except OSError as error:
        raise MeshError(f"The image cannot be made ({atomic_write.reason(error)}).") from error


def _checked_size(size: Any) -> tuple[int, int]:
    sides = tuple(size) if isinstance(size, tuple | list) else ()
    fit = len(sides) == 2 and all(
        is_whole_number(side) and SMALLEST <= side <= LARGEST for side in sides
    )
    if not fit:
        raise MeshError(
            f"A size is two whole numbers of pixels from {SMALLEST} to {LARGEST:,}, not {size!r}."
        )
    return int(sides[0]), int(sides[1])


def _checked_halfedge(document: Document, halfedge: Any) -> int:
    mesh = document.mesh
    if not is_whole_number(halfedge):
        raise MeshError(f"A half-edge is a whole number, not {halfedge!r}.")
    if mesh is not None and halfedge != -1 and not mesh.live(int(halfedge)):
        raise MeshError(f"The mesh has no half-edge {halfedge}.")
    return int(halfedge)


def _checked_theme(theme: str) -> str:
    if theme not in THEMES:
        raise MeshError(f"There is no theme {theme!r}; choose one of {', '.join(THEMES)}.")
    return theme


def _checked_seconds(seconds: float) -> float:
    number = isinstance(seconds, int | float) and not isinstance(seconds, bool)
    if not number or not 0.0 < seconds <= LONGEST:
        raise MeshError(f"A frame lasts between 0 and {LONGEST:g} seconds, not {seconds!r}.")
    return float(seconds)


def _check_ending(path: str | os.PathLike[str], ending: str) -> None:
    if Path(path).suffix.lower() != ending:
        raise MeshError(f"{os.fspath(path)}: the name must end in {ending}.")
