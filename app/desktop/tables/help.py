"""Help."""

from __future__ import annotations

from app.desktop.action import Action

ACTIONS: tuple[Action, ...] = (
    Action(
        "help",
        "Keys and mouse",
        "All keys, and what the mouse does",
        lambda window: window.guide.show_keys(),
        ("F1",),
        menu="Help",
        icon="help",
    ),
    Action(
        "about",
        "About Meshwright",
        "Version and licences",
        lambda window: window.guide.show_about(),
        menu="Help",
    ),
)
