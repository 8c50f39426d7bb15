"""``meshwright shapes``: list the gallery."""

from __future__ import annotations

import argparse
from typing import Any

from meshwright.console import Report, table

SUMMARY = "list the shapes of the gallery"
DESCRIPTION = "List the gallery shapes, which mesh, view and demo take by name."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add no arguments."""


def run(arguments: argparse.Namespace, report: Report) -> None:
    """List each shape with its corners and holes."""
    from meshwright_core.domains import gallery

    rows: list[dict[str, Any]] = []
    for name, domain in gallery.gallery().items():
        corners = sum(int(flags.sum()) for flags in domain.loop_corners)
        rows.append({"name": name, "corners": corners, "holes": len(domain.holes)})
    text = table([(row["name"], _words(row["corners"], row["holes"])) for row in rows], indent="")
    report.result({"command": "shapes", "shapes": rows}, text)


def _words(corners: int, holes: int) -> str:
    words = _count(corners, "corner") if corners else "round"
    return words + (f", {_count(holes, 'hole')}" if holes else "")


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
