"""Actions of the menu Blocks: the view of blocks, its chord tools, and the export of grids."""

from __future__ import annotations

from functools import partial

from meshwright.desktop.actions.action import Action, has_quads, needing
from meshwright.desktop.actions.context import ActionContext
from meshwright.desktop.blocks.chord_tools import NUDGE
from meshwright_core.operations.catalogue import Operation


@needing("Needs a quad mesh; a level's mesh has no grid.")
def has_blocks(context: ActionContext) -> bool:
    """There is a quad mesh, and no level is played."""
    return has_quads(context) and context.levels.level is None


@needing("Needs a chord selected in the Blocks view.")
def has_chord(context: ActionContext) -> bool:
    """A chord is selected in the Blocks view."""
    return has_blocks(context) and context.blocks.shown and context.blocks.chord >= 0


def _tool(name: str, title: str, words: str, keys: str, run: object) -> Action:
    shortcuts = (keys,) if keys else ()
    return Action(
        f"blocks.{name}",
        title,
        words,
        run=run,  # type: ignore[arg-type]
        shortcuts=shortcuts,
        enabled=has_chord,
        menu="Blocks",
    )


def _next(step: int, context: ActionContext) -> None:
    context.blocks.next_chord(step)


def _more(step: int, context: ActionContext) -> None:
    context.blocks.tools.add_cells(step)


def _slide(share: float, context: ActionContext) -> None:
    context.blocks.tools.nudge(share)


def _apply(operation: Operation, context: ActionContext) -> None:
    context.blocks.tools.apply(operation)


ACTIONS: tuple[Action, ...] = (
    Action(
        "blocks.view",
        "Blocks view",
        "Show blocks with their chords in colours, numbers of cells, and the fine grid",
        run=lambda context: context.blocks.toggle(),
        shortcuts=("Ctrl+Shift+B",),
        enabled=has_blocks,
        menu="Blocks",
        icon="blocks",
        word="Blocks",
        checked=lambda context: context.blocks.shown,
    ),
    Action(
        "blocks.next",
        "Next chord",
        "Select the next chord",
        run=partial(_next, 1),
        shortcuts=("Ctrl+]",),
        enabled=has_blocks,
        menu="Blocks",
    ),
    Action(
        "blocks.previous",
        "Previous chord",
        "Select the previous chord",
        run=partial(_next, -1),
        shortcuts=("Ctrl+[",),
        enabled=has_blocks,
        menu="Blocks",
    ),
    _tool(
        "count", "Number of cells\u2026", "Set the number of cells across the selected chord",
        "Ctrl+D", lambda context: context.blocks.tools.focus_count(),
    ),
    _tool(
        "more", "One cell more", "Add a cell across the selected chord", "Ctrl+Up",
        partial(_more, 1),
    ),
    _tool(
        "fewer", "One cell fewer", "Remove a cell across the selected chord", "Ctrl+Down",
        partial(_more, -1),
    ),
    _tool(
        "free", "Cells by size", "Let size and evenness decide the number of cells again",
        "Ctrl+Shift+D", lambda context: context.blocks.tools.set_count(None),
    ),
    _tool(
        "grading", "Grade chord\u2026", "Set lengths of the first and the last cell, and growth",
        "Ctrl+Alt+G", lambda context: context.blocks.tools.focus_grading(),
    ),
    _tool(
        "even", "Even cells", "Remove the grading of the selected chord", "",
        lambda context: context.blocks.tools.set_grading(None),
    ),
    _tool(
        "insert", "Insert chord (global split)", "Open the selected edge into a block, and carry "
        "the cut both ways to the boundary", "Ctrl+Shift+G",
        partial(_apply, Operation.GLOBAL_SPLIT),
    ),
    _tool(
        "ring", "Insert ring", "Put a layer of blocks along the boundary loop, or the closed "
        "interface, of the selected edge", "Ctrl+Shift+R", partial(_apply, Operation.INSERT_RING),
    ),
    _tool(
        "divide", "Divide chord", "Cut the selected strip of blocks in two along its length",
        "Ctrl+Shift+Y", partial(_apply, Operation.DIVIDE_CHORD),
    ),
    _tool(
        "collapse", "Collapse chord", "Remove the selected strip of blocks", "Ctrl+Shift+V",
        partial(_apply, Operation.CHORD_COLLAPSE),
    ),
    _tool(
        "slide_left", "Slide line left", "Move the line through the selected edge to its left",
        "Ctrl+Left", partial(_slide, NUDGE),
    ),
    _tool(
        "slide_right", "Slide line right", "Move the line through the selected edge to its right",
        "Ctrl+Right", partial(_slide, -NUDGE),
    ),
    _tool(
        "straighten", "Straighten line", "Make the line through the selected edge straight",
        "Ctrl+Shift+T", lambda context: context.blocks.tools.straighten(),
    ),
    Action(
        "blocks.export",
        "Export blocks\u2026",
        "Write a block-structured grid for a solver: sizes, layers at walls, format",
        run=lambda context: context.block_export.ask(),
        shortcuts=("Ctrl+Shift+E",),
        enabled=has_blocks,
        menu="File",
    ),
)  # fmt: skip
