"""Whether the compiled kernels are loaded, so that operations and policies can run."""

from __future__ import annotations

from meshwright.signals import Signal

PREPARING = "The operations are still being compiled. Please wait a moment."


class Readiness:
    """``editing``: operations can be applied; ``agent``: policies can run. ``changed()``."""

    def __init__(self, editing: bool = False, agent: bool = False) -> None:
        self.changed = Signal()
        self._editing, self._agent = editing, agent

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
