"""Connects the assistant with the browsers: policies on offer, commands, state messages."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.assistant.assistant import FASTEST, Assistant
from meshwright.assistant.outcome import shape_wanted
from meshwright.assistant.policy_catalogue import kind_of, label, shipped
from meshwright.assistant.search_runner import Effort
from meshwright.document.document import NO_MESH, Document, title_of
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.notebook.thread_loop import ThreadLoop
from meshwright.sources.naming import looks_like_path
from meshwright_core import MeshError
from meshwright_core.core.kinds import KIND_NOUN

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import PolicyAction


class AgentBridge:
    """The assistant of one document, and the policies that it may use."""

    def __init__(self, document: Document, assistant: Assistant, loop: ThreadLoop) -> None:
        self._document, self.assistant, self._loop = document, assistant, loop
        self._shipped: dict[str, list[str]] = {}
        self._files: dict[str, str] = {}  # paths of policies chosen by the user, and their kinds

    # Policies

    @property
    def policies(self) -> list[str]:
        """Names on offer for the present mesh: shipped policies, and files chosen before."""
        kind = self._document.kind
        if not kind:
            return []
        if kind not in self._shipped:
            self._shipped[kind] = shipped(kind)
        return self._shipped[kind] + [name for name, its in self._files.items() if its == kind]

    def choose(self, name: str) -> None:
        """Use another policy; MeshError where it does not exist or does not fit the mesh."""
        if name in self.policies:
            self.assistant.policy = name
            return
        kind = self._document.kind
        if not kind:
            raise MeshError(NO_MESH)
        if looks_like_path(name):
            self._add(name)
            self.assistant.policy = name
            return
        other = "tri" if kind == "quad" else "quad"
        if name in shipped(other):
            raise MeshError(_other_kind(name, other, kind))
        known = ", ".join(self.policies) or "none"
        raise MeshError(f"There is no policy '{name}' for {KIND_NOUN[kind]}; there is: {known}.")

    def _add(self, name: str) -> None:
        try:
            kind = kind_of(name)
        except (ValueError, OSError) as error:
            raise MeshError(str(error)) from error
        if kind != self._document.kind:
            raise MeshError(_other_kind(Path(name).name, kind, self._document.kind))
        self._files[name] = kind

    def settle(self) -> None:
        """Choose the first policy on offer where the present one does not fit the mesh."""
        on_offer = self.policies
        if self.assistant.policy not in on_offer:
            self.assistant.policy = on_offer[0] if on_offer else ""

    # Commands

    @property
    def idle(self) -> bool:
        """Whether nothing is running, loading or computing hints."""
        assistant = self.assistant
        return not (assistant.running or assistant.loading or assistant.hinting.asking)

    def act(self, action: str, prefer: str = "balanced", keep_size: bool = False) -> None:
        """Carry out the ``action`` of a request ``agent``; the others are those of
        :class:`meshwright.assistant.search_runner.Effort`.
        """
        assistant = self.assistant
        if action == "complete":
            assistant.search(Effort(prefer=prefer, keep_size=keep_size, until_done=True))
        else:
            getattr(assistant, action)()

    def play(self, speed: float | None = None, hurry: bool = False) -> None:
        """Play at ``speed`` decisions per second, by default the last one; ``hurry``: no limit."""
        if speed is not None:
            self.assistant.speed = speed
        self.assistant.play(hurry)

    def take(self, index: int) -> None:
        """Apply a hint; MeshError where there is no such hint."""
        hints = self.assistant.hinting.hints
        if index >= len(hints):
            raise MeshError("That hint is out of date: the mesh has changed.")
        self._document.submit(hints[index].operation, hints[index].halfedge)

    # Messages

    def packet(self) -> Packet:
        """The message with the agent's state."""
        assistant = self.assistant
        hints = assistant.hinting.hints
        return Packet(
            {
                "type": "agent",
                "state": str(assistant.state),
                "loading": assistant.loading,
                "asking": assistant.hinting.asking,
                "policy": assistant.policy,
                "policies": [{"name": name, "label": label(name)} for name in self.policies],
                "speed": min(assistant.speed, FASTEST),
                "progress": self._progress(),
                "outcome": assistant.outcome,
                "unfinished": assistant.unfinished,
                "hints": [self._hint(choice) for choice in hints],
            }
        )

    def _progress(self) -> dict[str, Any]:
        progress = self.assistant.progress
        return {
            "decisions": progress.decisions,
            "rollouts": progress.rollouts,
            "best": progress.best,
            "gap": progress.gap,
            "shape": shape_wanted(progress.shape) if progress.shape else "",
            "way": list(progress.way) if progress.way else None,
            "share": progress.share,
            "seconds": round(progress.elapsed, 2),
        }

    def _hint(self, choice: PolicyAction) -> dict[str, Any]:
        return {
            "operation": str(choice.operation),
            "title": title_of(choice.operation, self._document.kind),
            "halfedge": choice.halfedge,
            "probability": round(choice.probability, 4),
            "change": choice.change,
            "next": choice is self.assistant.hinting.next_step,
        }


def _other_kind(name: str, kind: str, here: str) -> str:
    return f"{name} is a policy for {KIND_NOUN[kind]}; this is a mesh of {KIND_NOUN[here]}."
