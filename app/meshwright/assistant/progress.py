"""Progress of the assistant's run: decisions, time, lowest score."""

from __future__ import annotations

import time

from meshwright.assistant.run import AgentRun
from meshwright.assistant.search_runner import Effort, ShapeGoal


class RunProgress:
    """Progress of the current run, or of the last one; a paused run continues its counts."""

    def __init__(self) -> None:
        self.decisions = 0
        """Decisions applied."""
        self.rollouts = 0
        """Rollouts that a search has done."""
        self.best: int | None = None
        """The lowest s found; None before anything is."""
        self.shape: ShapeGoal | None = None
        """Shape of the best mesh that a search has found, and what it aims at."""
        self.way: tuple[int, int] | None = None
        """Operations applied, and all, on the way to the result of a search; None elsewhere."""
        self._start = self._optimum = 0
        self._spent = 0.0
        self._run: AgentRun | None = None

    def forget(self) -> None:
        """Another mesh: nothing has been done on it."""
        self.decisions = self.rollouts = 0
        self.best, self.shape, self._spent = None, None, 0.0

    def begin(self, run: AgentRun, afresh: bool, score: int = 0, optimum: int = 0) -> None:
        """Start counting; `afresh` unless the run continues a paused one. s and s* of the mesh."""
        self._start, self._optimum, self.way = score, optimum, None
        if afresh:
            self.decisions = self.rollouts = 0
            self.best, self.shape, self._spent = None, None, 0.0
        self._run = run

    def end(self) -> None:
        """Stop the clock: the run has ended or is paused."""
        self._spent = self.elapsed
        self._run = self.way = None

    def done(self, decisions: int, score: int) -> None:
        """Add applied decisions; `score` is the present s."""
        self.decisions += decisions
        if self.effort is None:
            self.best = score if self.best is None else min(self.best, score)

    def found(self, rollouts: int, best: int, shape: ShapeGoal | None = None) -> bool:
        """Set the progress of a search; False if nothing has changed."""
        news = (rollouts, best, shape) != (self.rollouts, self.best, self.shape)
        self.rollouts, self.best, self.shape = rollouts, best, shape
        return news

    @property
    def gap(self) -> int | None:
        """How far the best found is above s*; None before anything is found."""
        return None if self.best is None else self.best - self._optimum

    @property
    def counted(self) -> str:
        """``1 decision``, ``12 decisions``."""
        return f"{self.decisions} decision{'' if self.decisions == 1 else 's'}"

    @property
    def effort(self) -> Effort | None:
        """Limits of the current search; None without one."""
        return self._run.effort if self._run is not None else None

    @property
    def elapsed(self) -> float:
        """Seconds; pauses do not count."""
        return self._spent + (time.monotonic() - self._run.began if self._run is not None else 0.0)

    @property
    def share(self) -> float | None:
        """Of the current search, the fraction of its limit that is used, or of the way to s* or to
        its result, 0 to 1; None without a search.
        """
        effort = self.effort
        if effort is None:
            return None
        if self.way is not None:
            return self.way[0] / max(1, self.way[1])
        if effort.until_done:
            return self._share_reached
        if effort.rollouts:
            return min(1.0, self.rollouts / effort.rollouts)
        return min(1.0, self.elapsed / effort.seconds) if effort.seconds else None

    @property
    def _share_reached(self) -> float:
        """The fraction of the way to s*, and half of it to the wanted shape where there is one."""
        if self.best is None:
            return 0.0
        gap = self._start - self._optimum
        share = min(1.0, (self._start - self.best) / gap) if gap else 1.0
        if self.shape is not None:
            share = (share + min(1.0, max(self.shape.weighed, 0.0) / self.shape.aim)) / 2.0
        return share
