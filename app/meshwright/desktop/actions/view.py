"""Actions of the menu View, and the preferences."""

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
        "Zoom in at the centre of the view",
        run=lambda context: context.navigation.zoom(True),
        shortcuts=("+", "=", "Ctrl++"),
        enabled=has_mesh,
        menu="View",
    ),
    Action(
        "zoom_out",
        "Zoom out",
        "Zoom out at the centre of the view",
        run=lambda context: context.navigation.zoom(False),
        shortcuts=("-", "Ctrl+-"),
        enabled=has_mesh,
        menu="View",
    ),
    Action(
        "ghosts",
        "Preview of operations",
        "Preview the operation at the mouse",
        run=lambda context: context.hover.toggle_ghosts(),
        shortcuts=("Ctrl+G",),
        enabled=has_mesh,
        menu="View",
        checked=lambda context: context.hover.ghosts,
    ),
    Action(
        "lines",
        "Removable lines",
        "Highlight the global lines that can be removed; a click removes one",
        run=lambda context: context.lines.toggle(),
        shortcuts=("L",),
        enabled=has_quads,
        menu="View",
        icon="lines",
        checked=lambda context: context.lines.shown,
    ),
    Action(
        "theme",
        "Light or dark theme",
        "Switch between the light and the dark theme",
        run=lambda context: context.preferences.toggle_theme(),
        shortcuts=("Ctrl+T",),
        menu="View",
        icon="theme",
    ),
    Action(
        "auto_smooth",
        "Smooth after every operation",
        "Smooth the vertices around every operation",
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
