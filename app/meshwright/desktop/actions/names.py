"""Actions of the menu Mesh for the names of sides and regions."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action, has_mesh, needing
from meshwright.desktop.actions.context import ActionContext


@needing("Needs a mesh; a level's mesh has no names.")
def can_name(context: ActionContext) -> bool:
    """There is a mesh, and no level is played: names make corners, which would change it."""
    return has_mesh(context) and context.levels.level is None


ACTIONS: tuple[Action, ...] = (
    Action(
        "names",
        "Names\u2026",
        "Name the selected sides and regions; list and change the names",
        run=lambda context: context.names.edit(),
        shortcuts=("Ctrl+Alt+N",),
        enabled=can_name,
        menu="Mesh",
    ),
    Action(
        "show_names",
        "Sides by name",
        "Show named sides in colours, with a legend",
        run=lambda context: context.names.toggle(),
        shortcuts=("Ctrl+Shift+N",),
        enabled=has_mesh,
        menu="View",
        checked=lambda context: context.names.shown,
    ),
)
