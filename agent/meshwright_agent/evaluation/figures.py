"""Figures of training and evaluation, as in section 5 of the paper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright_agent.evaluation.paper_results import single as paper_single
from meshwright_core.core.kinds import KIND_NOUN
from meshwright_core.io.atomic_write import replacing

if TYPE_CHECKING:
    from meshwright_agent.evaluation.rollouts import Rollouts

BLUE, VERMILION, GREEN = "#0072B2", "#D55E00", "#0F766E"
INK, MUTED, LINE = "#1E2329", "#5D656E", "#DEDED7"
DOTS = 160
"""Dots per inch of a PNG."""
_LINES = {
    "policy": (BLUE, "-", 2.2, "solver with the policy"),
    "annealing": (VERMILION, "--", 1.8, "annealing"),
    "plateaus": (MUTED, ":", 2.0, "greedy with plateau moves"),
}
_PANEL = 2.75


def learning_curve(
    curve: Sequence[Mapping[str, float]], kind: str, title: str, path: str | Path
) -> None:
    """Plot the mean and standard deviation of single rollouts against decisions (PNG or SVG).

    curve: points of :class:`meshwright_agent.training.trainer.TrainingProgress`.
    """
    decisions = [point["decisions"] / 1000.0 for point in curve]
    mean = [point["mean"] for point in curve]
    low = [point["mean"] - point["std"] for point in curve]
    high = [min(1.0, point["mean"] + point["std"]) for point in curve]
    solved = [point["at_optimum"] for point in curve]
    figure = _figure(6.4, 3.8)
    axes = figure.subplots()
    _style(axes)
    axes.fill_between(decisions, low, high, color=BLUE, alpha=0.15, linewidth=0)
    axes.plot(decisions, mean, color=BLUE, label="normalised return, single rollout")
    axes.plot(decisions, solved, color=VERMILION, linestyle="--", label="share at the optimum")
    paper = paper_single(kind)
    axes.axhline(paper, color=MUTED, linewidth=0.9, linestyle=":")
    axes.annotate(
        f"paper, single rollout: {paper}",
        (1.0, paper),
        xycoords=("axes fraction", "data"),
        xytext=(-4, -11),
        textcoords="offset points",
        ha="right",
        fontsize=8,
        color=MUTED,
    )
    axes.set(xlabel="decisions (thousands)", ylim=(0.0, 1.02))
    axes.set_title(title, loc="left", fontsize=11, color=INK)
    axes.set_xlim(0.0, max(*decisions, 1e-9))
    axes.legend(frameon=False, loc="lower right", bbox_to_anchor=(1.0, 0.12), fontsize=9)
    _write(figure, path)


def returns_by_steps(
    rows: Sequence[tuple[str, Rollouts, float | None]], kind: str, path: str | Path
) -> None:
    """Plot the normalised return against the number of operations, one panel for each row.

    Solid: the best state so far, mean over all episodes, with a band of one standard deviation that
    is clipped to [0, 1]. Dashed: the current state.

    Args:
        rows: title, rollouts, and the paper's mean best of ten, or None.
        kind: "tri" or "quad".
        path: PNG or SVG file to write.
    """
    figure, panels = _panels(len(rows))
    for axes, (title, rolled, paper) in zip(panels, rows, strict=True):
        now, best = _histories(rolled)
        longest = float(np.quantile(rolled.operations, 0.98)) * 1.1 + 2.0
        steps = np.arange(min(now.shape[0], int(longest) + 1))
        mean, deviation = (found[: len(steps)] for found in (best.mean(axis=1), best.std(axis=1)))
        axes.fill_between(
            steps,
            np.maximum(mean - deviation, 0.0),
            np.minimum(mean + deviation, 1.0),
            color=BLUE,
            alpha=0.15,
            linewidth=0,
        )
        axes.plot(steps, mean, color=BLUE, label="best state so far")
        axes.plot(
            steps,
            now.mean(axis=1)[: len(steps)],
            color=VERMILION,
            linestyle="--",
            linewidth=1.3,
            label="current state",
        )
        if paper is not None:
            axes.axhline(
                paper, color=MUTED, linewidth=0.9, linestyle=":", label="paper, best of 10"
            )
        axes.set_title(title, loc="left", fontsize=10, color=INK)
        axes.set(ylim=(0.0, 1.02), xlim=(0, steps[-1]), xlabel="operations")
    panels[0].set_ylabel("normalised return")
    _share_legend(figure, panels[0], f"{KIND_NOUN[kind].capitalize()}: single rollouts")
    _write(figure, path)


def _histories(rolled: Rollouts) -> tuple[np.ndarray, np.ndarray]:
    """Normalised returns (T + 1, N) after each step: of the current and of the best state."""
    longest = max(len(trace.gaps) for trace in rolled.traces)
    padded = [
        np.concatenate([trace.gaps, np.repeat(trace.gaps[-1:], longest - len(trace.gaps), axis=0)])
        for trace in rolled.traces
    ]
    gaps = np.concatenate(padded, axis=1).astype(float)
    now = 1.0 - gaps / gaps[0]
    return now, np.maximum.accumulate(now, axis=0)


def shares_by_seconds(
    races: Sequence[tuple[str, Mapping[str, np.ndarray]]],
    seconds: float,
    kind: str,
    path: str | Path,
) -> None:
    """Plot the share of meshes at s* against the time, one panel for each row.

    Args:
        races: title, and for each method the seconds (M,) until s*, infinite where it was not
            reached within `seconds`.
        seconds: the time limit, where the axis ends.
        kind: "tri" or "quad".
        path: PNG or SVG file to write.
    """
    figure, panels = _panels(len(races))
    reached = [float(t.min()) for _, times in races for t in times.values()]
    first = max(1e-4, 0.7 * min([*reached, 0.1 * seconds]))
    for axes, (title, times) in zip(panels, races, strict=True):
        for method, found in times.items():
            colour, style, width, label = _LINES[method]
            moments = np.sort(found[np.isfinite(found)])
            shares = np.arange(1, len(moments) + 1) / len(found)
            axes.step(
                [first, *moments, seconds],
                [0.0, *shares, shares[-1] if len(shares) else 0.0],
                where="post",
                color=colour,
                linestyle=style,
                linewidth=width,
                label=label,
                clip_on=False,
            )
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set_title(title, loc="left", fontsize=10, color=INK)
        axes.set(ylim=(0.0, 1.02), xlim=(first, seconds), xlabel="seconds per mesh, one core")
    panels[0].set_ylabel("share at the optimum")
    _share_legend(figure, panels[0], KIND_NOUN[kind].capitalize())
    _write(figure, path)


def _figure(width: float, height: float) -> Any:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained", facecolor="white")


def _panels(count: int) -> tuple[Any, list[Any]]:
    """A figure with `count` panels side by side that share their vertical axis."""
    figure = _figure(_PANEL * max(count, 2) + 0.4, 3.6)
    panels = list(figure.subplots(1, count, sharey=True, squeeze=False)[0])
    for axes in panels:
        _style(axes)
    return figure, panels


def _style(axes: Any) -> None:
    """Thin axes and a light horizontal grid."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(MUTED)
    axes.tick_params(colors=MUTED, labelsize=8.5)
    axes.xaxis.label.set(color=MUTED, fontsize=9.5)
    axes.yaxis.label.set(color=MUTED, fontsize=9.5)
    axes.grid(axis="y", color=LINE, linewidth=0.7)
    axes.set_axisbelow(True)


def _share_legend(figure: Any, axes: Any, title: str) -> None:
    """One legend below all panels, and a title above them."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles,
        labels,
        loc="outside lower center",
        ncols=len(labels),
        frameon=False,
        fontsize=9,
        handlelength=2.6,
    )
    figure.suptitle(title, x=0.01, ha="left", fontsize=12, color=INK)


def _write(figure: Any, path: str | Path) -> None:
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=DOTS)
