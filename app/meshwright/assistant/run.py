"""Data that the assistant and its worker thread share; no Qt, no torch."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Protocol

import numpy as np

from meshwright.assistant.search_runner import Effort
from meshwright_core import HalfEdgeMesh, Operation

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight, PolicyAction

DecisionStep = list[tuple[Operation, int]]


class State(StrEnum):
    """What the assistant is doing."""

    IDLE = "idle"
    LOOKING = "looking"
    STEPPING = "stepping"
    PLAYING = "playing"
    PAUSED = "paused"
    SEARCHING = "searching"
    GOING = "going"


class RunnerProtocol(Protocol):
    """The part of ``meshwright_agent.policy.rollout.Runner`` that the assistant uses."""

    @property
    def finished(self) -> bool:
        """True once no more decisions follow."""
        ...

    @property
    def reason(self) -> str:
        """Why it is finished, in words; empty before."""
        ...

    def look(self) -> Insight | None:
        """The policy's view of the present state and its next step; None if there is none."""
        ...

    def step(self) -> DecisionStep:
        """The next operation and the clean-ups that follow it; empty when finished."""
        ...


@dataclass
class AgentRun:
    """One run, shared by the document's thread and the worker; ``lock`` guards ``in_step``."""

    state: State
    policy: str
    seed: int
    mesh: HalfEdgeMesh | None
    """The copy for the runner; None once the runner has taken it."""
    speed: float
    """Decisions per second while playing."""
    watch: bool
    """Whether an insight is computed before each decision."""
    runner: RunnerProtocol | None = None
    effort: Effort | None = None
    held: np.ndarray | None = None
    """Vertices that keep their positions when only a region may change."""
    after: State = State.IDLE
    """The state to return to after LOOKING."""
    in_step: bool = False
    decisions: int = 0
    began: float = field(default_factory=time.monotonic)
    due: float = field(default_factory=time.monotonic)
    """When the last decision was due, while playing."""
    lock: threading.Lock = field(default_factory=threading.Lock)
    stop: threading.Event = field(default_factory=threading.Event)
    applied: threading.Event = field(default_factory=threading.Event)
    wake: threading.Event = field(default_factory=threading.Event)
    enough: threading.Event = field(default_factory=threading.Event)

    def end(self) -> bool:
        """Stop the worker; True if the runner is in the same state as the document."""
        with self.lock:
            self.stop.set()
            in_step = self.in_step
        self.applied.set()
        self.wake.set()
        self.enough.set()
        return not in_step and self.runner is not None


@dataclass
class Decision:
    """The operations of one decision, or of several, from the worker."""

    operations: DecisionStep
    decisions: int
    finished: bool
    insight: Insight | None
    """The policy's view after these operations, if it is shown."""


@dataclass(eq=False)
class HintRequest:
    """A request for the policy's best operations in one state of the document."""

    policy: str
    mesh: HalfEdgeMesh
    near: np.ndarray | None
    """Vertices near which to look, the most important first."""
    revision: int
    seed: int = 0
    runner: RunnerProtocol | None = None
    """What will take the next step; the worker makes one if there is none."""
    next_step: PolicyAction | None = None
    """What that step will be; the first of the hints. Set by the worker."""
