"""Pictures of a rollout side by side, from the start to its best state, as in section 5."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_agent.evaluation.figures import BLUE, DOTS, GREEN, INK, MUTED, VERMILION
from meshwright_agent.policy.rollout import PolicyStep
from meshwright_core.geometry import smoothing
from meshwright_core.geometry.true_edges import TrueEdges
from meshwright_core.io.atomic_write import replacing
from meshwright_core.mesh import HalfEdgeMesh

PICTURES = 5
_FILL, _EDGE, _OUTLINE = "#F1F2ED", "#8D99A6", "#2F3B48"
_SIZE = 3.0  # inches, width of one picture
_FINENESS = 2e-4  # of the extent: distance of drawn edges from their curves
_HEAD = 0.55  # inches, for the text above it


def rollout_strip(
    mesh: HalfEdgeMesh, steps: Sequence[PolicyStep], path: str | Path, pictures: int = PICTURES
) -> None:
    """Draw the mesh at the start, at the end, and after equal numbers of steps between.

    The mesh is smoothed before each picture.

    Args:
        mesh: the start, which is not changed.
        steps: from :meth:`meshwright_agent.evaluation.rollouts.Rollouts.steps`.
        path: PNG or SVG file to write.
        pictures: number of pictures.
    """
    from matplotlib.figure import Figure

    stops = np.unique(np.linspace(0, len(steps), pictures).round().astype(int)).tolist()
    ids = mesh.vertices()
    extent = np.ptp(mesh.points[ids, :2], axis=0)
    height = _SIZE * float(np.clip(extent[1] / extent[0], 0.3, 2.0))
    figure = Figure(figsize=(_SIZE * len(stops), height + _HEAD), facecolor="white")
    panels = figure.subplots(1, len(stops), squeeze=False)[0]
    top = height / (height + _HEAD)
    figure.subplots_adjust(left=0.004, right=0.996, bottom=0.0, top=top, wspace=0.02)
    played, done = mesh.copy(), 0
    for axes, stop in zip(panels, stops, strict=True):
        for operation, h in [one for step in steps[done:stop] for one in step]:
            played.apply(operation, h)
        done = stop
        smoothing.relax(played)
        draw_mesh(axes, played)
        name = "start" if stop == 0 else f"{stop} operations" if stop > 1 else "1 operation"
        _title(axes, name, played)
    with replacing(path) as temporary:
        figure.savefig(temporary, dpi=DOTS)


def draw_mesh(axes: Any, mesh: HalfEdgeMesh) -> None:
    """Draw elements, outline, corners, and irregular vertices labelled with their Delta."""
    from matplotlib.collections import LineCollection, PolyCollection

    points, ids = mesh.points[:, :2], mesh.vertices()
    extent = float(np.ptp(points[ids], axis=0).max())
    true = TrueEdges(mesh, _FINENESS * extent)
    outlines = true.outlines(mesh.element_ids())
    axes.add_collection(PolyCollection(outlines, facecolor=_FILL, edgecolor=_EDGE, linewidth=0.7))
    lines = [np.vstack([line, line[:1]]) for line in map(true.chained, true.rims())]
    for collection, width in ((true.interfaces(), 1.0), (lines, 1.5)):
        axes.add_collection(
            LineCollection(collection, colors=_OUTLINE, linewidths=width, capstyle="round")
        )
    corners = points[ids[mesh.geometric()[ids]]]
    axes.scatter(*corners.T, s=9, marker="s", color=_OUTLINE, linewidths=0, zorder=3)
    delta = mesh.irregularity()
    radius = _marker_size(mesh)
    for v in ids[delta[ids] != 0].tolist():
        amount = int(delta[v])
        size = radius * (1.0 + 0.25 * (min(abs(amount), 3) - 1))
        colour = VERMILION if amount > 0 else BLUE
        axes.scatter(
            *points[v], s=size**2, color=colour, edgecolor="white", linewidths=0.7, zorder=4
        )
        label = f"{amount:+d}".replace("-", "\N{MINUS SIGN}")
        axes.annotate(
            label, points[v], ha="center", va="center_baseline", fontsize=0.58 * size,
            color="white", zorder=5,
        )  # fmt: skip
    low, high = points[ids].min(axis=0), points[ids].max(axis=0)
    margin = 0.04 * float((high - low).max())
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    axes.set_axis_off()


def _marker_size(mesh: HalfEdgeMesh) -> float:
    """Diameter of a vertex marker in points: fits between vertices, yet its label is legible."""
    spacing = 72.0 * _SIZE * 0.8 / np.sqrt(max(mesh.n_vertices, 1))
    return float(np.clip(0.45 * spacing, 8.0, 12.0))


def _title(axes: Any, name: str, mesh: HalfEdgeMesh) -> None:
    """Two lines of text above a picture: its name, and s and s*."""
    at_optimum = mesh.score == mesh.optimum
    score = f"s = {mesh.score}, s* = {mesh.optimum}"
    lines = [
        (20, 11.0, INK, name),
        (5, 10.0, GREEN if at_optimum else MUTED, score + (": at the optimum" * at_optimum)),
    ]
    for height, size, colour, text in lines:
        axes.annotate(
            text, (0.5, 1.0), xycoords="axes fraction", xytext=(0, height),
            textcoords="offset points", ha="center", va="bottom", fontsize=size, color=colour,
        )  # fmt: skip
