"""What the assistant and its worker share: a run, and a question; no Qt, no torch."""

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
    from meshwright_agent.policy.explanation_types import Insight

Step = list[tuple[Operation, int]]


class State(StrEnum):
    """What the assistant is doing."""

    IDLE = "idle"
    LOOKING = "looking"
    STEPPING = "stepping"
    PLAYING = "playing"
    PAUSED = "paused"
    SEARCHING = "searching"


class Runner(Protocol):
    """What the assistant needs of ``meshwright_agent.policy.rollout.Runner``."""

    @property
    def finished(self) -> bool:
        """True once there is nothing more to decide."""
        ...

    @property
    def reason(self) -> str:
        """Why it is finished, in words; empty before."""
        ...

    def look(self) -> Insight | None:
        """What the policy sees now, and will do at the next step; None where that means nothing."""
        ...

    def step(self) -> Step:
        """The next operation and the clean-ups that follow it; empty when finished."""
        ...


@dataclass
class Run:
    """One run: shared by the document's thread and the worker; ``lock`` guards ``in_step``."""

    state: State
    policy: str
    seed: int
    mesh: HalfEdgeMesh | None
    """The runner's copy until the runner has it."""
    speed: float
    """Decisions per second while playing."""
    watch: bool
    """Whether each decision is looked at before it is taken."""
    runner: Runner | None = None
    effort: Effort | None = None
    held: np.ndarray | None = None
    """Vertices that stay where they are, where only a region is worked on."""
    after: State = State.IDLE
    """What follows a look."""
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
        """Stop the worker; True if the runner stands exactly where the document stands."""
        with self.lock:
            self.stop.set()
            in_step = self.in_step
        self.applied.set()
        self.wake.set()
        self.enough.set()
        return not in_step and self.runner is not None


@dataclass
class Decided:
    """What the worker hands over: the operations of one decision, or of a batch of them."""

    operations: Step
    decisions: int
    finished: bool
    insight: Insight | None
    """What the policy sees once they are done, if it is watched."""


@dataclass(frozen=True)
class Question:
    """What would the policy do? Asked about one state of the document."""

    policy: str
    mesh: HalfEdgeMesh
    near: np.ndarray | None
    """Vertices to look near, the most interesting first."""
    revision: int
