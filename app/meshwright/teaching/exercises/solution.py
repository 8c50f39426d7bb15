"""Solutions of exercises, which lessons store in the metadata of cells."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any

from meshwright.teaching import lessons
from meshwright.teaching.exercises.result import STYLE

_LOOK = (
    ".mw-code{max-width:720px;margin:4px 0;padding:8px 12px;border:1px solid var(--mw-line);"
    "border-radius:8px;background:var(--mw-raised);color:var(--mw-text);overflow-x:auto;"
    "font:13px/20px ui-monospace,Menlo,Consolas,monospace;white-space:pre}"
)


@dataclass(frozen=True)
class ExerciseSolution:
    """A solution of an exercise: ``code`` that can stand above its check."""

    exercise: str
    code: str

    def __repr__(self) -> str:
        """The code."""
        return self.code

    def _repr_html_(self) -> str:
        """The code in a box."""
        return (
            f'<style>{STYLE}{_LOOK}</style><pre class="mw-code">'
            f"{escape(self.code, quote=False)}</pre>"
        )

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        """Text and HTML."""
        return {"text/plain": self.code, "text/html": self._repr_html_()}


def solution_of(name: str) -> ExerciseSolution:
    """The solution of the exercise called ``name``.

    Raises LookupError if no lesson has one.
    """
    for lesson in lessons.shipped():
        for cell in lesson.exercises():
            if cell.name == name:
                return ExerciseSolution(name, cell.solution)
    raise LookupError(f"No lesson has a solution of the exercise {name!r}.")
