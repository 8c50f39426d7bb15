"""Random operations against a naive face list: a million of each kind without a violation.

On straight domains, on domains with curved sides, and on those of several regions.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from meshwright.console import Update
from meshwright_core.testing.fuzzing import fuzz

SUMMARY = "millions of random operations, each checked against a naive face list"

OPERATIONS = 1_000_000
QUICK = 300


STARTS: dict[str, dict[str, bool]] = {
    "straight": {},
    "curved": {"curved": True},
    "interfaces": {"curved": True, "interfaces": True},
}
"""The kinds of start meshes: random grids, with arcs as sides, with several regions too."""


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Fuzz both kinds on all starts; the first violation ends it as an error."""
    count = QUICK if quick else OPERATIONS

    def show(name: str, done: int) -> None:
        update(done, f"{name} {done:,}")

    return {
        kind: {
            start: fuzz(kind, count, seed, partial(show, f"{kind}, {start}"), **choices)
            for start, choices in STARTS.items()
        }
        for kind in ("tri", "quad")
    }
