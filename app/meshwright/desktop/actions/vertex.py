"""Actions on the vertices at hand: pin, lock, corner, desired degree."""

from __future__ import annotations

from functools import partial

from meshwright.desktop.actions.action import Action, has_mesh
from meshwright.desktop.actions.context import ActionContext

DEGREES = range(2, 9)
"""Desired degrees with a command."""


def _desire(degree: int, context: ActionContext) -> None:
    context.vertices.set_desired(degree)


ACTIONS: tuple[Action, ...] = (
    Action(
        "vertex.pin",
        "Pin vertex",
        "Keep the vertex, or the selected ones, in place when the mesh is smoothed; again: free it",
        run=lambda context: context.vertices.toggle_pinned(),
        shortcuts=("P",),
        enabled=has_mesh,
        menu="Mesh",
    ),
    Action(
        "vertex.lock",
        "Lock vertex",
        "Lock the vertex, or the selected ones: not moved or removed; again: unlock it",
        run=lambda context: context.vertices.toggle_locked(),
        shortcuts=("K",),
        enabled=has_mesh,
        menu="Mesh",
    ),
    Action(
        "vertex.corner",
        "Make corner",
        "Make the vertex, or the selected ones, a corner; again: free it",
        run=lambda context: context.vertices.toggle_corner(),
        shortcuts=("O",),
        enabled=has_mesh,
        menu="Mesh",
    ),
    *(
        Action(
            f"vertex.desired_{degree}",
            f"Desired degree {degree}",
            f"Set the desired degree of the vertex, or of the selected ones, to {degree}",
            run=partial(_desire, degree),
            shortcuts=(f"Alt+{degree}",),
            enabled=has_mesh,
            menu="Mesh",
        )
        for degree in DEGREES
    ),
)
