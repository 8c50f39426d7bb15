"""Branches: what was undone when something else was done, kept so that one can go there again."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from meshwright.document.history import HistoryStep
    from meshwright_core.history.packed_steps import Steps

MOST_BRANCHES = 50
"""Branches that a history keeps, branches of branches included; the oldest go."""
MOST_BYTES = 512 << 20
"""Bytes of steps in branches beyond which the oldest go too."""


@dataclass(frozen=True, slots=True, eq=False)
class Branch:
    """Rows that lead on from the state at cursor ``at``, and are not on the present line.

    ``steps`` are the mesh's own record of them, undone. ``branches`` fork on these rows; their
    ``at``, too, counts from the start of the history, and is greater than ``at`` here. ``made``
    grows from branch to branch.
    """

    at: int
    rows: "tuple[HistoryStep, ...]"
    steps: "tuple[Steps, ...]"
    branches: "tuple[Branch, ...]"
    made: int

    @property
    def end(self) -> int:
        """The cursor at its last row."""
        return self.at + len(self.rows)

    @property
    def nbytes(self) -> int:
        """Bytes of its own steps."""
        return sum(steps.nbytes for steps in self.steps)


Branches = tuple[Branch, ...]


def every(branches: Branches) -> Iterator[Branch]:
    """All branches, those that fork on them included."""
    for branch in branches:
        yield branch
        yield from every(branch.branches)


def pruned(branches: Branches, kept: int) -> Branches:
    """Without the oldest ones as long as they are too many; the one made as ``kept`` stays.

    A branch goes only after all that fork on it.
    """
    while True:
        here = list(every(branches))
        if len(here) <= MOST_BRANCHES and sum(branch.nbytes for branch in here) <= MOST_BYTES:
            return branches
        old = [branch.made for branch in here if not branch.branches and branch.made != kept]
        if not old:
            return branches
        branches = _without(branches, min(old))


def _without(branches: Branches, made: int) -> Branches:
    return tuple(
        replace(branch, branches=_without(branch.branches, made)) if branch.branches else branch
        for branch in branches
        if branch.made != made
    )
