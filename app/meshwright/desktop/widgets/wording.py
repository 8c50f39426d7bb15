"""Numbers, sentences and history steps as text."""

from __future__ import annotations

from meshwright.document.history import YOU, Row
from meshwright.graphics.markers import label


def plural(count: int, one: str, many: str = "") -> str:
    """``1 element``, ``1,200 elements``; ``many`` where the plural is not ``one`` with an s."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def sentence(text: str) -> str:
    """``text`` with a capital first letter and a full stop."""
    text = text[:1].upper() + text[1:]
    return text if text.endswith((".", "\u2026", "!", "?")) else text + "."


def step_message(row: Row | None) -> str:
    """``Flip left by quad-paper:  s 8 \u2192 6  (\u22122)``, for the status bar; empty for None."""
    if row is None:
        return ""
    return f"{_authored(row)}:  s {row.before} \u2192 {row.after}  ({label(row.change)})"


def step_words(row: Row) -> str:
    """``Flip left by quad-paper, \u22122``, for lists and tooltips."""
    return f"{_authored(row)}, {label(row.change)}"


def branch_words(rows: tuple[Row, ...]) -> str:
    """``Branch: 12 steps to s 6``."""
    return f"Branch: {plural(len(rows), 'step')} to s {rows[-1].after:,}"


def _authored(row: Row) -> str:
    return row.title if row.by == YOU else f"{row.title} by {row.by}"
