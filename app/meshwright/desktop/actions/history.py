"""Actions of the menu History: navigation, playback, branches and export."""

from __future__ import annotations

from meshwright.desktop.actions.action import Action, has_mesh, needing
from meshwright.desktop.actions.context import ActionContext


@needing("This is the start of the history.")
def _can_go_back(context: ActionContext) -> bool:
    return context.readiness.editing and context.document.can_undo


@needing("This is the end of the history.")
def _can_go_on(context: ActionContext) -> bool:
    return context.readiness.editing and context.document.can_redo


@needing("The history is empty.")
def _has_steps(context: ActionContext) -> bool:
    return context.readiness.editing and len(context.document.history) > 0


@needing("The history has no branches.")
def _has_branches(context: ActionContext) -> bool:
    return context.readiness.editing and len(context.document.history.branches) > 0


ACTIONS: tuple[Action, ...] = (
    Action(
        "history.play",
        "Play or pause the history",
        "Play the recorded steps from here, or from the start if this is the end; or pause",
        run=lambda context: context.playback.play_or_hold(),
        shortcuts=("Shift+Space",),
        enabled=_has_steps,
        menu="History",
        repeats=False,
    ),
    Action(
        "history.back",
        "One step back",
        "Show the state before the last step",
        run=lambda context: context.playback.walk(-1),
        shortcuts=("Alt+Left", "["),
        enabled=_can_go_back,
        menu="History",
    ),
    Action(
        "history.forward",
        "One step forward",
        "Show the state after the next step",
        run=lambda context: context.playback.walk(1),
        shortcuts=("Alt+Right", "]"),
        enabled=_can_go_on,
        menu="History",
    ),
    Action(
        "history.first",
        "To the start",
        "Show the mesh as it was before the first step",
        run=lambda context: context.playback.go_to(0),
        shortcuts=("Alt+Home",),
        enabled=_can_go_back,
        menu="History",
    ),
    Action(
        "history.last",
        "To the end",
        "Show the mesh after the last step",
        run=lambda context: context.playback.go_to(len(context.document.history)),
        shortcuts=("Alt+End",),
        enabled=_can_go_on,
        menu="History",
    ),
    Action(
        "history.best",
        "To the best state",
        "Show the first state with the lowest score",
        run=lambda context: context.playback.go_to_best(),
        shortcuts=("Alt+Up",),
        enabled=_has_steps,
        menu="History",
    ),
    Action(
        "history.branch",
        "To the last branch",
        "Switch to the branch that was left last; the current steps become a branch",
        run=lambda context: context.playback.take_last_branch(),
        shortcuts=("Alt+Down",),
        enabled=_has_branches,
        menu="History",
        repeats=False,
    ),
    Action(
        "history.export",
        "Export video or image\u2026",
        "Export the history as a video (GIF, MP4), or this state as an image (PNG, SVG)",
        run=lambda context: context.playback.export(),
        shortcuts=("Ctrl+E",),
        enabled=has_mesh,
        menu="History",
        repeats=False,
    ),
    Action(
        "history.list",
        "History list",
        "Show or hide the list of all steps",
        run=lambda context: context.playback.show_list(not context.playback.lists),
        shortcuts=("F3",),
        menu="History",
        checked=lambda context: context.playback.lists,
        repeats=False,
    ),
    Action(
        "history.timeline",
        "Timeline",
        "Show or hide the score curve below the mesh",
        run=lambda context: context.playback.show_timeline(not context.playback.times),
        shortcuts=("F4",),
        menu="History",
        checked=lambda context: context.playback.times,
        repeats=False,
    ),
)
