"""One thing that a person can do, as a row of the table in
:mod:`meshwright.desktop.actions.registry`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from qtpy.QtGui import QKeySequence

from meshwright.assistant.assistant import State

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow

When = Callable[["MainWindow"], bool]
Run = Callable[["MainWindow"], None]


@dataclass(frozen=True)
class Action:
    """``enabled`` says whether it makes sense now, ``run`` does it.

    ``menu`` is the menu that lists it; ``icon`` its icon in the toolbar, empty for none there;
    ``word`` is written beside the icon. One with ``checked`` is a switch that is on or off.
    ``repeats`` says that a key held down does it again and again. ``needs`` tells, as a sentence,
    what is missing while it is not enabled; the conditions below have their own. The keys of one
    ``on_canvas`` work while the canvas has the keyboard: elsewhere they mean other things.
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
    on_canvas: bool = False


def needing(words: str) -> Callable[[When], When]:
    """A decorator for a condition: what is missing while it does not hold, as a sentence."""

    def mark(condition: When) -> When:
        condition.needs = words  # type: ignore[attr-defined]
        return condition

    return mark


def tooltip(action: Action) -> str:
    """What the action does, and its first key."""
    if not action.shortcuts:
        return action.tooltip
    return f"{action.tooltip}  ({key_text(action.shortcuts[0])})"


def key_text(keys: str) -> str:
    """Keys as this platform writes them."""
    return str(QKeySequence(keys).toString(QKeySequence.SequenceFormat.NativeText))


@needing("Needs a mesh.")
def has_mesh(window: MainWindow) -> bool:
    """There is a mesh."""
    return not window.document.empty


@needing("Needs a quad mesh.")
def has_quads(window: MainWindow) -> bool:
    """There is a quad mesh."""
    return window.document.kind == "quad"


@needing("Needs a mesh, and an agent that is ready.")
def can_run(window: MainWindow) -> bool:
    """The agent could begin a run."""
    return has_mesh(window) and window.agent_ready and bool(window.assistant.policy)


@needing("Nothing is running.")
def is_active(window: MainWindow) -> bool:
    """A run is under way, or held."""
    return window.assistant.running or window.assistant.state is State.PAUSED


def needs(action: Action) -> str:
    """What is missing while ``action`` is not enabled, as a sentence."""
    return action.needs or getattr(action.enabled, "needs", "") or "Not possible now."
