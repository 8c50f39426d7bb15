"""Comparison of policies on one mesh: all rollouts as data, the best ones as a picture."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.assistant.policy_catalogue import shipped
from meshwright.experiments.best_of import BestOf
from meshwright.experiments.chart import FONT_SIZE, add_axes, add_level, chart
from meshwright.experiments.evaluation_table import grid
from meshwright.experiments.mesh_thumbnail import given_mesh, thumbnail
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
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
    """Roll out each policy several times from one mesh, and keep every rollout.

    Args:
        mesh: a mesh, a document, a widget, or what :func:`meshwright.mesh` makes a mesh of; it is
            not changed.
        policies: names of shipped policies, policy files, folders of trainings, or loaded
            policies, or a single one of these; None: the best shipped policy for this kind of
            mesh, and the paper's method.
        rollouts: the number of rollouts of each policy, computed as one batch.
        steps: the most decisions in a rollout; None: as many as in the policy's training.
        seed: of the random numbers; equal seeds give equal rollouts.

    Raises MeshError for an unknown policy, a policy for the other kind of mesh, or a mesh without
    elements.
    """
    count = whole_number(rollouts, 1, "rollouts")
    limit = None if steps is None else whole_number(steps, 1, "steps")
    start_seed = whole_number(seed, 0, "seed")
    start = given_mesh(mesh)
    if policies is None:
        policies = shipped(start.kind)[:2]
    if isinstance(policies, str | os.PathLike) or not isinstance(policies, Iterable):
        policies = [policies]
    given = list(policies)
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


class TextTable(str):
    """Preformatted text, shown in notebooks in a monospaced font."""

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        """The text as HTML; a narrow cell scrolls it and does not wrap its lines."""
        return f'<pre style="white-space:pre;overflow-x:auto">{escape(self)}</pre>'


class Comparison(Picture):
    """The rollouts of several policies from one mesh."""

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        rollouts: dict[str, tuple[Rollout, ...]],
        seconds: dict[str, float],
    ) -> None:
        self.mesh = mesh
        """The start of every rollout."""
        self.rollouts = rollouts
        """The rollouts of each policy, by its name."""
        self.seconds = seconds
        """The time that all rollouts of a policy took together."""
        self.sources: dict[str, str] = {}
        """The name or file of each policy; those that were given loaded are left out."""
        self._films: dict[tuple[str, int], Film] = {}

    def __repr__(self) -> str:
        return self.table()

    # Data

    @property
    def policies(self) -> tuple[str, ...]:
        """The names of the policies, in the order given."""
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
        """For each policy the scores (T + 1,) of each rollout, at the start and after decisions."""
        return {name: [run.scores for run in runs] for name, runs in self.rollouts.items()}

    def returns(self, policy: str) -> np.ndarray:
        """(rollouts,) the normalised return of each rollout, at its best state."""
        return np.array([run.normalised for run in self._runs(policy)])

    def best(self, policy: str) -> Rollout:
        """The rollout with the lowest s; among equals the one that needs the fewest decisions."""
        return min(self._runs(policy), key=lambda run: (run.best, run.decisions))

    def best_of(self, policy: str, k: int) -> tuple[float, float]:
        """Mean and standard deviation of the best normalised return among k rollouts, over all
        subsets of k of the rollouts.
        """
        return best_of(self.returns(policy), whole_number(k, 1, "k"))

    def best_of_curve(self) -> BestOf:
        """The expected best of k rollouts as a function of k, for all policies."""
        return BestOf({name: self.returns(name) for name in self.policies})

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One dictionary for each policy; ``pandas.DataFrame(rows)`` makes a table of them."""
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
        """One dictionary for each rollout of each policy."""
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

    def table(self) -> TextTable:
        """The rows as a text table of means and standard deviations, as in the paper."""
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
        return TextTable(f"{head}\n\n{grid(names, cells)}")

    # Meshes and films

    def document(self, policy: str, rollout: int | None = None) -> Document:
        """A document whose history is the rollout up to its best state and a smoothing.

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
        """The film of a rollout up to its best state; rollout: its number, None for the best."""
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
        """A :class:`meshwright.notebook.MeshWidget` on the document of a rollout, for stepping
        through it and for editing. Its agent uses the same policy if that has a name or a file.
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
        """For each policy its best mesh, above a chart of the scores of all its rollouts; the axes
        of all policies have the same ranges.
        """
        meshes = self.meshes
        count = len(self.policies)
        tall = max(_height(mesh) for mesh in meshes.values())
        width = round(LEFT + count * COLUMN + (count - 1) * GAP + 16.0)
        foot = round(40.0 + CURVE + 48.0)
        best = "; ".join(f"{row['policy']}: best s {row['best_score']}" for row in self.rows)
        title = f"s {self.start} at the start, optimum {self.optimum}; {best}"
        drawing = Drawing((width, round(HEAD + tall) + foot), theme.background, title)
        for column, name in enumerate(self.policies):
            left = _left_of(column)
            self._add_head(drawing, theme, name, left)
            picture = thumbnail(meshes[name], (round(COLUMN), round(tall)), theme)
            drawing.add(*(shifted(shape, left, HEAD) for shape in picture.shapes))
        drawing.add(chart(self._draw_chart, (width, foot), theme, (0.0, HEAD + tall)))
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

    def _draw_chart(self, figure: Figure, theme: Theme) -> None:
        """The scores of all runs of each policy against decisions, on axes of equal ranges."""
        runs = [run for runs in self.rollouts.values() for run in runs]
        longest = max(len(run.steps) for run in runs)
        highest = max(int(run.scores.max()) for run in runs)
        for column, name in enumerate(self.policies):
            axes = add_axes(
                figure, theme, (_left_of(column), 40.0, COLUMN, CURVE),
                (0.0, float(max(longest, 1))), (0.0, 1.06 * max(highest, 1)), "decisions",
                y_labels=column == 0, whole_y=True,
            )  # fmt: skip
            best = self.best(name)
            for run in self.rollouts[name]:
                _add_scores(axes, run.scores, theme.faint, 0.9)
            _add_scores(axes, best.scores[: best.decisions + 1], theme.accent, 2.4)
            add_level(axes, theme, self.optimum, f"s* = {self.optimum}")
            if column == 0:
                _add_note(axes, theme, "s", (0.0, 1.0), (-8.0, 14.0))
            if len(self.rollouts[name]) > 1:
                words = f"thick: the best of {len(self.rollouts[name])}"
                _add_note(axes, theme, words, (1.0, 1.0), (0.0, -3.0))


def _left_of(column: int) -> float:
    """Pixels from the left of the picture to a column."""
    return LEFT + column * (COLUMN + GAP)


def _add_scores(axes: Axes, scores: np.ndarray, colour: str, width: float) -> None:
    """Scores after 0, 1, 2, ... decisions, each kept until the next decision."""
    axes.step(
        np.arange(len(scores)), scores, where="post", color=colour, linewidth=width, clip_on=False
    )


def _add_note(
    axes: Axes, theme: Theme, text: str, corner: tuple[float, float], offset: tuple[float, float]
) -> None:
    """Text that ends so many pixels right of and above a corner of the axes."""
    axes.annotate(
        text, corner, xycoords="axes fraction", xytext=offset, textcoords="offset points",
        ha="right", color=theme.muted, fontsize=FONT_SIZE,
    )  # fmt: skip


def _height(mesh: HalfEdgeMesh) -> float:
    """The height in pixels of a mesh that fills the width of a column, within limits."""
    extent = np.ptp(mesh.points[mesh.vertices(), :2], axis=0)
    share = float(extent[1] / max(float(extent[0]), 1e-12))
    return float(np.clip(share * COLUMN, 160.0, 352.0))
