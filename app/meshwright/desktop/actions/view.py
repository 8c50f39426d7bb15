"""What is seen, and how."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action, has_mesh, has_quads

ACTIONS: tuple[Action, ...] = (
    Action(
        "fit",
        "Fit",
        "Show the whole mesh",
        run=lambda context: context.canvas.fit(),
        shortcuts=("Home", "Ctrl+0"),
        enabled=has_mesh,
        menu="View",
        icon="fit",
        word="Fit",
    ),
    Action(
        "zoom_in",
        "Zoom in",
        "Look from closer by",
        run=lambda context: context.navigation.zoom(True),
        shortcuts=("+", "=", "Ctrl++"),
        enabled=has_mesh,
        menu="View",
    ),
    Action(
        "zoom_out",
        "Zoom out",
        "Look from farther away",
        run=lambda context: context.navigation.zoom(False),
        shortcuts=("-", "Ctrl+-"),
        enabled=has_mesh,
        menu="View",
    ),
    Action(
        "ghosts",
        "Ghosts of operations",
        "Show what an operation would do where one points",
        run=lambda context: context.hover.toggle_ghosts(),
        shortcuts=("Ctrl+G",),
        enabled=has_mesh,
        menu="View",
        checked=lambda context: context.hover.ghosts,
    ),
    Action(
        "lines",
        "Lines that can be removed",
        "Let the global lines glow that can be removed: a click removes one",
        run=lambda context: context.lines.toggle(),
        shortcuts=("L",),
        enabled=has_quads,
        menu="View",
        icon="lines",
        checked=lambda context: context.lines.shown,
    ),
    Action(
        "theme",
        "Light or dark",
        "Switch between the light and the dark theme",
        run=lambda context: context.preferences.toggle_theme(),
        shortcuts=("Ctrl+T",),
        menu="View",
        icon="theme",
    ),
    Action(
        "auto_smooth",
        "Smooth after every operation",
        "Move the vertices near an operation, so that the picture stays readable",
        run=lambda context: context.preferences.toggle_auto_smooth(),
        menu="Edit",
        checked=lambda context: context.settings.auto_smooth,
    ),
    Action(
        "preferences",
        "Preferences\u2026",
        "Theme, colours, smoothing, autosave",
        run=lambda context: context.preferences.show(),
        shortcuts=("Ctrl+,",),
        menu="Edit",
    ),
)
