"""Numbers, sentences and history steps as text."""

from __future__ import annotations

from meshwright.document.history import YOU, HistoryStep
from meshwright.graphics.markers import label


def plural(count: int, one: str, many: str = "") -> str:
    """``1 element``, ``1,200 elements``; ``many`` where the plural is not ``one`` with an s."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"


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
