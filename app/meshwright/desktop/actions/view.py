"""Actions of the menu View, and the preferences."""

from __future__ import annotations

from functools import partial

from meshwright.desktop.actions.action import Action, has_mesh, has_quads
from meshwright.desktop.actions.context import ActionContext
from meshwright.desktop.quality.colour_controller import QUADS
from meshwright.graphics.colouring import PLAIN, TITLES, named


def _colour(by: str, context: ActionContext) -> None:
    context.colours.use(by)


def _is_coloured(by: str, context: ActionContext) -> bool:
    return context.colours.colour == by


def _has_inverted(context: ActionContext) -> bool:
    summary = context.quality.monitor.summary
    return summary is not None and len(summary.inverted) > 0


def _colouring(by: str) -> Action:
    return Action(
        f"colour.{by}",
        f"Colour by {named(by)}",
        "Colour the elements, with a legend; once more: plain elements",
        run=partial(_colour, by),
        enabled=has_quads if by in QUADS else has_mesh,
        menu="View",
        checked=partial(_is_coloured, by),
    )


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
        "zoom_selection",
        "Zoom to the selection",
        "Show the selected vertices as large as they fit",
        run=lambda context: context.quality.go_to_selection(),
        shortcuts=("Ctrl+1",),
        enabled=lambda context: len(context.document.selection) > 0,
        menu="View",
        needs="Nothing is selected.",
    ),
    Action(
        "zoom_worst",
        "Zoom to the worst element",
        "Go to the element with the smallest scaled Jacobian",
        run=lambda context: context.quality.go_to_worst(),
        shortcuts=("Ctrl+2",),
        enabled=has_mesh,
        menu="View",
    ),
    Action(
        "zoom_inverted",
        "Zoom to the next inverted element",
        "Go to the next element with a reversed orientation",
        run=lambda context: context.quality.go_to_inverted(),
        shortcuts=("Ctrl+3",),
        enabled=_has_inverted,
        menu="View",
        needs="No element is inverted.",
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
    *(_colouring(by) for by in TITLES if by != PLAIN),
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
