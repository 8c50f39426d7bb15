"""Figures of a training: the learning curve, as in the paper's section 5."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from agent.paper import single as paper_single
from meshcore.atomic import replacing


def learning_curve(
    curve: Sequence[dict[str, float]], kind: str, title: str, path: str | Path
) -> None:
    """Draw mean and standard deviation of single rollouts against decisions into a PNG or SVG file.

    curve: points of :class:`agent.training.Progress`.
    """
    from matplotlib.figure import Figure

    decisions = [point["decisions"] / 1000.0 for point in curve]
    mean = [point["mean"] for point in curve]
    low = [point["mean"] - point["std"] for point in curve]
    high = [min(1.0, point["mean"] + point["std"]) for point in curve]
    solved = [point["at_optimum"] for point in curve]
    figure = Figure(figsize=(6.4, 3.8), layout="constrained")
    axes = figure.subplots()
    axes.fill_between(decisions, low, high, color="#0072B2", alpha=0.15, linewidth=0)
    axes.plot(decisions, mean, color="#0072B2", label="normalised return, single rollout")
    axes.plot(decisions, solved, color="#D55E00", linestyle="--", label="share at the optimum")
    paper = paper_single(kind)
    axes.axhline(paper, color="#475569", linewidth=0.8, linestyle=":")
    axes.annotate(
        f"paper, single rollout: {paper}",
        (1.0, paper),
        xycoords=("axes fraction", "data"),
        xytext=(-4, -11),
        textcoords="offset points",
        ha="right",
        fontsize=8,
        color="#475569",
    )
    axes.set(title=title, xlabel="decisions (thousands)", ylim=(0.0, 1.02))
    axes.set_xlim(0.0, max(decisions))
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, loc="center right", fontsize=9)
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=160)
