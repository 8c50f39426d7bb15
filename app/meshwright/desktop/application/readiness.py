"""Whether the compiled kernels are loaded, so that operations and policies can run."""

from __future__ import annotations

from meshwright.signals import Signal

PREPARING = "The operations are still being compiled. Please wait a moment."


class Readiness:
    """``editing``: operations can be applied; ``agent``: policies can run. ``changed()`` when one
    of the two has changed, ``progressed()`` when :attr:`preparing` or :attr:`share` has.
    """

    def __init__(self, editing: bool = False, agent: bool = False) -> None:
        self.changed = Signal()
        self.progressed = Signal()
        self._editing, self._agent = editing, agent
        self._preparing = ""
        self._share: float | None = None

    @property
    def preparing(self) -> str:
        """What is being compiled or loaded, as a sentence; empty if nothing is."""
        return self._preparing

    @property
    def share(self) -> float | None:
        """How much of it is done, 0 to 1; None if nothing is being done or it is not known."""
        return self._share

    def show_progress(self, preparing: str, share: float | None = None) -> None:
        """Set :attr:`preparing` and :attr:`share`."""
        if (preparing, share) != (self._preparing, self._share):
            self._preparing, self._share = preparing, share
            self.progressed.emit()

    @property
    def editing(self) -> bool:
        """Whether operations can be applied without compiling first."""
        return self._editing

    @editing.setter
    def editing(self, ready: bool) -> None:
        if ready != self._editing:
            self._editing = ready
            self.changed.emit()

    @property
    def agent(self) -> bool:
        """Whether a policy can run without compiling first."""
        return self._agent

    @agent.setter
    def agent(self, ready: bool) -> None:
        if ready != self._agent:
            self._agent = ready
            self.changed.emit()
