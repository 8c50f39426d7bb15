"""How a mesh shows itself at the end of a notebook's cell."""

from importlib.metadata import EntryPoint

import pytest
from tiny_meshes import grid

from meshwright_core.core import notebook_display


@pytest.fixture(autouse=True)
def _forgotten():
    notebook_display.drawer.cache_clear()
    yield
    notebook_display.drawer.cache_clear()


def installed(monkeypatch, *points: EntryPoint) -> None:
    monkeypatch.setattr(
        notebook_display, "entry_points", lambda group: [p for p in points if p.group == group]
    )


def squares(mesh, name):
    """A drawer."""
    return {"image/svg+xml": f"<svg>{mesh.n_elements}</svg>"}, {"image/svg+xml": {"alt": "grid"}}


def test_without_a_drawing_function_the_line_of_text_is_shown(monkeypatch):
    installed(monkeypatch)
    mesh = grid(2)
    assert mesh._repr_mimebundle_() == ({"text/plain": repr(mesh)}, {})


def test_the_drawing_function_is_found_by_its_name_when_a_mesh_is_shown(monkeypatch):
    group, here = notebook_display.GROUP, f"{__name__}:squares"
    installed(
        monkeypatch,
        EntryPoint("other", "nowhere:nothing", group),
        EntryPoint(notebook_display.NAME, here, group),
    )
    mesh = grid(3)
    data, metadata = mesh._repr_mimebundle_(include=None, exclude=None)
    assert data == {"text/plain": repr(mesh), "image/svg+xml": "<svg>9</svg>"}
    assert metadata == {"image/svg+xml": {"alt": "grid"}}


def test_errors_of_the_drawing_function_are_raised(monkeypatch):
    installed(
        monkeypatch,
        EntryPoint(notebook_display.NAME, "no_such_module:draw", notebook_display.GROUP),
    )
    with pytest.raises(ModuleNotFoundError):
        grid(2)._repr_mimebundle_()
