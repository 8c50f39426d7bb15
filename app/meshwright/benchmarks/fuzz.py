"""Random operations against a naive face list: a million of each kind without a violation."""

from __future__ import annotations

from functools import partial
from typing import Any

from meshwright.console import Update
from meshwright_core.testing.fuzzing import fuzz

SUMMARY = "a million random operations of each kind, each checked against a naive face list"

OPERATIONS = 1_000_000
QUICK = 300


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Fuzz both kinds; the first violation ends it as an error."""
    count = QUICK if quick else OPERATIONS

    def show(kind: str, done: int) -> None:
        update(done, f"{kind} {done:,}")

    return {kind: fuzz(kind, count, seed, partial(show, kind)) for kind in ("tri", "quad")}
