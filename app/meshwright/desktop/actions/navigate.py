"""Actions of the menu Go: view, irregular vertices, half-edges and operations by keyboard."""

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
        f"Move the view {name}",
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
        "Go to the next irregular vertex, and point at one of its edges",
        run=lambda context: context.navigation.to_irregular(1),
        shortcuts=("N",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.previous",
        "Previous irregular vertex",
        "Go to the previous irregular vertex",
        run=lambda context: context.navigation.to_irregular(-1),
        shortcuts=("Shift+N",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.operation",
        "Next operation",
        "Preview the next operation that is allowed here",
        run=lambda context: context.hover.cycle(1),
        shortcuts=("T",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.operation_back",
        "Previous operation",
        "Preview the previous operation that is allowed here",
        run=lambda context: context.hover.cycle(-1),
        shortcuts=("Shift+T",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.do",
        "Apply previewed operation",
        "Apply the operation that is previewed",
        run=lambda context: context.editing.operate_current(),
        shortcuts=("Return", "Enter"),
        enabled=has_mesh,
        menu="Go",
        on_canvas=True,
    ),
    Action(
        "walk.turn",
        "Rotate to next edge",
        "Point at the next half-edge around the origin of this one",
        run=lambda context: context.navigation.turn(1),
        shortcuts=("E",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.turn_back",
        "Rotate to previous edge",
        "Point at the previous half-edge around the origin of this one",
        run=lambda context: context.navigation.turn(-1),
        shortcuts=("Shift+E",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.along",
        "Next edge of the element",
        "Point at the next half-edge of the element",
        run=lambda context: context.navigation.along(),
        shortcuts=("D",),
        enabled=has_mesh,
        menu="Go",
    ),
    Action(
        "walk.across",
        "Across the edge",
        "Point at the twin half-edge",
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
