"""Stills: the mesh that somebody gave, and small figures of meshes."""

from __future__ import annotations

from typing import Any

import numpy as np

from meshwright.experiments.picture import ThemedLook
from meshwright.graphics.drawing import Drawing, Text
from meshwright.graphics.markers import READABLE, label, markers
from meshwright.graphics.mesh_figure import figure
from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport
from meshwright.sources import resolve
from meshwright_core import HalfEdgeMesh, MeshError

MARGIN = 16.0
FEW = 6
"""Small discs that get their number beside them."""


def given_mesh(source: Any) -> HalfEdgeMesh:
    """A copy of the mesh that is meant: one, that of a document or widget or film, or what
    :func:`meshwright.sources.resolve.mesh` makes a mesh of. MeshError where there is none or it is
    empty.
    """
    mesh = resolve.mesh(source)
    if mesh.n_elements == 0:
        raise MeshError("This mesh has no elements.")
    return mesh


def still(
    mesh: HalfEdgeMesh, size: tuple[int, int], theme: Theme, window: np.ndarray | None = None
) -> Drawing:
    """A small figure of the mesh, lines and letters as large as in the window.

    window (n, 2): points that are to fill it, in place of the whole mesh.
    """
    look = ThemedLook(size=size, score=False, curve=False, unit=1.0, given=theme)
    shown = mesh.points[mesh.vertices()] if window is None else window
    view = Viewport(size=size).fitted(shown, MARGIN)
    drawing = figure(mesh, look, None, view)
    _add_numbers(drawing, mesh, view, theme)
    return drawing


def _add_numbers(drawing: Drawing, mesh: HalfEdgeMesh, view: Viewport, theme: Theme) -> None:
    """The numbers of discs too small to hold one, beside them, where they are few."""
    marks = markers(mesh)
    radii = marks.radii(view)
    small = np.flatnonzero(radii < READABLE)
    if len(small) > FEW:
        return
    places = view.to_screen(marks.places)
    for i in small.tolist():
        x, y = (places[i] + (radii[i] + 2.0, -radii[i] - 5.0)).tolist()
        drawing.add(Text(label(int(marks.delta[i])), (x, y), 10.5, theme.text))
