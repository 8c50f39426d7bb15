"""Actions of the menu Mesh: the catalogue's operations, and edits of the whole mesh."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action, has_mesh, has_quads
from meshwright_core.errors import capitalised
from meshwright_core.operations.catalogue import CATALOGUE, OperationInfo


def operation_id(info: OperationInfo) -> str:
    """The id of the action that applies an operation to the half-edge under the mouse."""
    return f"{info.kind}.{info.operation.value}"


def _operation(info: OperationInfo) -> Action:
    return Action(
        id=operation_id(info),
        title=info.title,
        tooltip=capitalised(info.summary),
        run=lambda context: context.editing.operate(info.operation),
        shortcuts=(info.key.upper(),),
        enabled=lambda context: context.document.kind == info.kind,
        menu="Mesh",
        kind=info.kind,
        needs=f"Needs a {'quad' if info.kind == 'quad' else 'triangle'} mesh.",
    )


ACTIONS: tuple[Action, ...] = (
    *(_operation(info) for info in CATALOGUE),
    Action(
        "clean_all",
        "Clean all",
        "Remove every global line that can be removed",
        run=lambda context: context.editing.clean_all(),
        shortcuts=("Ctrl+L",),
        enabled=has_quads,
        menu="Mesh",
        icon="clean",
        word="Clean all",
    ),
    Action(
        "smooth",
        "Smooth",
        "Smooth and untangle the whole mesh; corners are fixed",
        run=lambda context: context.editing.smooth(),
        shortcuts=("Ctrl+M",),
        enabled=has_mesh,
        menu="Mesh",
        icon="smooth",
        word="Smooth",
    ),
    Action(
        "smooth_here",
        "Smooth the selection",
        "Smooth and untangle the selected vertices; all others are fixed",
        run=lambda context: context.editing.smooth_here(),
        shortcuts=("Ctrl+Shift+M",),
        enabled=lambda context: len(context.document.selection) > 0,
        menu="Mesh",
        needs="Nothing is selected.",
    ),
    Action(
        "untangle",
        "Untangle",
        "Repair inverted elements; only vertices near them move",
        run=lambda context: context.editing.untangle(),
        shortcuts=("Ctrl+U",),
        enabled=has_mesh,
        menu="Mesh",
    ),
)
