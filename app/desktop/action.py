"""One thing that a person can do, as a row of the table in :mod:`app.desktop.actions`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from qtpy.QtGui import QKeySequence

from app.assistant import State

if TYPE_CHECKING:
    from app.desktop.window import MainWindow

When = Callable[["MainWindow"], bool]
Run = Callable[["MainWindow"], None]


@dataclass(frozen=True)
class Action:
    """``enabled`` says whether it makes sense now, ``run`` does it.

    ``menu`` is the menu that lists it; ``icon`` its icon in the toolbar, empty for none there;
    ``word`` is written beside the icon. One with ``checked`` is a switch that is on or off.
    ``repeats`` says that a key held down does it again and again. ``needs`` tells, as a sentence,
    what is missing while it is not enabled; the conditions below have their own.
    """

    id: str
    title: str
    tooltip: str
    run: Run
    shortcuts: tuple[str, ...] = ()
    enabled: When = lambda window: True
    menu: str = ""
    icon: str = ""
    word: str = ""
    checked: When | None = None
    repeats: bool = True
    needs: str = ""


def tooltip(action: Action) -> str:
    """What the action does, and its first key."""
    if not action.shortcuts:
        return action.tooltip
    return f"{action.tooltip}  ({key_text(action.shortcuts[0])})"


def key_text(keys: str) -> str:
    """Keys as this platform writes them."""
    return str(QKeySequence(keys).toString(QKeySequence.SequenceFormat.NativeText))


def has_mesh(window: MainWindow) -> bool:
    """There is a mesh."""
    return not window.document.empty


def has_quads(window: MainWindow) -> bool:
    """There is a quad mesh."""
    return window.document.kind == "quad"


def can_run(window: MainWindow) -> bool:
    """The agent could begin a run."""
    return has_mesh(window) and window.agent_ready and bool(window.assistant.policy)


def is_active(window: MainWindow) -> bool:
    """A run is under way, or held."""
    return window.assistant.running or window.assistant.state is State.PAUSED


NEEDS: dict[When, str] = {
    has_mesh: "Needs a mesh.",
    has_quads: "Needs a quad mesh.",
    can_run: "Needs a mesh, and an agent that is ready.",
    is_active: "Nothing is running.",
}


def needs(action: Action) -> str:
    """What is missing while ``action`` is not enabled, as a sentence."""
    return action.needs or NEEDS.get(action.enabled, "") or "Not possible now."
