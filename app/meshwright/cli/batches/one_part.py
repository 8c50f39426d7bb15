"""One part of a batch: a command carried out, its result or its error as a record.

Run as a module this is a worker: it reads one task a line from standard input, a JSON list of the
words of a command, and answers each with one line, the record as JSON.
"""

from __future__ import annotations

import io
import json
import sys
import time
from collections.abc import Sequence
from typing import Any

from meshwright.console import Report, UserError


class _SilentReport(Report):
    """A report whose result is read from memory; remarks are dropped."""

    def __init__(self) -> None:
        super().__init__(as_json=True)
        self._out, self._err = io.StringIO(), io.StringIO()

    @property
    def out(self) -> io.StringIO:
        return self._out

    @property
    def err(self) -> io.StringIO:
        return self._err


def run_part(words: Sequence[str]) -> dict[str, Any]:
    """Carry out the command and return its JSON, or ``{"error": sentence}``; never raises.

    ``status`` says how it ended: "done", "inverted" (written, but elements are inverted), or
    "failed".
    """
    from meshwright.cli import build_parser
    from meshwright.cli.commands import COMMANDS

    report, began = _SilentReport(), time.perf_counter()
    try:
        arguments = build_parser().parse_args(list(words))
        code = COMMANDS[arguments.command].run(arguments, report) or 0
        record: dict[str, Any] = json.loads(report.out.getvalue())
        record["status"] = "inverted" if code else "done"
    except (UserError, SystemExit) as error:
        record = {"status": "failed", "error": str(error)}
    except Exception as error:
        record = {"status": "failed", "error": f"internal error: {type(error).__name__}: {error}"}
    record["seconds_in_all"] = round(time.perf_counter() - began, 3)
    return record


def main() -> None:
    """Answer tasks until the input ends."""
    answers, sys.stdout = sys.stdout, sys.stderr  # whatever prints does not disturb the answers
    for line in sys.stdin:
        answers.write(json.dumps(run_part(json.loads(line))) + "\n")
        answers.flush()


if __name__ == "__main__":
    main()
