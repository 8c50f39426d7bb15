"""Numbers, sentences and history steps as text."""

from __future__ import annotations

from meshwright.document.history import YOU, HistoryStep
from meshwright.graphics.markers import label
from meshwright_core import HalfEdgeMesh


def plural(count: int, one: str, many: str = "") -> str:
    """``1 element``, ``1,200 elements``; ``many`` where the plural is not ``one`` with an s."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def halfedge_words(mesh: HalfEdgeMesh, halfedge: int) -> str:
    """``Half-edge 12:  3 \u2192 7,  side inlet,  region steel``, with the names that there are."""
    words = [f"Half-edge {halfedge}:  {mesh.origin(halfedge)} \u2192 {mesh.target(halfedge)}"]
    side = mesh.side_of(halfedge)
    if side:
        words.append(f"side {side}")
    if len(mesh.region_names) > 1 or mesh.region_names[0]:
        region = int(mesh.arrays.region[halfedge // mesh.k])
        words.append(f"region {mesh.region_names[region] or region + 1}")
    return ",  ".join(words)


def step_message(row: HistoryStep | None) -> str:
    """``Flip left by quad-paper:  s 8 \u2192 6  (\u22122)``, for the status bar; empty for None."""
    if row is None:
        return ""
    return f"{_authored(row)}:  s {row.before} \u2192 {row.after}  ({label(row.change)})"


def step_words(row: HistoryStep) -> str:
    """``Flip left by quad-paper, \u22122``, for lists and tooltips."""
    return f"{_authored(row)}, {label(row.change)}"


def branch_words(rows: tuple[HistoryStep, ...]) -> str:
    """``Branch: 12 steps to s 6``."""
    return f"Branch: {plural(len(rows), 'step')} to s {rows[-1].after:,}"


def _authored(row: HistoryStep) -> str:
    return row.title if row.by == YOU else f"{row.title} by {row.by}"
