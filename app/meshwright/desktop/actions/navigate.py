"""Going about by keyboard: view, irregular vertices, half-edges, the operation that is meant."""

from __future__ import annotations

from functools import partial

from meshwright.desktop.actions.action import Action, has_mesh
from meshwright.desktop.actions.context import ActionContext


def _pan(right: float, up: float, context: ActionContext) -> None:
    context.navigation.pan(right, up)


def _panning(name: str, key: str, right: float, up: float) -> Action:
    return Action(
        f"walk.{name}",
        f"View {name}",
        f"Look further {name}",
        run=partial(_pan, right, up),
        shortcuts=(key,),
        enabled=has_mesh,
        menu="Go",
        on_canvas=True,
    )


ACTIONS: tuple[Action, ...] = (
    Action(
        "walk.next",
        "Next irregular vertex",
        "Look at the next irregular vertex, and point at an edge of it",
        run=lambda context: context.navigation.to_irregular(1),
        shortcuts=("N",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.previous",
        "Previous irregular vertex",
        "Look at the irregular vertex before",
        run=lambda context: context.navigation.to_irregular(-1),
        shortcuts=("Shift+N",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.operation",
        "Next operation",
        "Show the ghost of the next operation that is allowed here",
        run=lambda context: context.hover.cycle(1),
        shortcuts=("Tab",),
        enabled=has_mesh,
        menu="Go",
        on_canvas=True,
    ),
    Action(
        "walk.operation_back",
        "Previous operation",
        "Show the ghost of the operation before",
        run=lambda context: context.hover.cycle(-1),
        shortcuts=("Shift+Tab",),
        enabled=has_mesh,
        menu="Go",
        on_canvas=True,
    ),
    Action(
        "walk.do",
        "Do what the ghost shows",
        "Do the operation whose ghost is shown",
        run=lambda context: context.editing.operate_current(),
        shortcuts=("Return", "Enter"),
        enabled=has_mesh,
        menu="Go",
        on_canvas=True,
    ),
    Action(
        "walk.turn",
        "Turn to the next edge",
        "Point at the next half-edge around the vertex where this one starts",
        run=lambda context: context.navigation.turn(1),
        shortcuts=("E",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.turn_back",
        "Turn back",
        "Point at the half-edge before, around the vertex where this one starts",
        run=lambda context: context.navigation.turn(-1),
        shortcuts=("Shift+E",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.along",
        "Along the element",
        "Point at the half-edge that follows in the element",
        run=lambda context: context.navigation.along(),
        shortcuts=("D",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.across",
        "Across the edge",
        "Point at the other half-edge of the edge",
        run=lambda context: context.navigation.across(),
        shortcuts=("Q",),
        enabled=has_mesh,
        menu="Go",
    ),
    _panning("left", "Left", -1.0, 0.0),
    _panning("right", "Right", 1.0, 0.0),
    _panning("up", "Up", 0.0, 1.0),
    _panning("down", "Down", 0.0, -1.0),
)
