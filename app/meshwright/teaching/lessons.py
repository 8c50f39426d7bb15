"""The lessons that travel with the program: what they are called, what is in them, and copies.

A lesson is a Jupyter notebook in ``assets/lessons``. Its metadata say ``{"meshwright": {"lesson":
number, "minutes": reading time}}``; the metadata of a cell with an exercise say ``{"meshwright":
{"exercise": "1.2", "solution": code, "wrong": [code, ...]}}``. Solutions stand in the place of all
lines above the one that checks.
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
    """A cell with an exercise: its source as shipped, a solution, and answers that are wrong."""

    name: str
    source: str
    solution: str
    wrong: tuple[str, ...]

    def answered(self, code: str) -> str:
        """The source with ``code`` in the place of the blank answer."""
        lines = self.source.split("\n")
        last = max(i for i, line in enumerate(lines) if ".check(" in line)
        return "\n".join([code, *lines[last:]])


@dataclass(frozen=True)
class Lesson:
    """One lesson, the notebook at ``path``."""

    path: Path

    @property
    def name(self) -> str:
        """The name of its file without the ending: ``01-half-edges``."""
        return self.path.stem

    @cached_property
    def notebook(self) -> dict[str, Any]:
        """The notebook as it is written."""
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
        """How long it takes."""
        return int(self.notebook["metadata"]["meshwright"]["minutes"])

    def exercises(self) -> Iterator[ExerciseCell]:
        """Its exercises, from top to bottom."""
        for cell in self.notebook["cells"]:
            about = cell["metadata"].get("meshwright", {})
            if "exercise" in about:
                source, wrong = "".join(cell["source"]), tuple(about.get("wrong", ()))
                yield ExerciseCell(about["exercise"], source, about["solution"], wrong)


def shipped() -> list[Lesson]:
    """The lessons that travel with the program, in the order in which they are read."""
    return [Lesson(path) for path in sorted(FOLDER.glob(f"*{ENDING}"))]


def copy_to(folder: str | Path, force: bool = False) -> list[Path]:
    """Copy every lesson into ``folder``, which is made if need be; returns the files written.

    Lessons that are there already may hold somebody's answers: they are overwritten only with
    ``force``, and without it nothing at all is written. A lesson is written whole or not at all.

    Raises MeshError, in one sentence, for a folder that cannot be written to.
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
