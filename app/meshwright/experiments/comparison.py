"""Policies compared on one mesh: every rollout as data, and the best of each side by side."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.assistant.policy_catalogue import shipped
from meshwright.experiments.axes import LETTERS, Axes
from meshwright.experiments.best_of import BestOf
from meshwright.experiments.evaluation_table import grid
from meshwright.experiments.mesh_thumbnail import given_mesh, still
from meshwright.experiments.picture import Picture, shifted
from meshwright.experiments.rollouts import (
    Rollout,
    best_of,
    known_policy,
    play,
    require_kind,
)
from meshwright.graphics.drawing import Drawing, Text
from meshwright.graphics.theme import LIGHT, Theme
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.arguments import whole_number

if TYPE_CHECKING:
    from meshwright.document.document import Document
    from meshwright.graphics.export.film import Film
    from meshwright_agent.policy.policy_files import Policy

COLUMN, GAP, HEAD, CURVE = 352.0, 24.0, 56.0, 152.0
LEFT = 40.0


def compare(
    mesh: Any,
    policies: Sequence[str | Path | Policy] | str | Path | Policy | None = None,
    rollouts: int = 10,
    steps: int | None = None,
    seed: int = 0,
) -> Comparison:
    """Let each policy run so often from the mesh, and keep everything.

    Args:
        mesh: a mesh, a document, a widget, or what :func:`meshwright.mesh` makes a mesh of; it is
            not changed.
        policies: names of shipped policies, files, or policies that are there, or one of these;
            None: the best that is shipped for this kind of mesh, and that of the paper.
        rollouts: of each policy, side by side.
        steps: decisions that a run may take; None: as many as its policy was trained with.
        seed: the same seed brings the same runs.

    Raises MeshError with one sentence where a policy is unknown or for the other kind of mesh, or
    the mesh has no elements.
    """
    count = whole_number(rollouts, 1, "rollouts")
    limit = None if steps is None else whole_number(steps, 1, "steps")
    start_seed = whole_number(seed, 0, "seed")
    start = given_mesh(mesh)
    if policies is None:
        policies = shipped(start.kind)[:2]
    several = isinstance(policies, Iterable) and not isinstance(policies, str)
    given = list(policies) if several else [policies]
    if not given:
        raise MeshError("There is no policy to compare: name one or more.")
    known = [known_policy(name) for name in given]
    for policy in known:
        require_kind(policy, start)
    names = [policy.name for policy in known]
    twice = next((name for name in names if names.count(name) > 1), "")
    if twice:
        raise MeshError(f"{twice}: this policy is named twice.")
    runs, seconds = {}, {}
    for policy in known:
        runs[policy.name], seconds[policy.name] = play(start, policy, count, limit, start_seed)
    found = Comparison(start, runs, seconds)
    found.sources = {
        policy.name: str(name)
        for policy, name in zip(known, given, strict=True)
        if name is not policy
    }
    return found


class Table(str):
    """Text that a notebook shows as it is, line by line."""

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        """The same; in a narrow cell it is scrolled, not broken."""
        return f'<pre style="white-space:pre;overflow-x:auto">{escape(self)}</pre>'


class Comparison(Picture):
    """What some policies made of one mesh."""

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        rollouts: dict[str, tuple[Rollout, ...]],
        seconds: dict[str, float],
    ) -> None:
        self.mesh = mesh
        """The mesh that every run started from."""
        self.rollouts = rollouts
        """The runs of each policy, by its name."""
        self.seconds = seconds
        """What all runs of a policy took."""
        self.sources: dict[str, str] = {}
        """By which name, or from which file, each policy was had, unless it was there already."""
        self._films: dict[tuple[str, int], Film] = {}

    def __repr__(self) -> str:
        return self.table()

    # Data

    @property
    def policies(self) -> tuple[str, ...]:
        """The names, in the order in which they were given."""
        return tuple(self.rollouts)

    @property
    def start(self) -> int:
        """s at the start."""
        return self.mesh.score

    @property
    def optimum(self) -> int:
        """s*."""
        return self.mesh.optimum

    @property
    def scores(self) -> dict[str, list[np.ndarray]]:
        """For each policy the scores (T + 1,) of each of its runs, start and every decision."""
        return {name: [run.scores for run in runs] for name, runs in self.rollouts.items()}

    def returns(self, policy: str) -> np.ndarray:
        """(rollouts,) the normalised return of each run, by its best state."""
        return np.array([run.normalised for run in self._runs(policy)])

    def best(self, policy: str) -> Rollout:
        """The run with the lowest s, the one with the fewest decisions to it among equals."""
        return min(self._runs(policy), key=lambda run: (run.best, run.decisions))

    def best_of(self, policy: str, k: int) -> tuple[float, float]:
        """Mean and deviation of the normalised return of the best among k of the runs, over all
        ways to choose k of them: what the best of k rollouts would bring.
        """
        return best_of(self.returns(policy), whole_number(k, 1, "k"))

    def best_of_curve(self) -> BestOf:
        """The best of k against k, for all policies: data, and a figure."""
        return BestOf({name: self.returns(name) for name in self.policies})

    @property
    def rows(self) -> list[dict[str, Any]]:
        """A plain row for each policy; ``pandas.DataFrame(rows)`` makes a table of them."""
        rows = []
        for name, runs in self.rollouts.items():
            returns, best = self.returns(name), self.best(name)
            rows.append(
                {
                    "policy": name,
                    "rollouts": len(runs),
                    "start": self.start,
                    "optimum": self.optimum,
                    "single_mean": float(returns.mean()),
                    "single_std": float(returns.std()),
                    "best_return": float(returns.max()),
                    "best_score": best.best,
                    "last_score": best.last,
                    "operations": best.decisions,
                    "at_optimum": float(np.mean([run.best == run.optimum for run in runs])),
                    "seconds": self.seconds[name],
                }
            )
        return rows

    @property
    def rollout_rows(self) -> list[dict[str, Any]]:
        """A plain row for each run of each policy."""
        return [
            {
                "policy": name,
                "rollout": run.number,
                "start": run.start,
                "best": run.best,
                "last": run.last,
                "optimum": run.optimum,
                "decisions": len(run.steps),
                "to_best": run.decisions,
                "return": run.normalised,
            }
            for name, runs in self.rollouts.items()
            for run in runs
        ]

    def table(self) -> Table:
        """The rows as text, as the paper's tables have them: mean and standard deviation."""
        count = len(next(iter(self.rollouts.values())))
        names = ["policy", "single", f"best of {count}", "best s", "runs at s*", "operations",
                 "seconds"]  # fmt: skip
        cells = [
            [
                row["policy"],
                f"{row['single_mean']:.3f} ± {row['single_std']:.3f}",
                f"{row['best_return']:.3f}",
                str(row["best_score"]),
                f"{row['at_optimum']:.0%}",
                str(row["operations"]),
                f"{row['seconds']:.2f}",
            ]
            for row in self.rows
        ]
        noun = "rollout" if count == 1 else "rollouts"
        head = (
            f"s = {self.start}, s* = {self.optimum}; {count} {noun} each; normalised return,"
            " mean ± standard deviation"
        )
        return Table(f"{head}\n\n{grid(names, cells)}")

    # Meshes and films

    def document(self, policy: str, rollout: int | None = None) -> Document:
        """A document that has the run in its history, up to its best state, smoothed on the way.

        rollout: its number; None: the best one.
        """
        from meshwright.document.document import Document

        run = self._run(policy, rollout)
        document = Document(self.mesh.copy(), policy)
        for operation, halfedge in run.operations():
            document.submit(operation, halfedge, policy)
        document.smooth(policy)
        return document

    def film(self, policy: str, rollout: int | None = None) -> Film:
        """The film of a run, up to its best state; rollout: its number; None: the best one."""
        from meshwright.graphics.export.film import Film

        run = self._run(policy, rollout)
        key = policy, run.number
        if key not in self._films:
            self._films[key] = Film(self.document(policy, run.number))
        return self._films[key]

    @property
    def meshes(self) -> dict[str, HalfEdgeMesh]:
        """For each policy its best mesh, smoothed; copies."""
        found = {}
        for name in self.policies:
            film = self.film(name)
            film.go_to(len(film) - 1)
            found[name] = film.mesh.copy()
        return found

    def widget(self, policy: str, rollout: int | None = None, **options: Any) -> Any:
        """A :class:`meshwright.notebook.MeshWidget` on such a document, to scrub and to go on
        editing; its agent follows the same policy where that has a name or a file.
        """
        from meshwright.notebook import MeshWidget

        document = self.document(policy, rollout)
        follow = {"policy": self.sources[policy]} if policy in self.sources else {}
        return MeshWidget(document, **(follow | options))

    def _runs(self, policy: str) -> tuple[Rollout, ...]:
        if policy not in self.rollouts:
            raise MeshError(
                f"There are no rollouts of {policy!r} here; there are those of"
                f" {', '.join(self.policies)}."
            )
        return self.rollouts[policy]

    def _run(self, policy: str, rollout: int | None) -> Rollout:
        if rollout is None:
            return self.best(policy)
        runs = self._runs(policy)
        number = whole_number(rollout, 0, "rollout")
        if number >= len(runs):
            raise MeshError(f"{policy} has rollouts 0 to {len(runs) - 1}, not {number}.")
        return runs[number]

    # The picture

    def drawing(self, theme: Theme = LIGHT) -> Drawing:
        """The best mesh of each policy, and below it the scores of all its runs, on axes that the
        policies share.
        """
        meshes = self.meshes
        count = len(self.policies)
        tall = max(_height(mesh) for mesh in meshes.values())
        width = LEFT + count * COLUMN + (count - 1) * GAP + 16.0
        height = HEAD + tall + 40.0 + CURVE + 48.0
        said = "; ".join(f"{row['policy']}: best s {row['best_score']}" for row in self.rows)
        title = f"s {self.start} at the start, optimum {self.optimum}; {said}"
        drawing = Drawing((round(width), round(height)), theme.background, title)
        longest = max(len(run.steps) for runs in self.rollouts.values() for run in runs)
        highest = max(int(run.scores.max()) for runs in self.rollouts.values() for run in runs)
        for column, name in enumerate(self.policies):
            left = LEFT + column * (COLUMN + GAP)
            self._add_head(drawing, theme, name, left)
            picture = still(meshes[name], (round(COLUMN), round(tall)), theme)
            drawing.add(*(shifted(shape, left, HEAD) for shape in picture.shapes))
            axes = Axes(
                left, HEAD + tall + 40.0, COLUMN, CURVE,
                (0.0, float(max(longest, 1))), (0.0, 1.06 * max(highest, 1)),
            )  # fmt: skip
            axes.frame(drawing, theme, "decisions", labels=column == 0, whole_y=True)
            self._add_curves(drawing, theme, name, axes)
        top = HEAD + tall + 20.0
        drawing.add(Text("s", (LEFT - 8.0, top), LETTERS + 1.0, theme.muted, "right"))
        return drawing

    def _add_head(self, drawing: Drawing, theme: Theme, name: str, left: float) -> None:
        best, right = self.best(name), left + COLUMN
        solved = best.best == self.optimum
        words = "at the optimum" if solved else f"optimum {self.optimum}"
        noun = "operation" if best.decisions == 1 else "operations"
        drawing.add(
            Text(name, (left, 20.0), 15.0, theme.text, "left", True),
            Text(f"s {best.best}", (right, 20.0), 17.0, theme.text, "right", True),
            Text(f"after {best.decisions} {noun}", (left, 41.0), 12.0, theme.muted),
            Text(words, (right, 41.0), 12.0, theme.accent if solved else theme.muted, "right",
                 solved),
        )  # fmt: skip

    def _add_curves(self, drawing: Drawing, theme: Theme, name: str, axes: Axes) -> None:
        best = self.best(name)
        for run in self.rollouts[name]:
            axes.steps(drawing, run.scores, theme.faint, 0.9)
        axes.steps(drawing, best.scores[: best.decisions + 1], theme.accent, 2.4)
        axes.level(drawing, self.optimum, theme.text, f"s* = {self.optimum}")
        if len(self.rollouts[name]) > 1:
            at = (axes.left + axes.width, axes.top - 2.0)
            words = f"thick: the best of {len(self.rollouts[name])}"
            drawing.add(Text(words, at, LETTERS, theme.muted, "right"))


def _height(mesh: HalfEdgeMesh) -> float:
    """Pixels for a mesh in a column: wide ones are low."""
    extent = np.ptp(mesh.points[mesh.vertices(), :2], axis=0)
    share = float(extent[1] / max(float(extent[0]), 1e-12))
    return float(np.clip(share * COLUMN, 160.0, 352.0))
