"""``meshwright view``, and ``meshwright`` alone: open the window."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from meshwright.cli import arguments as inputs
from meshwright.cli import display_check
from meshwright.console import Report, UserError
from meshwright.sources.naming import looks_like_path

if TYPE_CHECKING:
    from meshwright.document.document import Document

SUMMARY = "open the window, on a mesh file or a shape if one is named"
DESCRIPTION = "Open the window. meshwright FILE is short for meshwright view FILE."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "file",
        metavar="FILE-or-SHAPE",
        nargs="?",
        help="mesh file, project (.meshwright), file of a shape (.dxf .svg .geojson .wkt .poly "
        ".dat .json) or name of a shape",
    )
    parser.add_argument(
        "--kind", choices=("tri", "quad"), default="quad", help="elements of a shape (quad)"
    )
    parser.add_argument(
        "--corner-angle",
        metavar="DEGREES",
        type=inputs.angle,
        help="a boundary vertex is a corner where the boundary turns by more (0.01)",
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """Read what is to be opened, then open the window; return when it is closed."""
    probe = display_check.DisplayProbe()
    document = _document(arguments)
    problem = probe.problem()
    if problem:
        raise UserError(f"{problem}; without one, meshwright demo writes a picture")
    from meshwright import desktop

    code = desktop.run(document)
    if code != 0:
        raise RuntimeError(f"the window ended with code {code}")
    if report.as_json:
        report.result({"command": "view", "file": arguments.file}, "")


def _document(arguments: argparse.Namespace) -> Document | None:
    name = arguments.file
    if name is None:
        return None
    if not looks_like_path(name) and not Path(name).exists():
        _refuse_near_command(name)
    return inputs.read_document(name, arguments.kind, arguments.corner_angle)


def _refuse_near_command(word: str) -> None:
    """Raise UserError if the word is no shape but close to a command: ``meshwright improv``."""
    from difflib import get_close_matches

    from meshwright.cli.commands import COMMANDS
    from meshwright_core.domains import gallery

    close = get_close_matches(word, COMMANDS, n=1, cutoff=0.75)
    if close and word not in gallery.names():
        raise UserError(
            f"{word}: neither a command, a shape nor a file; did you mean the command {close[0]}?"
        )
