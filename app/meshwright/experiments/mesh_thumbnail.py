"""Small figures of meshes, and the mesh that a caller gave in one of several forms."""

from __future__ import annotations

from typing import Any

import numpy as np

from meshwright.experiments.picture import ThemedFigureOptions
from meshwright.graphics.drawing import Drawing, Text
from meshwright.graphics.markers import READABLE, label, markers
from meshwright.graphics.mesh_figure import figure
from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport
from meshwright.sources import resolve
from meshwright_core import HalfEdgeMesh, MeshError

MARGIN = 16.0
FEW = 6
"""The most discs whose numbers are written beside them."""


def given_mesh(source: Any) -> HalfEdgeMesh:
    """A copy of a mesh, of the mesh of a document, widget or film, or of what
    :func:`meshwright.sources.resolve.mesh` makes of any other source. MeshError if there is no mesh
    or it has no elements.
    """
    mesh = resolve.mesh(source)
    if mesh.n_elements == 0:
        raise MeshError("This mesh has no elements.")
    return mesh


def thumbnail(
    mesh: HalfEdgeMesh, size: tuple[int, int], theme: Theme, window: np.ndarray | None = None
) -> Drawing:
    """A small figure of the mesh, with lines and letters of the same size as in the window.

    window (n, 2): points that the view is fitted to; None: the whole mesh.
    """
    options = ThemedFigureOptions(size=size, score=False, curve=False, unit=1.0, given=theme)
    shown = mesh.points[mesh.vertices()] if window is None else window
    view = Viewport(size=size).fitted(shown, MARGIN)
    drawing = figure(mesh, options, None, view)
    _add_numbers(drawing, mesh, view, theme)
    return drawing


def _add_numbers(drawing: Drawing, mesh: HalfEdgeMesh, view: Viewport, theme: Theme) -> None:
    """Write the numbers of discs that are too small to hold one beside them, if they are few."""
    marks = markers(mesh)
    radii = marks.radii(view)
    small = np.flatnonzero(radii < READABLE)
    if len(small) > FEW:
        return
    places = view.to_screen(marks.places)
    for i in small.tolist():
        x, y = (places[i] + (radii[i] + 2.0, -radii[i] - 5.0)).tolist()
        drawing.add(Text(label(int(marks.delta[i])), (x, y), 10.5, theme.text))
