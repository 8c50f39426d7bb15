"""Meshes that come and go: new, open, save."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action, has_mesh, needing
from meshwright.desktop.actions.context import ActionContext


@needing("No file has been opened or saved yet.")
def has_recent(context: ActionContext) -> bool:
    """There are files to be opened again."""
    return bool(context.settings.recent)


ACTIONS: tuple[Action, ...] = (
    Action(
        "new",
        "New\u2026",
        "Make a mesh of a shape: gallery, random, drawn, or from a file",
        run=lambda context: context.files.new(),
        shortcuts=("Ctrl+N",),
        menu="File",
        icon="new",
    ),
    Action(
        "open",
        "Open\u2026",
        "Open a mesh, a project, or the shape in a drawing",
        run=lambda context: context.files.choose(),
        shortcuts=("Ctrl+O",),
        menu="File",
        icon="open",
    ),
    Action(
        "recent",
        "Open recent",
        "Files that were opened or saved lately",
        run=lambda context: context.files.show_recent(),
        enabled=has_recent,
        menu="File",
    ),
    Action(
        "save",
        "Save",
        "Write the mesh to its file",
        run=lambda context: context.files.save(),
        shortcuts=("Ctrl+S",),
        enabled=has_mesh,
        menu="File",
        icon="save",
    ),
    Action(
        "save_as",
        "Save as\u2026",
        "Write the mesh to another file, or all of the work to a project",
        run=lambda context: context.files.save_as(),
        shortcuts=("Ctrl+Shift+S",),
        enabled=has_mesh,
        menu="File",
    ),
    Action(
        "recover",
        "Recover lost work\u2026",
        "Take up what was not saved when the program ended without closing",
        run=lambda context: context.files.ask_for_lost(),
        menu="File",
    ),
    Action(
        "quit",
        "Quit",
        "Close the window",
        run=lambda context: context.close(),
        shortcuts=("Ctrl+Q",),
        menu="File",
    ),
)
