"""Progress display of a training: a bar on a terminal, occasional lines in a log."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TextIO

Write = Callable[[int, "list[str] | None", bool], None]
"""Called as ``write(done, cells, evaluated)``; without cells when the training is over."""

COLUMNS = ("update", "decisions", "a second", "self-play", "single", "at s*", "entropy", "left")
_WIDTHS = (9, 13, 10, 11, 8, 7, 9, 9)


class NumberRow:
    """Formats the numbers of a training as the cells of one table row."""

    def __init__(self, minutes: float | None = None) -> None:
        """minutes: time limit of the training, None for none."""
        self._began = time.perf_counter()
        self._minutes = minutes
        self._first: int | None = None
        self._measured: dict[str, float] = {}

    def cells(self, done: int, total: int, numbers: Mapping[str, float]) -> list[str]:
        """One text for each of COLUMNS; what has not been measured yet is a dash."""
        if self._first is None:
            self._first = done - 1
        self._measured |= {
            name: numbers[name] for name in ("mean", "at_optimum") if name in numbers
        }
        spent = time.perf_counter() - self._began
        left = spent / (done - self._first) * (total - done)
        if self._minutes is not None:
            left = min(left, 60.0 * self._minutes - spent)
        return [
            f"{done}/{total}",
            _shown(numbers.get("decisions"), ",.0f"),
            _shown(numbers.get("decisions_per_second"), ",.0f"),
            _shown(numbers.get("played"), ".3f"),
            _shown(self._measured.get("mean"), ".3f"),
            _shown(self._measured.get("at_optimum"), ".0%"),
            _shown(numbers.get("entropy"), ".3f"),
            clock(left),
        ]


def row(cells: tuple[str, ...] | list[str]) -> str:
    """The cells as one line of a table, aligned right."""
    return "".join(f"{cell:>{width}}" for cell, width in zip(cells, _WIDTHS, strict=True))


def clock(seconds: float) -> str:
    """Seconds as m:ss, or h:mm:ss from an hour on."""
    whole = max(0, round(seconds))
    hours, minutes = whole // 3600, whole // 60 % 60
    return f"{hours}:{minutes:02}:{whole % 60:02}" if hours else f"{minutes}:{whole % 60:02}"


class TrainingDisplay:
    """Receives the progress of a training and writes it."""

    def __init__(self, write: Write, minutes: float | None) -> None:
        """write: writes one row; minutes: time limit of the training, None for none."""
        self._write, self._line, self._done = write, NumberRow(minutes), 0

    def update(self, done: int, total: int, numbers: Mapping[str, float]) -> None:
        """Show the numbers after an update."""
        self._done = done
        self._write(done, self._line.cells(done, total, numbers), "mean" in numbers)

    def finish(self) -> None:
        """Show that the training is over and the result is being evaluated."""
        self._write(self._done, None, False)


@contextmanager
def shown(stream: TextIO, total: int, minutes: float | None = None) -> Iterator[TrainingDisplay]:
    """Show a training on `stream` while the block runs; yield the object to report progress to.

    A terminal gets a bar with the present numbers, and above it a table with a line for each
    evaluation; other streams get the table only.
    """
    form = _bar if stream.isatty() else _log
    with form(stream, total) as write:
        yield TrainingDisplay(write, minutes)


@contextmanager
def _log(stream: TextIO, total: int) -> Iterator[Write]:
    lines = 0

    def write(done: int, cells: list[str] | None, evaluated: bool) -> None:
        nonlocal lines
        if cells is None or (not evaluated and done < total):
            return
        if lines == 0:
            stream.write(row(COLUMNS) + "\n")
        lines += 1
        stream.write(row(cells) + "\n")
        stream.flush()

    yield write


@contextmanager
def _bar(stream: TextIO, total: int) -> Iterator[Write]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn

    console = Console(file=stream, highlight=False)
    columns: list[Any] = [
        SpinnerColumn(),
        TextColumn("{task.description}"),
        BarColumn(bar_width=20),
        TextColumn("{task.fields[numbers]}"),
    ]
    with Progress(*columns, console=console, transient=True) as bar:
        console.print(row(COLUMNS), style="dim")
        task = bar.add_task("making meshes", total=total, numbers="")

        def write(done: int, cells: list[str] | None, evaluated: bool) -> None:
            if cells is None:
                bar.update(task, completed=total, description="evaluating the result", numbers="")
                return
            if evaluated:
                console.print(row(cells))
            now = dict(zip(COLUMNS, cells, strict=True))
            # with the bar this fits into a terminal of 80 columns, as the table does
            numbers = (
                f"{now['update']}  {now['a second']}/s  entropy {now['entropy']}  "
                f"{now['left']} left"
            )
            bar.update(task, completed=done, description="training", numbers=numbers)

        yield write


def _shown(value: float | None, form: str) -> str:
    return "-" if value is None or value != value else format(value, form)
