"""``meshwright levels``: list the levels, with what has been won."""

from __future__ import annotations

import argparse

from meshwright.console import Report, UserError, table

SUMMARY = "list the levels: meshes with a goal, a par and stars"
DESCRIPTION = (
    "List the levels, the easiest first, with their par and the stars that were won; "
    "meshwright play NAME opens the window on one."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add no arguments."""


def run(arguments: argparse.Namespace, report: Report) -> None:
    """List each level with its properties and the best result."""
    from meshwright.puzzles import level as levels
    from meshwright.puzzles.progress import LevelProgress
    from meshwright_core import MeshError

    progress, rows = LevelProgress(), []
    lines: list[tuple[str, object]] = []
    try:
        found = levels.all()
    except MeshError as error:
        raise UserError(str(error)) from error
    for level in found:
        best = progress.best(level.name)
        rows.append(
            {
                "name": level.name,
                "title": level.title,
                "kind": level.kind,
                "elements": len(level.elements),
                "goal": level.goal,
                "most": level.most,
                "par": level.par,
                "proved": level.proved,
                "stars": best.stars,
                "used": best.used,
            }
        )
        won = f", {'*' * best.stars} in {best.used}" if best.stars else ""
        lines.append((level.name, f"{level.title}: {level.story}{won}"))
    text = table(lines, indent="")
    report.result({"command": "levels", "levels": rows}, text)
