"""What is selected, and the tools of the mouse."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from meshwright.desktop.actions.action import Action, has_mesh
from meshwright.desktop.editing.selection_controller import BOX, EDIT, LASSO

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow

DEGREES = range(2, 9)
"""Degrees that can be selected by."""


def has_selection(window: MainWindow) -> bool:
    """Some vertex is selected."""
    return len(window.document.selection) > 0


def _use(tool: str, window: MainWindow) -> None:
    window.selecting.use(tool)


def _uses(tool: str, window: MainWindow) -> bool:
    return window.selecting.tool == tool


def _of_degree(degree: int, window: MainWindow) -> None:
    window.document.selection.of_degree(degree)


def _tool(tool: str, title: str, tooltip: str, keys: str) -> Action:
    return Action(
        f"tool.{tool}",
        title,
        tooltip,
        partial(_use, tool),
        (keys,),
        has_mesh,
        menu="Select",
        icon=tool,
        checked=partial(_uses, tool),
    )


ACTIONS: tuple[Action, ...] = (
    _tool(EDIT, "Edit", "Click half-edges, drag vertices, drag beside them to move the view", "A"),
    _tool(BOX, "Select by box", "Drag a box around vertices; with Shift at any time", "B"),
    _tool(
        LASSO, "Select by lasso", "Draw around vertices; with Shift and Alt at any time", "Shift+B"
    ),
    Action(
        "select.all",
        "Select all",
        "Select every vertex",
        lambda window: window.document.selection.everything(),
        ("Ctrl+A",),
        has_mesh,
        menu="Select",
    ),
    Action(
        "select.none",
        "Select nothing",
        "Empty the selection",
        lambda window: window.document.selection.clear(),
        ("Ctrl+Shift+A",),
        has_selection,
        menu="Select",
        needs="Nothing is selected.",
    ),
    Action(
        "select.invert",
        "Invert the selection",
        "Select the vertices that are not selected",
        lambda window: window.document.selection.invert(),
        ("Ctrl+I",),
        has_mesh,
        menu="Select",
    ),
    Action(
        "select.grow",
        "Grow the selection",
        "Select the elements around it too",
        lambda window: window.document.selection.grow(),
        (">",),
        has_selection,
        menu="Select",
        needs="Nothing is selected.",
    ),
    Action(
        "select.shrink",
        "Shrink the selection",
        "Take out the vertices at its rim",
        lambda window: window.document.selection.shrink(),
        ("<",),
        has_selection,
        menu="Select",
        needs="Nothing is selected.",
    ),
    Action(
        "select.irregular",
        "Select irregular vertices",
        "Select every vertex whose degree is not the desired one",
        lambda window: window.document.selection.irregular(),
        ("Ctrl+Shift+I",),
        has_mesh,
        menu="Select",
    ),
    *(
        Action(
            f"select.degree_{degree}",
            f"Select degree {degree}",
            f"Select every vertex with {degree} edges",
            partial(_of_degree, degree),
            (),
            has_mesh,
            menu="Select",
        )
        for degree in DEGREES
    ),
)
