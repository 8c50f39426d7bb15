"""The shipped lessons: their titles, their exercises, and copies of their notebooks.

A lesson is a Jupyter notebook in ``meshwright_assets/lessons``. Its metadata are ``{"meshwright":
{"lesson": number, "minutes": reading time}}``; the metadata of a cell with an exercise are
``{"meshwright": {"exercise": "1.2", "solution": code, "wrong": [code, ...]}}``. A solution replaces
all lines above the one that checks it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import meshwright_assets
from meshwright_core import MeshError
from meshwright_core.io import atomic_write

FOLDER = Path(meshwright_assets.__file__).parent / "lessons"
ENDING = ".ipynb"


@dataclass(frozen=True)
class ExerciseCell:
    """A cell with an exercise: its source, a solution, and some wrong answers."""

    name: str
    source: str
    solution: str
    wrong: tuple[str, ...]

    def answered(self, code: str) -> str:
        """The source with ``code`` in place of the lines above the check."""
        lines = self.source.split("\n")
        last = max(i for i, line in enumerate(lines) if ".check(" in line)
        return "\n".join([code, *lines[last:]])


@dataclass(frozen=True)
class Lesson:
    """A lesson: the notebook at ``path``."""

    path: Path

    @property
    def name(self) -> str:
        """The name of its file without the ending: ``01-half-edges``."""
        return self.path.stem

    @cached_property
    def notebook(self) -> dict[str, Any]:
        """The content of the notebook file."""
        return json.loads(self.path.read_text(encoding="utf-8"))

    @property
    def title(self) -> str:
        """Its first heading."""
        lines = "".join(self.notebook["cells"][0]["source"]).split("\n")
        return next(line[2:].strip() for line in lines if line.startswith("# "))

    @property
    def number(self) -> int:
        """Its place among the lessons, from 1 on."""
        return int(self.notebook["metadata"]["meshwright"]["lesson"])

    @property
    def minutes(self) -> int:
        """The reading time in minutes."""
        return int(self.notebook["metadata"]["meshwright"]["minutes"])

    def exercises(self) -> Iterator[ExerciseCell]:
        """Its exercises, from top to bottom."""
        for cell in self.notebook["cells"]:
            about = cell["metadata"].get("meshwright", {})
            if "exercise" in about:
                source, wrong = "".join(cell["source"]), tuple(about.get("wrong", ()))
                yield ExerciseCell(about["exercise"], source, about["solution"], wrong)


def shipped() -> list[Lesson]:
    """The shipped lessons in their order."""
    return [Lesson(path) for path in sorted(FOLDER.glob(f"*{ENDING}"))]


def copy_to(folder: str | Path, force: bool = False) -> list[Path]:
    """Copy all lessons into ``folder``, which is created if necessary; returns the files written.

    Existing lessons may contain answers: without ``force`` they are not overwritten, and nothing is
    written. Each file is written atomically.

    Raises MeshError if a lesson exists already or the folder cannot be written to.
    """
    target = Path(folder)
    lessons = shipped()
    if target.exists() and not target.is_dir():
        raise MeshError(f"{target}: this is a file, not a folder.")
    there = [one.path.name for one in lessons if (target / one.path.name).exists()]
    if there and not force:
        more = f" and {len(there) - 1} more" if len(there) > 1 else ""
        raise MeshError(
            f"{target}: {there[0]}{more} would be overwritten, and answers in them lost; "
            "use --force, or another folder."
        )
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MeshError(f"{target}: cannot be made ({atomic_write.reason(error)}).") from error
    written = []
    for lesson in lessons:
        with atomic_write.replacing(target / lesson.path.name) as temporary:
            temporary.write_bytes(lesson.path.read_bytes())
        written.append(target / lesson.path.name)
    return written
