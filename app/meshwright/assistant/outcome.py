"""What is left for a search to do on a mesh, and what a search has come to, in sentences."""

from __future__ import annotations

from meshwright.assistant.run import AgentRun
from meshwright.assistant.search_runner import Effort, ShapeGoal
from meshwright.document.document import Document
from meshwright.document.quality_summary import decimal
from meshwright.document.verdict import gap_words
from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.quality import inverted


def nothing_left(mesh: HalfEdgeMesh, effort: Effort | None) -> str:
    """Why no run is begun on a mesh; empty where it may improve something.

    Decisions of the policy (``effort`` None) and searches in a region end at s*; other searches go
    on until nothing is inverted and the wanted shape is reached, or beyond.
    """
    if mesh.score != mesh.optimum:
        return ""
    if effort is not None and effort.elements is None:
        if effort.beyond or len(inverted(mesh)):
            return ""
        goal = ShapeGoal.of(mesh, effort)
        if goal is not None:
            return _reached(goal) if goal.reached else ""
    return "Already at the optimum: nothing is left to improve."


def shape_wanted(goal: ShapeGoal) -> str:
    """``shape .31 of the .50 wanted``, or, where only the ratio of sides is bad, ``long thin
    elements of shape .02``.
    """
    if goal.corners_reached and not goal.reached:
        return f"long thin elements of shape {decimal(goal.flattest)}"
    return f"shape {decimal(goal.worst)} of the {decimal(goal.aim)} wanted"


def _reached(goal: ShapeGoal) -> str:
    return (
        f"Already at the optimum, and shape {decimal(goal.worst)} is as good as was asked for"
        f" ({decimal(goal.aim)}): nothing is left to improve."
    )


def result_of(
    document: Document, run: AgentRun, counted: str, fine: bool, stopped: bool
) -> tuple[str, bool]:
    """What a search has come to, in a sentence, and whether it may go on.

    Args:
        document: at the result.
        run: the search.
        counted: the number of decisions applied, in words.
        fine: whether the result could be kept.
        stopped: whether the search was ended early.
    """
    effort, mesh = run.effort, document.need_mesh()
    reason = run.runner.reason if run.runner is not None else ""
    if not fine:
        return (
            "The result has inverted elements that were not so before: it was taken back, and"
            " is in the history.",
            True,
        )
    standing = gap_words(document.score, document.optimum, "the optimum")
    left = len(document.history) - document.history.cursor
    if left:
        more = "the next step inverts" if left == 1 else f"the next {left:,} steps invert"
        return f"{standing}: {more} elements, and can be redone.", True
    if document.at_optimum:
        goal = ShapeGoal.of(mesh, effort) if effort is not None else None
        folded = len(inverted(mesh))
        if not folded and (goal is None or goal.reached):
            shape = "" if goal is None else f", shape {decimal(goal.worst)}"
            return f"At the optimum after {counted}{shape}.", False
        wanting = f"{folded:,} inverted" if folded or goal is None else shape_wanted(goal)
        standing = f"at the optimum, but {wanting}"
    if run.held is not None:
        more = f"; {reason}" if reason else ""
        return f"The region is finished: s {document.score}{more}.", False
    if document.score < document.optimum:
        return f"{standing}.", True
    if stopped:
        why = "Stopped"
    elif effort is not None and effort.rollouts:
        why = f"{effort.rollouts} runs are done"
    else:
        why = f"{reason[:1].upper()}{reason[1:]}" if reason else "Time is up"
    return f"{why}, {standing}: go on?", True
