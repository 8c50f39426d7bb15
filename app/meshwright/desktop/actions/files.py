"""Meshes that come and go: new, open, save."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshwright.desktop.actions.action import Action, has_mesh, needing

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


@needing("No file has been opened or saved yet.")
def has_recent(window: MainWindow) -> bool:
    """There are files to be opened again."""
    return bool(window.settings.recent)


ACTIONS: tuple[Action, ...] = (
    Action(
        "new",
        "New\u2026",
        "Make a mesh of a shape: gallery, random, drawn, or from a file",
        lambda window: window.files.new(),
        ("Ctrl+N",),
        menu="File",
        icon="new",
    ),
    Action(
        "open",
        "Open\u2026",
        "Open a mesh, a project, or the shape in a drawing",
        lambda window: window.files.choose(),
        ("Ctrl+O",),
        menu="File",
        icon="open",
    ),
    Action(
        "recent",
        "Open recent",
        "Files that were opened or saved lately",
        lambda window: window.files.show_recent(),
        (),
        has_recent,
        menu="File",
    ),
    Action(
        "save",
        "Save",
        "Write the mesh to its file",
        lambda window: window.files.save(),
        ("Ctrl+S",),
        has_mesh,
        menu="File",
        icon="save",
    ),
    Action(
        "save_as",
        "Save as\u2026",
        "Write the mesh to another file, or all of the work to a project",
        lambda window: window.files.save_as(),
        ("Ctrl+Shift+S",),
        has_mesh,
        menu="File",
    ),
    Action(
        "recover",
        "Recover lost work\u2026",
        "Take up what was not saved when the program ended without closing",
        lambda window: window.files.ask_for_lost(),
        (),
        menu="File",
    ),
    Action(
        "quit",
        "Quit",
        "Close the window",
        lambda window: window.close() and None,
        ("Ctrl+Q",),
        menu="File",
    ),
)
