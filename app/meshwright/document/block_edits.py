"""Edits of the blocks of a document: numbers of cells, gradings, lines. Each is one undoable step.

Raises MeshError, one sentence, where an edit is impossible; the document is then as before.
"""

from __future__ import annotations

from dataclasses import replace

from meshwright.document.block_lines import Move, slid, straightened
from meshwright.document.document import Document
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.analysis.element_division import chords
from meshwright_core.blocks.sizing import Sizing, division
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.core.grid_plan import Edge, Grading, GridPlan
from meshwright_core.geometry.quality import inverted

MOST_ACROSS = 100_000
"""Cells along an edge that can be asked for."""


def chord_edges(structure: BlockStructure, chord: int) -> list[Edge]:
    """The ends of the edges of a chord, in its direction, as ids of the mesh."""
    rows = structure.vertices[structure.edges[structure.chord == chord]]
    return [(int(a), int(b)) for a, b in rows]


def set_count(document: Document, structure: BlockStructure, chord: int, count: int | None) -> None:
    """Give a chord a number of cells, None for what size and evenness make of it.

    Raises GridConflictError where other wishes contradict it.
    """
    if count is not None and not 1 <= count <= MOST_ACROSS:
        raise MeshError(f"A number of cells must be 1 to {MOST_ACROSS:,}.")
    plan = document.need_mesh().grid_plan.with_count(chord_edges(structure, chord), count)
    title = "cells by size" if count is None else f"{count} cells"
    change_plan(document, plan, f"Chord {chord}: {title}", structure)


def set_grading(
    document: Document, structure: BlockStructure, chord: int, grading: Grading | None
) -> None:
    """Grade the edges of a chord, None for even cells or the layers of walls."""
    if grading is not None and not (grading.first or grading.last):
        grading = None
    plan = document.need_mesh().grid_plan.with_grading(chord_edges(structure, chord), grading)
    what = "even cells" if grading is None else "grading"
    change_plan(document, plan, f"Chord {chord}: {what}", structure)


def set_side_count(
    document: Document, structure: BlockStructure, name: str, count: int | None
) -> None:
    """Give a named side a number of cells in all, None for no wish."""
    plan = document.need_mesh().grid_plan
    counts = {side: n for side, n in plan.side_counts.items() if side != name}
    if count is not None:
        counts[name] = count
    title = f"{count} cells on {name}" if count is not None else f"Cells by size on {name}"
    change_plan(document, replace(plan, side_counts=counts), title, structure)


def change_plan(
    document: Document, plan: GridPlan, title: str, structure: BlockStructure | None = None
) -> None:
    """Set the wishes for the grid, unless they contradict each other."""
    blocks = structure or BlockStructure.of(document.need_mesh())
    division(blocks, Sizing.planned(blocks, plan))
    document.plan_grid(plan, title)


def slide(document: Document, halfedge: int, share: float) -> None:
    """Slide the line through a half-edge; see :func:`meshwright.document.block_lines.slid`."""
    mesh = document.need_mesh()
    _place(document, mesh, slid(mesh, halfedge, share), "Slide line", "slide so far")


def straighten(document: Document, halfedge: int) -> None:
    """Make the line through a half-edge straight between its ends."""
    mesh = document.need_mesh()
    _place(document, mesh, straightened(mesh, halfedge), "Straighten line", "be straight")


def _place(document: Document, mesh: HalfEdgeMesh, move: Move, title: str, what: str) -> None:
    """Move vertices as one step, unless blocks fold that did not before."""
    if folds(mesh, move):
        raise MeshError(f"This line cannot {what}: a block would be inverted.")
    document.move(move.vertices, move.positions, parameters=move.parameters, title=title)


def folds(mesh: HalfEdgeMesh, move: Move) -> bool:
    """Whether more blocks are inverted after a move than before; the mesh is not changed."""
    moved = mesh.copy()
    before = len(inverted(moved))
    moved.move(move.vertices, move.positions, move.parameters)
    return len(inverted(moved)) > before


def chord_of(mesh: HalfEdgeMesh, halfedge: int) -> int:
    """The chord of the edge of a half-edge."""
    row = int((mesh.element_ids() < halfedge // 4).sum())
    return int(chords(mesh)[row, halfedge % 2])
