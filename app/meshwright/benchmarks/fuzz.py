"""Random operations against a naive face list: a million of each kind without a violation."""

from __future__ import annotations

from typing import Any

from meshwright.console import Update
from meshwright_core.testing.fuzzing import fuzz

SUMMARY = "a million random operations of each kind, each checked against a naive face list"

OPERATIONS = 1_000_000
QUICK = 300


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Fuzz both kinds; the first violation ends it as an error."""
    count = QUICK if quick else OPERATIONS
    return {
        kind: fuzz(kind, count, seed, lambda done, kind=kind: update(done, f"{kind} {done:,}"))
        for kind in ("tri", "quad")
    }
