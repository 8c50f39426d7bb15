"""The expected best of k rollouts as a function of k, for each policy of a comparison."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.experiments.chart import add_axes, add_legend, add_title, chart, series_style
from meshwright.experiments.picture import Picture
from meshwright.experiments.rollouts import best_of
from meshwright.graphics.drawing import Drawing
from meshwright.graphics.theme import LIGHT, Theme

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH, HEIGHT, LEFT, TOP = 560.0, 232.0, 64.0, 72.0


class BestOf(Picture):
    """Normalised return of the best of k rollouts, for k from 1 to the number of rollouts."""

    def __init__(self, returns: dict[str, np.ndarray]) -> None:
        """returns: for each policy the normalised returns (n,) of its rollouts."""
        count = min(len(values) for values in returns.values())
        self.k: np.ndarray = np.arange(1, count + 1)
        """(n,) 1, 2, ..., n."""
        found = {
            name: np.array([best_of(values, k) for k in self.k.tolist()])
            for name, values in returns.items()
        }
        self.means = {name: table[:, 0] for name, table in found.items()}
        """For each policy (n,): the mean over all subsets of k rollouts."""
        self.deviations = {name: table[:, 1] for name, table in found.items()}
        """For each policy (n,): the standard deviation over all subsets of k rollouts."""

    def __repr__(self) -> str:
        last = len(self.k)
        return "\n".join(
            f"{name}: one {means[0]:.3f}, best of {last} {means[-1]:.3f}"
            for name, means in self.means.items()
        )

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One dictionary for each policy and each k."""
        return [
            {
                "policy": name,
                "k": int(k),
                "mean": float(self.means[name][i]),
                "std": float(self.deviations[name][i]),
            }
            for name in self.means
            for i, k in enumerate(self.k)
        ]

    def drawing(self, theme: Theme = LIGHT) -> Drawing:
        """One curve for each policy."""
        size = (round(LEFT + WIDTH + 24.0), round(TOP + HEIGHT + 48.0))
        inset = chart(self._draw_chart, size, theme)
        return Drawing(size, theme.background, repr(self), [inset])

    def _draw_chart(self, figure: Figure, theme: Theme) -> None:
        lowest = min(float(means.min()) for means in self.means.values())
        span = max(1.0 - lowest, 0.02)
        axes = add_axes(
            figure, theme, (LEFT, TOP, WIDTH, HEIGHT), (1.0, float(max(len(self.k), 2))),
            (max(lowest - 0.15 * span, 0.0), 1.0 + 0.05 * span), "k",
        )  # fmt: skip
        add_title(axes, theme, "normalised return of the best of k rollouts")
        for i, (name, means) in enumerate(self.means.items()):
            axes.plot(self.k, means, label=name, clip_on=False, **series_style(theme, i))
        add_legend(figure, axes, theme, LEFT, 12.0)
