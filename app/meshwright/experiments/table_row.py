"""One row of the paper's tables, measured with any number of polygons and rollouts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.assistant.torch_threads import one_thread
from meshwright.experiments.rollouts import known_policy
from meshwright_core import MeshError
from meshwright_core.arguments import whole_number
from meshwright_core.core.kinds import KIND_NOUN
from meshwright_core.errors import sentence

if TYPE_CHECKING:
    from meshwright_agent.policy.policy_files import Policy


@dataclass(frozen=True, eq=False, repr=False)
class TableRow:
    """The results of a policy on random polygons that are not in its training set."""

    policy: str
    kind: str
    sides: tuple[int, int]
    returns: np.ndarray
    """(M, K) normalised return of each rollout on each polygon, at its best state."""
    gaps: np.ndarray
    """(M, K) s - s* at the best state."""
    operations: np.ndarray
    """(M, K) decisions to the best state."""
    left_out: int
    """The number of polygons that start at their optimum, which are not counted."""
    paper: tuple[float, float] | None
    """The paper's mean and standard deviation of the best of ten, if it has this row."""

    @property
    def single(self) -> tuple[float, float]:
        """Mean and standard deviation of the first rollout, over the polygons."""
        return float(self.returns[:, 0].mean()), float(self.returns[:, 0].std())

    @property
    def best(self) -> tuple[float, float]:
        """Mean and standard deviation of the best rollout, over the polygons."""
        best = self.returns.max(axis=1)
        return float(best.mean()), float(best.std())

    @property
    def at_optimum(self) -> float:
        """The share of polygons whose best rollout is at s*."""
        return float((self.gaps.min(axis=1) == 0).mean())

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One dictionary for each rollout on each polygon."""
        return [
            {
                "policy": self.policy,
                "polygon": i,
                "rollout": k,
                "return": float(self.returns[i, k]),
                "gap": int(self.gaps[i, k]),
                "operations": int(self.operations[i, k]),
            }
            for i in range(self.returns.shape[0])
            for k in range(self.returns.shape[1])
        ]

    def __repr__(self) -> str:
        meshes, rollouts = self.returns.shape
        noun = KIND_NOUN[self.kind]
        low, high = self.sides
        found = [
            ("single rollout", _spread(self.single)),
            (f"best of {rollouts}", f"{_spread(self.best)}, {self.at_optimum:.0%} at s*"),
        ]
        if self.paper is not None:
            found.append(("paper, best of 10", f"{self.paper[0]:.2f} \u00b1 {self.paper[1]:.2f}"))
        head = f"{self.policy} on {meshes} polygons of {low} to {high} sides, {noun}"
        return "\n".join([head, *(f"  {name:<19}{words}" for name, words in found)])


def table_row(
    policy: str | Policy,
    sides: tuple[int, int] = (10, 20),
    meshes: int = 100,
    rollouts: int = 10,
    seed: int = 0,
) -> TableRow:
    """Measure a policy on random polygons, with several rollouts on each.

    Args:
        policy: the name of a shipped policy, a policy file, the folder of a training, or a loaded
            policy.
        sides: fewest and most sides of a polygon; the paper's rows are (10, 20), (20, 30), ...
        meshes: the number of polygons; those that start at their optimum are left out.
        rollouts: the number of rollouts on each polygon.
        seed: of polygons and rollouts; equal seeds give equal results.

    Raises MeshError for an argument that is out of range or a policy that cannot be loaded.
    """
    from meshwright_agent.evaluation import paper_results
    from meshwright_agent.evaluation.rollouts import NothingToDo, roll_out, unseen

    known = known_policy(policy)
    count, tries = whole_number(meshes, 1, "meshes"), whole_number(rollouts, 1, "rollouts")
    given_seed = whole_number(seed, 0, "seed")
    if not isinstance(sides, tuple | list) or len(sides) != 2:
        raise MeshError(f"sides are two numbers, as in (10, 20), not {sides!r}.")
    low, high = (whole_number(one, 3, "Each of the sides") for one in sides)
    if low > high:
        raise MeshError(f"sides are the fewest and then the most, not {low} and {high}.")
    try:
        starts = unseen(known.kind, (low, high), count, given_seed)
    except NothingToDo as error:
        raise MeshError(sentence(str(error))) from None
    with one_thread():
        rolled = roll_out(known, starts, tries, given_seed)
    reported = paper_results.row(known.kind, (low, high))
    paper = None if reported is None else (reported.best.mean, reported.best.deviation)
    return TableRow(
        known.name, known.kind, (low, high), rolled.returns, rolled.gaps, rolled.operations,
        count - len(starts), paper,
    )  # fmt: skip


def _spread(values: tuple[float, float]) -> str:
    return f"{values[0]:.3f} ± {values[1]:.3f}"
