"""Checks and writes the mesh file of a command, and names inverted elements in its report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from meshwright.cli.output_files import checked_output
from meshwright.console import UserError

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh

SHOWN_IDS = 20


def checked_mesh_output(path: str, kind: str | None = None) -> Path:
    """Return the path if a mesh of this kind, or of any, can be written there; else UserError."""
    from meshwright_core.core.kinds import ELEMENT_NOUN
    from meshwright_core.io import formats

    noun = ELEMENT_NOUN.get(kind or "")
    fit = [ending for ending, form in formats.FORMATS.items() if not noun or noun in form.kinds]
    return checked_output(path, tuple(fit))


def write_mesh(path: Path, mesh: HalfEdgeMesh) -> None:
    """Write the mesh atomically; raise UserError if the system refuses."""
    import meshwright_core
    from meshwright_core.errors import MeshError

    try:
        meshwright_core.write(path, mesh)
    except MeshError as error:
        raise UserError(str(error)) from error


def inverted_words(rows: Sequence[int], lead: str = "") -> str:
    """Name the inverted elements, or return an empty text if there are none."""
    if not rows:
        return ""
    named = " ".join(str(row) for row in rows[:SHOWN_IDS])
    more = f" and {len(rows) - SHOWN_IDS} more" if len(rows) > SHOWN_IDS else ""
    return f"{lead}{len(rows)} inverted (elements {named}{more}, counted from 0)"
