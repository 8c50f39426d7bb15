"""Output of commands: the result on stdout, everything else on stderr.

With ``--json`` stdout carries exactly one JSON object, the result or ``{"error": ...}``.
Progress and remarks go to stderr, and only when it is a terminal, so that pipes and logs stay
free of them; a training, which takes hours, also writes occasional lines to a log. An error is one
line on stderr.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Protocol, TextIO


class UserError(Exception):
    """Wrong use or bad input: ends the command with one line on stderr and exit code 2."""


class Update(Protocol):
    """Called during long work, to move its progress bar."""

    def __call__(self, done: int, remark: str = "") -> None:
        """``done`` pieces of work are done; ``remark`` is shown beside the bar."""


def no_update(done: int, remark: str = "") -> None:
    """Show no progress; an :class:`Update`."""


class Report:
    """Writes the result, remarks and errors of a command.

    ``as_json`` chooses the form of the result. The streams are looked up when they are used, so
    that a test may replace ``sys.stdout`` and ``sys.stderr``.
    """

    def __init__(self, as_json: bool = False) -> None:
        """as_json: write the result as one JSON object rather than as text."""
        self.as_json = as_json
        self._began = time.perf_counter()

    @property
    def seconds(self) -> float:
        """Seconds since the command began."""
        return time.perf_counter() - self._began

    @property
    def out(self) -> TextIO:
        """Where the result goes."""
        return sys.stdout

    @property
    def err(self) -> TextIO:
        """Where progress, remarks and errors go."""
        return sys.stderr

    def result(self, values: Mapping[str, Any], text: str) -> None:
        """Write the result: ``values`` as one JSON object, or ``text``."""
        try:
            self.out.write((as_json(values) if self.as_json else text.rstrip("\n")) + "\n")
            self.out.flush()
        except BrokenPipeError:
            raise
        except OSError as error:
            self.as_json = False  # the error cannot be written to stdout either
            raise UserError(f"the result cannot be written to stdout ({error.strerror})") from None

    def note(self, sentence: str) -> None:
        """Write a remark to stderr, also if it is a log."""
        self.err.write(one_line(sentence) + "\n")
        self.err.flush()

    def error(self, command: str, sentence: str) -> None:
        """Write an error as one line on stderr, and with ``--json`` as an object on stdout too."""
        sentence = one_line(sentence)
        self.err.write(f"{command}: {sentence}\n")
        self.err.flush()
        if self.as_json:
            self.out.write(as_json({"error": sentence}) + "\n")
            self.out.flush()

    @contextmanager
    def progress(self, title: str, total: int | None = None) -> Iterator[Update]:
        """Show a progress bar on a terminal while the block runs; yield the function that moves it.

        ``total`` is the number of pieces of work, None if it is not known.
        """
        if not self.err.isatty():
            yield lambda done, remark="": None
            return
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

        columns = [
            TextColumn("{task.description}"),
            BarColumn(bar_width=30),
            TextColumn("{task.fields[remark]}"),
            TimeElapsedColumn(),
        ]
        with Progress(*columns, console=Console(file=self.err), transient=True) as bar:
            task = bar.add_task(title, total=total, remark="")

            def update(done: int, remark: str = "") -> None:
                bar.update(task, completed=done, remark=remark)

            yield update


def one_line(text: str) -> str:
    """Return the text with every run of white space, including line ends, replaced by one space."""
    return " ".join(text.split())


def as_json(values: Mapping[str, Any]) -> str:
    """Return one JSON object on one line; numpy values become plain ones, NaN becomes null."""
    return json.dumps(_plain(values), allow_nan=False, ensure_ascii=False)


def table(rows: Sequence[tuple[str, object]], indent: str = "  ") -> str:
    """Return rows of name and value with the values aligned."""
    width = max((len(name) for name, _ in rows), default=0)
    return "\n".join(f"{indent}{name:<{width}}  {value}" for name, value in rows)


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | set):
        return [_plain(item) for item in value]
    if value is None or isinstance(value, str | bool | int):
        return value
    return str(value)
