"""``meshwright play``: open the window on a level."""

from __future__ import annotations

import argparse

from meshwright.cli import display_check
from meshwright.console import Report, UserError

SUMMARY = "open the window on a level"
DESCRIPTION = (
    "Open the window on a level: reach the lowest score with as few operations as you can. "
    "Without a name, on the first level that has no star yet; meshwright levels lists them."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("level", metavar="LEVEL", nargs="?", help="name of a level")


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Find the level, then open the window on it; return when it is closed."""
    probe = display_check.DisplayProbe()
    from meshwright.puzzles import level as levels
    from meshwright_core import MeshError

    try:
        level = levels.load(arguments.level if arguments.level is not None else _first())
    except MeshError as error:
        raise UserError(str(error).rstrip(".")) from error
    problem = probe.problem()
    if problem:
        raise UserError(f"{problem}; levels can be played in a notebook, too")
    from meshwright import desktop

    code = desktop.run(level=level)
    if code != 0:
        raise RuntimeError(f"the window ended with code {code}")
    if report.as_json:
        report.result({"command": "play", "level": level.name}, "")


def _first() -> str:
    """The first level without a star, else the first of all."""
    from meshwright.puzzles import level as levels
    from meshwright.puzzles.progress import LevelProgress

    progress, names = LevelProgress(), levels.names()
    return next((name for name in names if not progress.best(name).stars), names[0])
