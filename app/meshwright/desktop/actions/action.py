"""One user action as a row of the tables in this folder, and the conditions that rows share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from meshwright.assistant.assistant import State
from meshwright.desktop.actions.context import ActionContext
from meshwright.desktop.widgets.action_set import ActionEntry

Check = Callable[[ActionContext], bool]
Run = Callable[[ActionContext], object]


@dataclass(frozen=True)
class Condition:
    """A check, with the sentence shown while it fails."""

    check: Check
    needs: str

    def __call__(self, context: ActionContext) -> bool:
        """Whether the condition holds."""
        return self.check(context)


@dataclass(frozen=True, kw_only=True)
class Action(ActionEntry):
    """An action with what it does: ``run``, and when it is possible: ``enabled``.

    An action with ``checked`` is a switch; ``checked`` returns whether it is on.
    """

    run: Run
    enabled: Check = lambda context: True
    checked: Check | None = None

    @property
    def checkable(self) -> bool:
        """Whether the action is a switch."""
        return self.checked is not None

    @property
    def requirement(self) -> str:
        """What is missing while the action is disabled, as a sentence."""
        if not self.needs and isinstance(self.enabled, Condition):
            return self.enabled.needs
        return super().requirement


def needing(sentence: str) -> Callable[[Check], Condition]:
    """Decorates a check with what is missing while it fails."""
    return lambda check: Condition(check, sentence)


@needing("Needs a mesh.")
def has_mesh(context: ActionContext) -> bool:
    """There is a mesh."""
    return not context.document.empty


@needing("Needs a quad mesh.")
def has_quads(context: ActionContext) -> bool:
    """There is a quad mesh."""
    return context.document.kind == "quad"


@needing("Needs a mesh and a policy that is ready: see the panel Agent.")
def can_run(context: ActionContext) -> bool:
    """The agent could start a run."""
    return has_mesh(context) and context.readiness.agent and bool(context.assistant.policy)


@needing("Nothing is running.")
def is_active(context: ActionContext) -> bool:
    """A run is under way, or paused."""
    return context.assistant.running or context.assistant.state is State.PAUSED
