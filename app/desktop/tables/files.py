"""Meshes that come and go: new, open, save."""

from __future__ import annotations

from app.desktop.action import Action, has_mesh

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
        "Open a mesh file",
        lambda window: window.files.choose(),
        ("Ctrl+O",),
        menu="File",
        icon="open",
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
        "Write the mesh to another file",
        lambda window: window.files.save_as(),
        ("Ctrl+Shift+S",),
        has_mesh,
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
