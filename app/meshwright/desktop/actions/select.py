"""Actions of the menu Select: the selection, and the mouse tools."""

from __future__ import annotations

from functools import partial

from meshwright.desktop.actions.action import Action, has_mesh
from meshwright.desktop.actions.context import ActionContext
from meshwright.desktop.editing.selection_controller import BOX, EDIT, LASSO

DEGREES = range(2, 9)
"""Degrees with a command that selects their vertices."""


def has_selection(context: ActionContext) -> bool:
    """Some vertex is selected."""
    return len(context.document.selection) > 0


def _use(tool: str, context: ActionContext) -> None:
    context.selection_tools.use(tool)


def _uses(tool: str, context: ActionContext) -> bool:
    return context.selection_tools.tool == tool


def _of_degree(degree: int, context: ActionContext) -> None:
    context.document.selection.of_degree(degree)


def _tool(tool: str, title: str, tooltip: str, keys: str) -> Action:
    return Action(
        f"tool.{tool}",
        title,
        tooltip,
        run=partial(_use, tool),
        shortcuts=(keys,),
        enabled=has_mesh,
        menu="Select",
        icon=tool,
        checked=partial(_uses, tool),
    )


ACTIONS: tuple[Action, ...] = (
    _tool(EDIT, "Edit", "Click half-edges, drag vertices; drag anywhere else to pan", "A"),
    _tool(BOX, "Select by box", "Drag a box around vertices; Shift+drag in any tool", "B"),
    _tool(LASSO, "Select by lasso", "Draw around vertices; Shift+Alt+drag in any tool", "Shift+B"),
    Action(
        "select.all",
        "Select all",
        "Select every vertex",
        run=lambda context: context.document.selection.everything(),
        shortcuts=("Ctrl+A",),
        enabled=has_mesh,
        menu="Select",
    ),
    Action(
        "select.none",
        "Clear selection",
        "Deselect all vertices",
        run=lambda context: context.document.selection.clear(),
        shortcuts=("Ctrl+Shift+A",),
        enabled=has_selection,
        menu="Select",
        needs="Nothing is selected.",
    ),
    Action(
        "select.invert",
        "Invert selection",
        "Select the vertices that are not selected",
        run=lambda context: context.document.selection.invert(),
        shortcuts=("Ctrl+I",),
        enabled=has_mesh,
        menu="Select",
    ),
    Action(
        "select.grow",
        "Grow selection",
        "Add the neighbouring elements",
        run=lambda context: context.document.selection.grow(),
        shortcuts=(">",),
        enabled=has_selection,
        menu="Select",
        needs="Nothing is selected.",
    ),
    Action(
        "select.shrink",
        "Shrink selection",
        "Remove the vertices at its border",
        run=lambda context: context.document.selection.shrink(),
        shortcuts=("<",),
        enabled=has_selection,
        menu="Select",
        needs="Nothing is selected.",
    ),
    Action(
        "select.irregular",
        "Select irregular vertices",
        "Select every vertex whose degree is not the desired one",
        run=lambda context: context.document.selection.irregular(),
        shortcuts=("Ctrl+Shift+I",),
        enabled=has_mesh,
        menu="Select",
    ),
    *(
        Action(
            f"select.degree_{degree}",
            f"Select degree {degree}",
            f"Select every vertex with {degree} edges",
            run=partial(_of_degree, degree),
            enabled=has_mesh,
            menu="Select",
        )
        for degree in DEGREES
    ),
)
