"""Going about by keyboard: view, irregular vertices, half-edges, the operation that is meant."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from meshwright.desktop.actions.action import Action, has_mesh

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


def _pan(right: float, up: float, window: MainWindow) -> None:
    window.walking.pan(right, up)


def _panning(name: str, key: str, right: float, up: float) -> Action:
    return Action(
        f"walk.{name}",
        f"View {name}",
        f"Look further {name}",
        partial(_pan, right, up),
        (key,),
        has_mesh,
        menu="Go",
        on_canvas=True,
    )


ACTIONS: tuple[Action, ...] = (
    Action(
        "walk.next",
        "Next irregular vertex",
        "Look at the next irregular vertex, and point at an edge of it",
        lambda window: window.walking.to_irregular(1),
        ("N",),
        has_mesh,
        menu="Go",
    ),
    Action(
        "walk.previous",
        "Previous irregular vertex",
        "Look at the irregular vertex before",
        lambda window: window.walking.to_irregular(-1),
        ("Shift+N",),
        has_mesh,
        menu="Go",
    ),
    Action(
        "walk.operation",
        "Next operation",
        "Show the ghost of the next operation that is allowed here",
        lambda window: window.pointing.cycle(1),
        ("Tab",),
        has_mesh,
        menu="Go",
        on_canvas=True,
    ),
    Action(
        "walk.operation_back",
        "Previous operation",
        "Show the ghost of the operation before",
        lambda window: window.pointing.cycle(-1),
        ("Shift+Tab",),
        has_mesh,
        menu="Go",
        on_canvas=True,
    ),
    Action(
        "walk.do",
        "Do what the ghost shows",
        "Do the operation whose ghost is shown",
        lambda window: window.editing.operate_current(),
        ("Return", "Enter"),
        has_mesh,
        menu="Go",
        on_canvas=True,
    ),
    Action(
        "walk.turn",
        "Turn to the next edge",
        "Point at the next half-edge around the vertex where this one starts",
        lambda window: window.walking.turn(1),
        ("E",),
        has_mesh,
        menu="Go",
    ),
    Action(
        "walk.turn_back",
        "Turn back",
        "Point at the half-edge before, around the vertex where this one starts",
        lambda window: window.walking.turn(-1),
        ("Shift+E",),
        has_mesh,
        menu="Go",
    ),
    Action(
        "walk.along",
        "Along the element",
        "Point at the half-edge that follows in the element",
        lambda window: window.walking.along(),
        ("D",),
        has_mesh,
        menu="Go",
    ),
    Action(
        "walk.across",
        "Across the edge",
        "Point at the other half-edge of the edge",
        lambda window: window.walking.across(),
        ("Q",),
        has_mesh,
        menu="Go",
    ),
    _panning("left", "Left", -1.0, 0.0),
    _panning("right", "Right", 1.0, 0.0),
    _panning("up", "Up", 0.0, 1.0),
    _panning("down", "Down", 0.0, -1.0),
)
