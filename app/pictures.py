"""Pictures and films to order: what to write, how large, how long, and the writing of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from app import movie
from app.drawing import Drawing, raster, svg
from app.figure import Look, figure
from app.film import Film
from meshcore import HalfEdgeMesh, atomic
from meshcore.errors import MeshError

FILMS = movie.ENDINGS
STILLS = (".png", ".svg")
SIZES = ((640, 480), (960, 720), (1280, 720), (1920, 1080), (1200, 1200))
"""Pixels on offer; all sides are even, as films want it."""
MOST_FRAMES = 600
"""A film that is not told otherwise leaves steps out rather than have more frames."""


@dataclass(frozen=True)
class Order:
    """What a person wants written. ``seconds`` each frame stays; ``every`` how many steps a frame
    stands for, 0 for as many as keep the film below :data:`MOST_FRAMES`.
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

    @property
    def moving(self) -> bool:
        """True for a film, False for a picture of one state."""
        return self.ending in FILMS

    @property
    def look(self) -> Look:
        """What its figures show."""
        return Look(
            size=self.size,
            theme=self.theme,
            numbers=self.numbers,
            score=self.score,
            curve=self.curve,
            changes=self.changes,
            colours=self.colours,
        )

    def stride(self, film: Film) -> int:
        """Steps that one frame stands for."""
        return self.every or max(1, -(-len(film) // MOST_FRAMES))


def write_order(
    film: Film, order: Order, path: str | Path, progress: Callable[[int, int], None] | None = None
) -> int:
    """Write a film, or a picture of the state where ``film`` stands; returns the frames written.

    ``progress(done, total)`` is called after each frame; what it raises ends the work. Raises
    MeshError where the file cannot be written.
    """
    if order.moving:
        stride = order.stride(film)
        return film.write(path, order.look, order.seconds, stride, progress)
    moment = film.moment(film.state)
    write_picture(figure(film.mesh, order.look, moment), path)
    if progress is not None:
        progress(1, 1)
    return 1


def write_mesh_picture(mesh: HalfEdgeMesh, path: str | Path, look: Look | None = None) -> None:
    """Write one picture of ``mesh``, PNG or SVG; MeshError where it cannot be written."""
    write_picture(figure(mesh, look), path)


def write_picture(drawing: Drawing, path: str | Path) -> None:
    """Write a drawing as PNG or SVG, as the ending says; MeshError where it cannot be written."""
    ending = Path(path).suffix.lower()
    if ending not in STILLS:
        found = f"the ending {ending}" if ending else "a name without an ending"
        raise MeshError(f"{path}: a picture cannot have {found}; use {' or '.join(STILLS)}.")
    with atomic.replacing(path) as temporary:
        if ending == ".svg":
            temporary.write_text(svg(drawing), encoding="utf-8")
        else:
            raster(drawing).save(temporary, format="PNG", optimize=True)
