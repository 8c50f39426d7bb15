"""Learning curves of one or more trainings, as data and as a chart."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.experiments import training_log
from meshwright.experiments.chart import add_axes, add_legend, add_title, chart, series_style
from meshwright.experiments.picture import Picture
from meshwright.graphics.drawing import Drawing
from meshwright.graphics.theme import LIGHT, Theme
from meshwright_core import MeshError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TITLES = {
    "mean": "normalised return of single rollouts, unseen polygons",
    "at_optimum": "share of single rollouts at the optimum",
    "played": "normalised return in self-play",
    "entropy": "entropy of a decision",
    "decisions_per_second": "decisions a second",
}
WIDTH, HEIGHT, LEFT, GAP = 400.0, 216.0, 56.0, 72.0
MOST = 4
"""The most trainings in one chart: one for each line style."""


@dataclass(frozen=True, eq=False)
class Training:
    """The recorded measurements of one training."""

    name: str
    points: dict[str, np.ndarray]
    """iteration, decisions, seconds, mean, std, at_optimum: an array (n,) of each, one entry for
    each evaluation."""
    updates: dict[str, tuple[np.ndarray, np.ndarray]]
    """For each quantity that TensorBoard events hold: updates (m,) and values (m,)."""

    def series(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Decisions (n,) and values (n,) of a quantity. For quantities that are recorded with
        every update only, updates in place of decisions. MeshError for an unknown quantity.
        """
        if name in self.points:
            return self.points["decisions"], self.points[name]
        if name in self.updates:
            return self.updates[name]
        known = ", ".join([*self.points, *(set(self.updates) - set(self.points))])
        raise MeshError(f"{self.name}: this training has no {name!r}; it has {known}.")


def learning_curves(*paths: str | os.PathLike[str], names: Sequence[str] | None = None) -> Curves:
    """Read the learning curves of trainings by ``meshwright train``, finished or still running.

    Args:
        paths: folders of trainings, or files in them: ``checkpoint.safetensors``, ``curve.json``,
            ``policy.safetensors``; or names of shipped policies.
        names: labels of the trainings; None: the names of the folders or policies.

    Raises MeshError for a file that is damaged or holds no learning curve.
    """
    if not paths:
        raise MeshError("There is nothing to read: name the folder of at least one training.")
    if not all(isinstance(path, str | os.PathLike) for path in paths):
        raise MeshError("The folder of a training is named by text or by a path.")
    found = [_located(path) for path in paths]
    called = [_name_of(path) for path in found] if names is None else [str(n) for n in names]
    if len(called) != len(found):
        raise MeshError(f"There are {len(found)} trainings, but {len(called)} names.")
    trainings = []
    for path, name in zip(found, called, strict=True):
        folder = path if path.is_dir() else path.parent
        trainings.append(Training(name, training_log.points(path), training_log.updates(folder)))
    return Curves(trainings)


def _located(path: str | os.PathLike[str]) -> Path:
    """The path itself, or the file of the shipped policy of this name."""
    from importlib.resources import files

    place = Path(path)
    shipped = Path(str(files("meshwright_assets") / "policies" / f"{place}.safetensors"))
    return (
        shipped if not place.exists() and place.name == str(place) and shipped.exists() else place
    )


def _name_of(path: Path) -> str:
    if path.is_file() and path.name not in training_log.FILES:
        return path.stem
    return (path if path.is_dir() else path.parent).resolve().name


class Curves(Picture):
    """Learning curves of several trainings in one chart."""

    def __init__(self, trainings: list[Training], quantities: Sequence[str] = ()) -> None:
        self.trainings = trainings
        self.quantities = tuple(quantities) or ("mean", "at_optimum")

    def __len__(self) -> int:
        return len(self.trainings)

    def __getitem__(self, key: int | str) -> Training:
        """A training by its index or its name."""
        if isinstance(key, str):
            found = [one for one in self.trainings if one.name == key]
            if not found:
                raise MeshError(
                    f"There is no training {key!r} here; there are"
                    f" {', '.join(one.name for one in self.trainings)}."
                )
            return found[0]
        return self.trainings[key]

    def __repr__(self) -> str:
        return "\n".join(
            f"{one.name}: {len(one.points['mean'])} evaluations,"
            f" {one.points['decisions'][-1]:,.0f} decisions, return {one.points['mean'][0]:.3f} to"
            f" {one.points['mean'].max():.3f}"
            for one in self.trainings
        )

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One dictionary for each evaluation of each training."""
        return [
            {"training": one.name, **{name: float(v[i]) for name, v in one.points.items()}}
            for one in self.trainings
            for i in range(len(one.points["mean"]))
        ]

    def plot(self, *quantities: str) -> Curves:
        """A chart of other quantities of the same trainings, with one panel for each.

        quantities: those of each evaluation, :data:`meshwright.experiments.training_log.POINT`;
        and, if TensorBoard events were written, those of each update: "played", "entropy",
        "policy", "value", "learning_rate", ... MeshError for an unknown one.
        """
        for name in quantities:
            for training in self.trainings:
                training.series(name)
        return Curves(self.trainings, quantities)

    def drawing(self, theme: Theme = LIGHT) -> Drawing:
        """One panel for each quantity, one curve for each training."""
        if len(self.trainings) > MOST:
            raise MeshError(f"One figure shows up to {MOST} trainings, not {len(self.trainings)}.")
        count = len(self.quantities)
        size = (
            round(LEFT + count * WIDTH + (count - 1) * GAP + 24.0),
            round(self._top + HEIGHT + 56.0),
        )
        inset = chart(self._draw_chart, size, theme)
        return Drawing(size, theme.background, repr(self), [inset])

    @property
    def _top(self) -> float:
        """Pixels above the panels: their titles, and the legend of several trainings."""
        return 72.0 if len(self.trainings) > 1 else 40.0

    def _draw_chart(self, figure: Figure, theme: Theme) -> None:
        panels = [
            self._add_panel(figure, theme, name, LEFT + panel * (WIDTH + GAP))
            for panel, name in enumerate(self.quantities)
        ]
        if len(self.trainings) > 1:
            add_legend(figure, panels[0], theme, LEFT, 12.0)

    def _add_panel(self, figure: Figure, theme: Theme, name: str, left: float) -> Axes:
        series = [one.series(name) for one in self.trainings]
        share = name in ("mean", "at_optimum", "played")
        values = np.concatenate([y[np.isfinite(y)] for _, y in series] or [np.zeros(1)])
        low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
        span = max(high - low, 1e-9 + 0.02 * abs(high))
        y_range = (min(0.0, low), 1.02) if share else (low - 0.06 * span, high + 0.06 * span)
        last = max((float(x[-1]) for x, _ in series if len(x)), default=1.0)
        by_update = any(name not in one.points for one in self.trainings)
        axes = add_axes(
            figure, theme, (left, self._top, WIDTH, HEIGHT), (0.0, max(last, 1.0)), y_range,
            "updates" if by_update else "decisions",
        )  # fmt: skip
        add_title(axes, theme, TITLES.get(name, name.replace("_", " ")))
        if name == "mean" and len(series) == 1:
            mean, std = self.trainings[0].points["mean"], self.trainings[0].points["std"]
            band = axes.fill_between(series[0][0], mean - std, mean + std, linewidth=0.0)
            band.set(facecolor=theme.accent_soft, zorder=0.5)  # below the lines of the grid
        for i, (training, (x, y)) in enumerate(zip(self.trainings, series, strict=True)):
            axes.plot(x, y, label=training.name, clip_on=False, **series_style(theme, i))
        return axes
