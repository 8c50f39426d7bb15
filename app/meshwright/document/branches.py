"""Branches of the history: undone steps that a new step has replaced, kept for later."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from meshwright.document.history import HistoryStep
    from meshwright_core.history.packed_steps import Steps

MOST_BRANCHES = 50
"""Limit on the branches of a history, branches of branches included; the oldest are dropped."""
MOST_BYTES = 512 << 20
"""Limit on the bytes of steps in branches, beyond which the oldest are dropped."""


@dataclass(frozen=True, slots=True, eq=False)
class Branch:
    """Steps that follow the state at cursor ``at`` and do not belong to the present history.

    ``rows`` are the steps, ``steps`` the mesh's own record of them, undone. ``branches`` start at
    one of these steps; their ``at`` also counts from the start of the history, and is greater than
    ``at`` here. ``made`` numbers the branches in the order of their making.
    """

    at: int
    rows: "tuple[HistoryStep, ...]"
    steps: "tuple[Steps, ...]"
    branches: "tuple[Branch, ...]"
    made: int

    @property
    def end(self) -> int:
        """The cursor after its last step."""
        return self.at + len(self.rows)

    @property
    def nbytes(self) -> int:
        """Bytes of its own steps."""
        return sum(steps.nbytes for steps in self.steps)


Branches = tuple[Branch, ...]


def every(branches: Branches) -> Iterator[Branch]:
    """All branches, including branches of branches."""
    for branch in branches:
        yield branch
        yield from every(branch.branches)


def pruned(branches: Branches, kept: int) -> Branches:
    """The branches without the oldest, so that both limits hold; number ``kept`` stays.

    A branch is dropped only after all its own branches.
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
