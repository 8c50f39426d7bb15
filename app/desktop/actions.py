"""All that a person can do, in one table that menus, toolbar, shortcuts and help read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from qtpy.QtCore import QObject
from qtpy.QtGui import QAction, QKeySequence

from app.assistant import State
from app.desktop import icons
from app.searching import COMPLETE_SECONDS, Effort
from app.theme import Theme
from meshcore.operations import CATALOGUE, OperationInfo

if TYPE_CHECKING:
    from app.desktop.window import MainWindow

When = Callable[["MainWindow"], bool]
Run = Callable[["MainWindow"], None]

BEST_OF = 10
"""Rollouts of *Best of*, as in the paper's tables."""
SEARCHES = ((10, ("Ctrl+Shift+Return",)), (60, ()))
"""Seconds of the searches on offer, and their keys."""


@dataclass(frozen=True)
class Action:
    """One thing to do: ``enabled`` says whether it makes sense now, ``run`` does it.

    ``menu`` is the menu that lists it; ``icon`` its icon in the toolbar, empty for none there;
    ``word`` is written beside the icon.
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


def _has_mesh(window: MainWindow) -> bool:
    return not window.document.empty


def _has_quads(window: MainWindow) -> bool:
    return window.document.kind == "quad"


def _can_run(window: MainWindow) -> bool:
    return _has_mesh(window) and window.agent_ready and bool(window.assistant.policy)


def _is_active(window: MainWindow) -> bool:
    return window.assistant.running or window.assistant.state is State.PAUSED


def _search_for(seconds: float, window: MainWindow) -> None:
    window.assistant.search(Effort(seconds=seconds))


def _operation(info: OperationInfo) -> Action:
    return Action(
        id=operation_id(info),
        title=info.title,
        tooltip=info.summary,
        run=lambda window: window.operate(info.operation),
        shortcuts=(info.key.upper(),),
        enabled=lambda window: window.document.kind == info.kind,
        menu="Mesh",
    )


def operation_id(info: OperationInfo) -> str:
    """The id of the action that does an operation on the half-edge under the mouse."""
    return f"{info.kind}.{info.operation.value}"


ACTIONS: tuple[Action, ...] = (
    Action(
        "new",
        "New from shape\u2026",
        "Make a mesh of a shape from the gallery",
        lambda window: window.choose_shape(),
        ("Ctrl+N",),
        menu="File",
        icon="new",
    ),
    Action(
        "open",
        "Open\u2026",
        "Open a mesh file",
        lambda window: window.choose_file(),
        ("Ctrl+O",),
        menu="File",
        icon="open",
    ),
    Action(
        "save",
        "Save",
        "Write the mesh to its file",
        lambda window: window.save(),
        ("Ctrl+S",),
        _has_mesh,
        menu="File",
        icon="save",
    ),
    Action(
        "save_as",
        "Save as\u2026",
        "Write the mesh to another file",
        lambda window: window.save_as(),
        ("Ctrl+Shift+S",),
        _has_mesh,
        menu="File",
    ),
    Action(
        "quit",
        "Quit",
        "Close the window",
        lambda window: window.close() and None,
        ("Ctrl+Q",),
        menu="File",
    ),
    Action(
        "undo",
        "Undo",
        "Take back the last step",
        lambda window: window.undo(),
        ("Ctrl+Z",),
        lambda window: window.document.can_undo,
        menu="Edit",
        icon="undo",
    ),
    Action(
        "redo",
        "Redo",
        "Do again what was taken back",
        lambda window: window.redo(),
        ("Ctrl+Shift+Z", "Ctrl+Y"),
        lambda window: window.document.can_redo,
        menu="Edit",
        icon="redo",
    ),
    *(_operation(info) for info in CATALOGUE),
    Action(
        "clean_all",
        "Clean all",
        "Remove every global line that can be removed",
        lambda window: window.clean_all(),
        ("Ctrl+L",),
        _has_quads,
        menu="Mesh",
        icon="clean",
        word="Clean all",
    ),
    Action(
        "smooth",
        "Smooth",
        "Smooth and untangle the whole mesh; corners stay",
        lambda window: window.smooth(),
        ("Ctrl+M",),
        _has_mesh,
        menu="Mesh",
        icon="smooth",
        word="Smooth",
    ),
    Action(
        "fit",
        "Fit",
        "Show the whole mesh",
        lambda window: window.canvas.fit(),
        ("Home", "Ctrl+0"),
        _has_mesh,
        menu="View",
        icon="fit",
        word="Fit",
    ),
    Action(
        "theme",
        "Light or dark",
        "Switch between the light and the dark theme",
        lambda window: window.toggle_theme(),
        ("Ctrl+T",),
        menu="View",
        icon="theme",
    ),
    Action(
        "agent.step",
        "Step",
        "Let the policy take one operation",
        lambda window: window.assistant.step(),
        (".",),
        _can_run,
        menu="Agent",
    ),
    Action(
        "agent.play",
        "Play or pause",
        "Let the policy go on at the chosen speed, or hold it",
        lambda window: window.play_or_pause(),
        ("Space",),
        _can_run,
        menu="Agent",
    ),
    Action(
        "agent.complete",
        "Complete",
        f"Search for up to {COMPLETE_SECONDS:g} seconds, and go to the best state found",
        lambda window: window.assistant.search(),
        ("Ctrl+Return",),
        _can_run,
        menu="Agent",
    ),
    Action(
        "agent.best_of",
        f"Best of {BEST_OF}",
        f"Run the policy {BEST_OF} times, and go to the best state found",
        lambda window: window.assistant.search(Effort(rollouts=BEST_OF, seconds=None)),
        ("Ctrl+B",),
        _can_run,
        menu="Agent",
    ),
    *(
        Action(
            f"agent.search_{seconds}",
            f"Search for {seconds} seconds",
            "Search that long for the optimum, then for fewer elements and operations",
            partial(_search_for, seconds),
            keys,
            _can_run,
            menu="Agent",
        )
        for seconds, keys in SEARCHES
    ),
    Action(
        "agent.stop",
        "Stop",
        "Stop the policy; what it has done stays. A search still goes to the best it has found",
        lambda window: window.assistant.stop(),
        ("Esc",),
        _is_active,
        menu="Agent",
    ),
    Action(
        "help",
        "Keys and mouse",
        "All keys, and what the mouse does",
        lambda window: window.show_keys(),
        ("F1",),
        menu="Help",
        icon="help",
    ),
    Action(
        "about",
        "About Meshwright",
        "Version and licences",
        lambda window: window.show_about(),
        menu="Help",
    ),
)

MENUS = ("File", "Edit", "Mesh", "View", "Agent", "Help")
TOOLBAR = (
    ("new", "open", "save"),
    ("undo", "redo"),
    ("clean_all", "smooth", "fit"),
    (),  # what follows stands at the right
    ("theme", "help"),
)


class ActionSet(QObject):
    """The table's actions as Qt's, by id, for one window."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._made: dict[str, QAction] = {}
        for action in ACTIONS:
            self._made[action.id] = self._make(action)
        self.refresh()

    def __getitem__(self, action_id: str) -> QAction:
        return self._made[action_id]

    def refresh(self) -> None:
        """Enable what makes sense now."""
        for action in ACTIONS:
            self._made[action.id].setEnabled(action.enabled(self._window))

    def set_theme(self, theme: Theme) -> None:
        """Draw the icons again."""
        for action in ACTIONS:
            if action.icon:
                self._made[action.id].setIcon(icons.icon(action.icon, theme))

    def _make(self, action: Action) -> QAction:
        made = QAction(action.title, self._window)
        made.setIconText(f" {action.word}" if action.word else action.title.rstrip("\u2026"))
        made.setShortcuts([QKeySequence(keys) for keys in action.shortcuts])
        made.setToolTip(tooltip(action))
        made.setIconVisibleInMenu(False)
        made.triggered.connect(lambda checked=False: action.run(self._window))
        self._window.addAction(made)
        return made


def tooltip(action: Action) -> str:
    """What the action does, and its first key."""
    if not action.shortcuts:
        return action.tooltip
    return f"{action.tooltip}  ({key_text(action.shortcuts[0])})"


def key_text(keys: str) -> str:
    """Keys as this platform writes them."""
    return str(QKeySequence(keys).toString(QKeySequence.SequenceFormat.NativeText))


def groups(window: MainWindow) -> list[tuple[str, list[Action]]]:
    """Menus with the actions that this window's kind of mesh can use, in the table's order."""
    kind = window.document.kind or "quad"
    foreign = {operation_id(info) for info in CATALOGUE if info.kind != kind}
    return [
        (menu, [a for a in ACTIONS if a.menu == menu and a.id not in foreign]) for menu in MENUS
    ]
