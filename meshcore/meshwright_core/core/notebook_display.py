"""The representation of a mesh at the end of a notebook cell.

This package does not draw. Another package registers a drawing function as an entry point, which
is looked up when the first mesh is shown; without one a mesh is shown as a line of text.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.metadata import entry_points
from typing import Any

from meshwright_core.core.mesh_view import MeshView

GROUP, NAME = "meshwright.display", "figure"
"""Group and name of the entry point. It is a function of a mesh and a name for the caption, which
may be empty, that returns MIME types with their data, and MIME types with their metadata.
"""

Bundle = tuple[dict[str, Any], dict[str, Any]]


def bundle(mesh: MeshView, name: str = "") -> Bundle:
    """MIME data and metadata of a mesh: its line of text, and a picture if one can be drawn.

    `name` goes into the caption of the picture.
    """
    text = {"text/plain": repr(mesh)}
    draw = drawer()
    if draw is None:
        return text, {}
    pictures, metadata = draw(mesh, name)
    return {**text, **pictures}, metadata


@cache
def drawer() -> Callable[[MeshView, str], Bundle] | None:
    """The drawing function that is registered, None if there is none."""
    found = [point for point in entry_points(group=GROUP) if point.name == NAME]
    return found[0].load() if found else None
