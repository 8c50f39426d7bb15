"""How far the assistant's run is: decisions, time, the best so far."""

from __future__ import annotations

import time

from meshwright.assistant.run import Run
from meshwright.assistant.search_runner import Effort


class Progress:
    """Of the run under way, or of the last one; a run that is held and goes on counts on."""

    def __init__(self) -> None:
        self.decisions = 0
        """Decisions applied."""
        self.rollouts = 0
        """Rollouts that a search has done."""
        self.best: int | None = None
        """The lowest s found; None before anything is."""
        self._spent = 0.0
        self._run: Run | None = None

    def begin(self, run: Run, afresh: bool) -> None:
        """A run begins; `afresh` if it does not go on from one that was held."""
        if afresh:
            self.decisions = self.rollouts = 0
            self.best, self._spent = None, 0.0
        self._run = run

    def end(self) -> None:
        """The run is over, or held."""
        self._spent = self.elapsed
        self._run = None

    def done(self, decisions: int, score: int) -> None:
        """So many more decisions are applied, and s is `score` now."""
        self.decisions += decisions
        if self.effort is None:
            self.best = score if self.best is None else min(self.best, score)

    def found(self, rollouts: int, best: int) -> bool:
        """A search has come so far; False if that is no news."""
        news = (rollouts, best) != (self.rollouts, self.best)
        self.rollouts, self.best = rollouts, best
        return news

    @property
    def counted(self) -> str:
        """``1 decision``, ``12 decisions``."""
        return f"{self.decisions} decision{'' if self.decisions == 1 else 's'}"

    @property
    def effort(self) -> Effort | None:
        """How hard the search under way tries; None without one."""
        return self._run.effort if self._run is not None else None

    @property
    def elapsed(self) -> float:
        """Seconds; pauses do not count."""
        return self._spent + (time.monotonic() - self._run.began if self._run is not None else 0.0)

    @property
    def share(self) -> float | None:
        """How much of its effort the search under way has spent, 0 to 1; None without one."""
        effort = self.effort
        if effort is None:
            return None
        if effort.rollouts:
            return min(1.0, self.rollouts / effort.rollouts)
        return min(1.0, self.elapsed / effort.seconds) if effort.seconds else None
