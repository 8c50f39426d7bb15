"""Help."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action

ACTIONS: tuple[Action, ...] = (
    Action(
        "palette",
        "Find a command\u2026",
        "Every command, found by a few letters",
        lambda window: window.guide.show_palette(),
        ("Ctrl+K", "Ctrl+Shift+P"),
        menu="Help",
        icon="search",
        repeats=False,
    ),
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
        "tour",
        "Show the tour",
        "Five steps around the window",
        lambda window: window.guide.show_tour(),
        menu="Help",
    ),
    Action(
        "about",
        "About Meshwright",
        "Version and licences",
        lambda window: window.guide.show_about(),
        menu="Help",
    ),
)
