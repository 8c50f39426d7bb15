"""The film: walking through the history, and exporting it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshwright.desktop.actions.action import Action, has_mesh, needing

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


@needing("This is the start.")
def _can_go_back(window: MainWindow) -> bool:
    return window.ready and window.document.can_undo


@needing("This is the end.")
def _can_go_on(window: MainWindow) -> bool:
    return window.ready and window.document.can_redo


@needing("There are no steps yet.")
def _has_steps(window: MainWindow) -> bool:
    return window.ready and len(window.document.history) > 0


@needing("There is no branch.")
def _has_branches(window: MainWindow) -> bool:
    return window.ready and len(window.document.history.branches) > 0


ACTIONS: tuple[Action, ...] = (
    Action(
        "history.play",
        "Play or hold the film",
        "Play the recorded steps from here, from the start if this is the end; or hold",
        lambda window: window.film.play_or_hold(),
        ("Shift+Space",),
        _has_steps,
        menu="History",
        repeats=False,
    ),
    Action(
        "history.back",
        "One step back",
        "Show the state before the last step",
        lambda window: window.film.walk(-1),
        ("Alt+Left", "["),
        _can_go_back,
        menu="History",
    ),
    Action(
        "history.forward",
        "One step forward",
        "Show the state after the next step",
        lambda window: window.film.walk(1),
        ("Alt+Right", "]"),
        _can_go_on,
        menu="History",
    ),
    Action(
        "history.first",
        "To the start",
        "Show the mesh as it was before the first step",
        lambda window: window.film.go_to(0),
        ("Alt+Home",),
        _can_go_back,
        menu="History",
    ),
    Action(
        "history.last",
        "To the end",
        "Show the mesh after the last step",
        lambda window: window.film.go_to(len(window.document.history)),
        ("Alt+End",),
        _can_go_on,
        menu="History",
    ),
    Action(
        "history.best",
        "To the best state",
        "Show the first state with the lowest score",
        lambda window: window.film.go_to_best(),
        ("Alt+Up",),
        _has_steps,
        menu="History",
    ),
    Action(
        "history.branch",
        "To the branch left last",
        "Take the steps up again that were left last; the present ones become a branch",
        lambda window: window.film.take_last_branch(),
        ("Alt+Down",),
        _has_branches,
        menu="History",
        repeats=False,
    ),
    Action(
        "history.export",
        "Export film or picture\u2026",
        "Write the history as a film (GIF, MP4), or this state as a picture (PNG, SVG)",
        lambda window: window.film.export(),
        ("Ctrl+E",),
        has_mesh,
        menu="History",
        repeats=False,
    ),
    Action(
        "history.list",
        "History list",
        "Show or hide the list of all steps",
        lambda window: window.film.show_list(not window.film.lists),
        ("F3",),
        menu="History",
        checked=lambda window: window.film.lists,
        repeats=False,
    ),
    Action(
        "history.timeline",
        "Timeline",
        "Show or hide the score curve below the mesh",
        lambda window: window.film.show_timeline(not window.film.times),
        ("F4",),
        menu="History",
        checked=lambda window: window.film.times,
        repeats=False,
    ),
)
