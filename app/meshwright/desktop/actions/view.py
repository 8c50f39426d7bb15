"""What is seen, and how."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action, has_mesh, has_quads

ACTIONS: tuple[Action, ...] = (
    Action(
        "fit",
        "Fit",
        "Show the whole mesh",
        lambda window: window.canvas.fit(),
        ("Home", "Ctrl+0"),
        has_mesh,
        menu="View",
        icon="fit",
        word="Fit",
    ),
    Action(
        "zoom_in",
        "Zoom in",
        "Look from closer by",
        lambda window: window.walking.zoom(True),
        ("+", "=", "Ctrl++"),
        has_mesh,
        menu="View",
    ),
    Action(
        "zoom_out",
        "Zoom out",
        "Look from farther away",
        lambda window: window.walking.zoom(False),
        ("-", "Ctrl+-"),
        has_mesh,
        menu="View",
    ),
    Action(
        "ghosts",
        "Ghosts of operations",
        "Show what an operation would do where one points",
        lambda window: window.pointing.toggle_ghosts(),
        ("Ctrl+G",),
        has_mesh,
        menu="View",
        checked=lambda window: window.pointing.ghosts,
    ),
    Action(
        "lines",
        "Lines that can be removed",
        "Let the global lines glow that can be removed: a click removes one",
        lambda window: window.lines.toggle(),
        ("L",),
        has_quads,
        menu="View",
        icon="lines",
        checked=lambda window: window.lines.shown,
    ),
    Action(
        "theme",
        "Light or dark",
        "Switch between the light and the dark theme",
        lambda window: window.preferences.toggle_theme(),
        ("Ctrl+T",),
        menu="View",
        icon="theme",
    ),
    Action(
        "auto_smooth",
        "Smooth after every operation",
        "Move the vertices near an operation, so that the picture stays readable",
        lambda window: window.preferences.toggle_auto_smooth(),
        menu="Edit",
        checked=lambda window: window.settings.auto_smooth,
    ),
    Action(
        "preferences",
        "Preferences\u2026",
        "Theme, colours, smoothing, autosave",
        lambda window: window.preferences.show(),
        ("Ctrl+,",),
        menu="Edit",
    ),
)
