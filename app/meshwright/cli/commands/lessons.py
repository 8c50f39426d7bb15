"""``meshwright lessons``: list the lessons, or copy them into a folder."""

from __future__ import annotations

import argparse
import shlex
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from meshwright.console import Report, UserError, table

if TYPE_CHECKING:
    from meshwright.teaching.lessons import Lesson

SUMMARY = "list the lessons, or copy them into a folder"
DESCRIPTION = (
    "List the lessons, or copy them into a folder to be opened in JupyterLab. They are notebooks "
    "with self-checking exercises, and take twenty to thirty minutes each."
)

INSTALL = 'pip install "meshwright[notebook]"'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("folder", metavar="FOLDER", nargs="?", help="where to copy the lessons to")
    parser.add_argument(
        "--force", action="store_true", help="overwrite lessons that are in the folder already"
    )


def run(arguments: argparse.Namespace, report: Report) -> None:
    """List the lessons, or copy them and print how to open them."""
    from meshwright.teaching import lessons
    from meshwright_core import MeshError

    found = lessons.shipped()
    if arguments.folder is None:
        if arguments.force:
            raise UserError("--force needs a FOLDER to copy the lessons to")
        report.result({"command": "lessons", "lessons": [_row(one) for one in found]}, _list(found))
        return
    if not arguments.folder:
        raise UserError("the name of the folder is empty")
    try:
        written = lessons.copy_to(arguments.folder, arguments.force)
    except MeshError as error:
        raise UserError(str(error)) from error
    opened = f"jupyter lab {shlex.quote(arguments.folder)}"
    values = {
        "command": "lessons",
        "folder": arguments.folder,
        "lessons": [_row(one) for one in found],
        "files": [str(path) for path in written],
        "open": opened,
    }
    text = f"{len(written)} lessons in {arguments.folder}\nopen them: {opened}"
    if find_spec("jupyterlab") is None:
        text += f"\nJupyterLab is not installed here: {INSTALL}"
    report.result(values, text)


def _row(lesson: Lesson) -> dict[str, Any]:
    return {
        "name": lesson.name,
        "title": lesson.title,
        "minutes": lesson.minutes,
        "exercises": sum(1 for _ in lesson.exercises()),
    }


def _list(found: list[Lesson]) -> str:
    rows = [(one.name, f"{one.minutes:2} min  {one.title}") for one in found]
    return table(rows, indent="") + "\n\ncopy them into a folder: meshwright lessons FOLDER"
