"""The mesh file that a command writes: its ending, the last care for positions, the writing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from app.outputs import checked_output, reason
from app.report import UserError

if TYPE_CHECKING:
    from meshcore import HalfEdgeMesh

SHOWN_IDS = 20


def checked_mesh_output(path: str, kind: str | None = None) -> Path:
    """Return the path if a mesh of this kind can be written there, or raise UserError."""
    from meshcore import io

    return checked_output(path, tuple(io.writable_endings(kind)))


def settle(mesh: HalfEdgeMesh) -> list[int]:
    """Smooth and untangle the whole mesh; return the elements that stay inverted.

    An element is named by its row in ``mesh.elements()``, which is its place in the written file,
    counted from 0.
    """
    import numpy as np

    from meshcore import smoothing

    inverted = smoothing.relax(mesh)
    return [int(row) for row in np.flatnonzero(np.isin(mesh.element_ids(), inverted))]


def write_mesh(path: Path, mesh: HalfEdgeMesh) -> None:
    """Write the mesh whole or not at all; an operating system error becomes a UserError."""
    import meshcore

    try:
        meshcore.write(path, mesh)
    except OSError as error:
        state = "the old file is as it was" if path.exists() else "nothing was written"
        raise UserError(f"cannot write {path}: {reason(error)}; {state}") from error


def inverted_words(rows: Sequence[int], lead: str = "") -> str:
    """Name the inverted elements, or return an empty text if there are none."""
    if not rows:
        return ""
    named = " ".join(str(row) for row in rows[:SHOWN_IDS])
    more = f" and {len(rows) - SHOWN_IDS} more" if len(rows) > SHOWN_IDS else ""
    return f"{lead}{len(rows)} inverted (elements {named}{more}, counted from 0)"
