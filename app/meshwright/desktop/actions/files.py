"""Actions of the menu File: new, open, save, recover, quit."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action, has_mesh, needing
from meshwright.desktop.actions.context import ActionContext


@needing("No file has been opened or saved yet.")
def has_recent(context: ActionContext) -> bool:
    """The list of recent files is not empty."""
    return bool(context.settings.recent)


ACTIONS: tuple[Action, ...] = (
    Action(
        "new",
        "New\u2026",
        "Mesh a shape: from the gallery, random, drawn, or from a file",
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
        "Recently opened or saved files",
        run=lambda context: context.files.show_recent(),
        enabled=has_recent,
        menu="File",
    ),
    Action(
        "save",
        "Save",
        "Save the mesh to its file",
        run=lambda context: context.files.save(),
        shortcuts=("Ctrl+S",),
        enabled=has_mesh,
        menu="File",
        icon="save",
    ),
    Action(
        "save_as",
        "Save as\u2026",
        "Save mesh and history to a project, or the mesh alone to another file",
        run=lambda context: context.files.save_as(),
        shortcuts=("Ctrl+Shift+S",),
        enabled=has_mesh,
        menu="File",
    ),
    Action(
        "recover",
        "Recover unsaved work\u2026",
        "Recover work that was not saved when the program ended unexpectedly",
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
