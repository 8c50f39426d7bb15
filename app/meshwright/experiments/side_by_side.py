"""The best rollouts of a comparison side by side, each in a widget of its own."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from html import escape
from typing import Any

from meshwright.experiments.comparison import Comparison
from meshwright_core import MeshError


def side_by_side(
    comparison: Comparison, policies: Sequence[str] | str | None = None, height: int = 400
) -> Any:
    """The best rollout of each policy in a widget of its own, in a row.

    Args:
        comparison: the result of :func:`meshwright.experiments.compare`.
        policies: names of policies in it, or one of them; None: the first two.
        height: the height of each mesh in pixels.

    Returns a box for Jupyter, whose ``children`` are boxes of a name and a
    :class:`meshwright.notebook.MeshWidget`, or in marimo a row of them.
    """
    if not isinstance(comparison, Comparison):
        raise MeshError("side_by_side() takes a comparison: make one by compare().")
    names = [policies] if isinstance(policies, str) else list(policies or comparison.policies[:2])
    widgets = [comparison.widget(name, height=height, name=name) for name in names]
    marimo = sys.modules.get("marimo")
    if marimo is not None and marimo.running_in_notebook():
        views = [
            marimo.vstack([marimo.md(f"**{name}**"), marimo.ui.anywidget(widget)])
            for name, widget in zip(names, widgets, strict=True)
        ]
        return marimo.hstack(views, widths="equal")
    from ipywidgets import HTML, HBox, Layout, VBox

    titles = [HTML(f"<b>{escape(name)}</b>") for name in names]
    columns = [
        VBox(list(pair), layout=Layout(flex="1 1 0%", min_width="0"))
        for pair in zip(titles, widgets, strict=True)
    ]
    return HBox(columns, layout=Layout(width="100%"))
