"""Options of exported pictures and films, and functions that write them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from meshwright.graphics.drawing import Drawing, raster, svg
from meshwright.graphics.export import video
from meshwright.graphics.export.film import Film
from meshwright.graphics.export.video import ReportProgress
from meshwright.graphics.mesh_figure import FigureOptions, figure
from meshwright_core import HalfEdgeMesh
from meshwright_core.errors import MeshError
from meshwright_core.io import atomic_write

FILMS = video.ENDINGS
STILLS = (".png", ".svg")
SIZES = ((640, 480), (960, 720), (1280, 720), (1920, 1080), (1200, 1200))
"""Sizes in pixels that the interface offers; sides are even, which H.264 requires."""
MOST_FRAMES = 600
"""By default a film with more frames than this skips steps."""


@dataclass(frozen=True)
class ExportOptions:
    """Options of an exported picture or film.

    ``ending`` is that of the file, ``seconds`` the duration of each frame, ``every`` the number of
    steps from frame to frame; 0: as many as keep the film below :data:`MOST_FRAMES`. The others are
    those of :class:`meshwright.graphics.mesh_figure.FigureOptions`.
    """

    ending: str = ".gif"
    size: tuple[int, int] = (960, 720)
    theme: str = "light"
    seconds: float = 0.25
    every: int = 0
    numbers: bool = True
    score: bool = True
    curve: bool = True
    changes: bool = True
    colours: str = "vermilion"
    measure: str = ""
    halfedge: int = -1
    """Drawn in pictures, not in films: other states may not have it."""

    @property
    def moving(self) -> bool:
        """True for a film, False for a picture of one state."""
        return self.ending in FILMS

    @property
    def figure_options(self) -> FigureOptions:
        """The options of its figures."""
        return FigureOptions(
            size=self.size,
            theme=self.theme,
            numbers=self.numbers,
            score=self.score,
            curve=self.curve,
            changes=self.changes,
            colours=self.colours,
            measure=self.measure,
            halfedge=-1 if self.moving else self.halfedge,
        )

    def stride(self, film: Film) -> int:
        """The number of steps from frame to frame."""
        return self.every or max(1, -(-len(film) // MOST_FRAMES))


def write_export(
    film: Film, options: ExportOptions, path: str | Path, progress: ReportProgress | None = None
) -> int:
    """Write as :func:`save_export` does, but atomically: if it fails, an existing file remains.

    Raises MeshError, which names ``path``, where the file cannot be written.
    """
    with atomic_write.replacing(path) as temporary:
        return save_export(film, options, temporary, progress)


def save_export(
    film: Film, options: ExportOptions, path: Path, progress: ReportProgress | None = None
) -> int:
    """Write a film, or a picture of its present state; returns the number of frames.

    ``progress(done, total)`` is called after each frame and may raise to cancel. Raises OSError if
    the file cannot be written, MeshError for an unknown ending.
    """
    if options.moving:
        return film.save(
            path, options.figure_options, options.seconds, options.stride(film), progress
        )
    save_picture(figure(film.mesh, options.figure_options, film.moment(film.state)), path)
    if progress is not None:
        progress(1, 1)
    return 1


def save_mesh_picture(
    mesh: HalfEdgeMesh, path: str | Path, options: FigureOptions | None = None
) -> None:
    """Write one picture of ``mesh``; raises as :func:`save_picture` does."""
    save_picture(figure(mesh, options), path)


def save_picture(drawing: Drawing, path: str | Path) -> None:
    """Write a drawing as PNG or SVG, by the ending of ``path``.

    Raises OSError if the file cannot be written, MeshError for another ending.
    """
    path = Path(path)
    ending = path.suffix.lower()
    if ending == ".svg":
        path.write_text(svg(drawing), encoding="utf-8")
    elif ending == ".png":
        raster(drawing).save(path, format="PNG", optimize=True)
    else:
        found = f"the ending {ending}" if ending else "a name without an ending"
        raise MeshError(f"{path}: a picture cannot have {found}; use {' or '.join(STILLS)}.")
