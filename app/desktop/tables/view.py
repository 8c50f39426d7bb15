"""What is seen, and how."""

from __future__ import annotations

from app.desktop.action import Action, has_mesh

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
