"""The subcommands of ``meshwright``, one module each.

The modules are light to import: heavy packages are imported when a command runs.
"""

from __future__ import annotations

import argparse
from typing import Protocol

from meshwright.cli.commands import (
    batch,
    bench,
    blocks,
    demo,
    evaluate,
    improve,
    info,
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
    """Interface of a subcommand's module."""

    SUMMARY: str
    DESCRIPTION: str

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Add the arguments; the caller adds ``--json`` to every command."""

    def run(self, arguments: argparse.Namespace, report: Report) -> int | None:
        """Do the work and report the result, or raise UserError; return an exit code other than 0
        where the result is there but flawed.
        """


COMMANDS: dict[str, Command] = {
    "view": view,
    "demo": demo,
    "shapes": shapes,
    "info": info,
    "mesh": mesh,
    "improve": improve,
    "blocks": blocks,
    "batch": batch,
    "evaluate": evaluate,
    "train": train,
    "lessons": lessons,
    "levels": levels,
    "play": play,
    "bench": bench,
}
