"""The preparation of the kernels that all widgets of a program share, and its messages."""

from __future__ import annotations

from meshwright.assistant.kernel_preparation import KernelPreparation, Stage

WAITS: dict[Stage, str] = {
    Stage.EDITING: "Preparing the operations: some seconds, on this machine only once.",
    Stage.AGENT: "Preparing the agent: half a minute or so, on this machine only once.",
}
"""Why a request is refused while a stage is compiled."""
DONE: dict[Stage, str] = {
    Stage.AGENT: "The operations are ready.",
    Stage.READY: "Everything is ready.",
}
"""What is possible when a stage is reached."""
PREPARATION = KernelPreparation()
