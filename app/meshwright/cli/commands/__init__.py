"""The subcommands of ``meshwright``, one module each.

Such a module is light to import: it describes its arguments, and imports what it needs when it
runs.
"""

from __future__ import annotations

import argparse
from typing import Protocol

from meshwright.cli.commands import (
    bench,
    demo,
    evaluate,
    improve,
    lessons,
    levels,
    mesh,
    play,
    shapes,
    train,
    view,
)
from meshwright.console import Report


class Command(Protocol):
    """What a module of a subcommand offers."""

    SUMMARY: str
    DESCRIPTION: str

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Describe the arguments; ``--json`` is added to every command by the caller."""

    def run(self, arguments: argparse.Namespace, report: Report) -> None:
        """Do the work and report the result, or raise UserError."""


COMMANDS: dict[str, Command] = {
    "view": view,
    "demo": demo,
    "shapes": shapes,
    "mesh": mesh,
    "improve": improve,
    "evaluate": evaluate,
    "train": train,
    "lessons": lessons,
    "levels": levels,
    "play": play,
    "bench": bench,
}
