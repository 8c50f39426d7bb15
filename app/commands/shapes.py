"""``meshwright shapes``: list the gallery."""

from __future__ import annotations

import argparse

from app.report import Report, table

SUMMARY = "list the shapes of the gallery"
DESCRIPTION = "List the shapes that mesh, view and demo know by name."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Take none of its own."""


def run(arguments: argparse.Namespace, report: Report) -> None:
    """List each shape with its corners and holes."""
    from meshcore import shapes

    rows = []
    for name, domain in shapes.gallery().items():
        points = len(domain.outline) + sum(len(hole) for hole in domain.holes)
        rows.append({"name": name, "points": points, "holes": len(domain.holes)})
    text = table([(row["name"], _words(row["points"], row["holes"])) for row in rows], indent="")
    report.result({"command": "shapes", "shapes": rows}, text)


def _words(points: int, holes: int) -> str:
    if not holes:
        return f"{points} points"
    return f"{points} points, {holes} hole{'s' if holes > 1 else ''}"
