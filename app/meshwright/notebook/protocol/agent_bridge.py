"""The agent beside a notebook's reader: which policies there are, and what browsers hear of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshwright.assistant.assistant import FASTEST, Assistant
from meshwright.assistant.policy_catalogue import kind_of, label, shipped
from meshwright.assistant.search_runner import Effort
from meshwright.document.document import NO_MESH, Document, title_of
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.notebook.thread_loop import Loop
from meshwright.sources.naming import looks_like_path
from meshwright_core import MeshError
from meshwright_core.core.kinds import KIND_NOUN

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import PolicyAction


class Helper:
    """One assistant and the policies that it may follow on one document."""

    def __init__(self, document: Document, assistant: Assistant, loop: Loop) -> None:
        self._document, self.assistant, self._loop = document, assistant, loop
        self._shipped: dict[str, list[str]] = {}
        self._files: dict[str, str] = {}  # policies that were given, and their kinds

    # Policies

    @property
    def policies(self) -> list[str]:
        """Those on offer for the mesh that is here: shipped ones, and files that were given."""
        kind = self._document.kind
        if not kind:
            return []
        if kind not in self._shipped:
            self._shipped[kind] = shipped(kind)
        return self._shipped[kind] + [name for name, its in self._files.items() if its == kind]

    def choose(self, name: str) -> None:
        """Follow another policy; MeshError with one sentence where that cannot be."""
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
        """Follow the first policy on offer where none that fits this mesh is chosen."""
        on_offer = self.policies
        if self.assistant.policy not in on_offer:
            self.assistant.policy = on_offer[0] if on_offer else ""

    # What it is asked to do

    @property
    def idle(self) -> bool:
        """Whether nothing runs, is being loaded or is asked."""
        assistant = self.assistant
        return not (assistant.running or assistant.loading or assistant.hinting.asking)

    def act(self, action: str) -> None:
        """One of the words of a message ``agent``."""
        assistant = self.assistant
        if action == "complete":
            assistant.search(Effort())
        else:
            getattr(assistant, action)()

    def play(self, speed: float | None = None, hurry: bool = False) -> None:
        """Play, at another speed from now on if one is given; in a hurry without a limit."""
        if speed is not None:
            self.assistant.speed = speed
        self.assistant.play(hurry)

    def take(self, index: int) -> None:
        """Do what a hint says; MeshError where there is no such hint."""
        hints = self.assistant.hinting.hints
        if index >= len(hints):
            raise MeshError("That hint is of a state that has gone.")
        self._document.submit(hints[index].operation, hints[index].halfedge)

    # What is told of it

    def packet(self) -> Packet:
        """The agent's state for the browser."""
        assistant = self.assistant
        hints = assistant.hinting.hints
        return Packet(
            {
                "say": "agent",
                "state": str(assistant.state),
                "loading": assistant.loading,
                "asking": assistant.hinting.asking,
                "policy": assistant.policy,
                "policies": [{"name": name, "label": label(name)} for name in self.policies],
                "speed": min(assistant.speed, FASTEST),
                "progress": self._progress(),
                "hints": [self._hint(choice) for choice in hints],
            }
        )

    def _progress(self) -> dict[str, Any]:
        progress = self.assistant.progress
        return {
            "decisions": progress.decisions,
            "rollouts": progress.rollouts,
            "best": progress.best,
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
        }


def _other_kind(name: str, kind: str, here: str) -> str:
    return f"{name} is a policy for {KIND_NOUN[kind]}; this is a mesh of {KIND_NOUN[here]}."
