"""How a mesh shows itself at the end of a notebook's cell.

meshcore draws nothing: who can draw says so by an entry point, which is looked up when the first
mesh is shown. Without one a mesh is shown as its line of text.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

GROUP, NAME = "meshwright.display", "figure"
"""Group and name of the entry point. It is a function of a mesh and a name for the caption, which
may be empty, that returns MIME types with their data, and MIME types with their metadata.
"""

Bundle = tuple[dict[str, Any], dict[str, Any]]


def bundle(mesh: HalfEdgeMesh, name: str = "") -> Bundle:
    """The MIME types a notebook may choose from: the mesh's line of text, and a picture if a
    drawing function is installed. `name` goes into the caption of the picture.
    """
    text = {"text/plain": repr(mesh)}
    draw = drawer()
    if draw is None:
        return text, {}
    pictures, metadata = draw(mesh, name)
    return {**text, **pictures}, metadata


@cache
def drawer() -> Callable[[HalfEdgeMesh, str], Bundle] | None:
    """The function that is installed for drawing, None if there is none."""
    found = [point for point in entry_points(group=GROUP) if point.name == NAME]
    return found[0].load() if found else None
