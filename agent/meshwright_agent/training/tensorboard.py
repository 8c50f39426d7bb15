"""Event files for TensorBoard, if the optional package tensorboardX is installed."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

TAGS = {
    "mean": "evaluation/return",
    "std": "evaluation/deviation",
    "at_optimum": "evaluation/at_optimum",
    "played": "self_play/return",
    "policy": "loss/policy",
    "value": "loss/value",
    "entropy": "loss/entropy",
    "clipped": "loss/clipped",
    "learning_rate": "speed/learning_rate",
    "decisions": "speed/decisions",
    "decisions_per_second": "speed/decisions_per_second",
}
"""The TensorBoard tag of each number of an update; numbers without a tag are not written."""


def available() -> bool:
    """Whether tensorboardX is installed; ``meshwright[train]`` requires it."""
    return find_spec("tensorboardX") is not None


class Events:
    """Writes scalars over the updates of a training; does nothing without tensorboardX."""

    def __init__(self, folder: Path, done: int) -> None:
        """Write into `folder`, from update `done` on.

        Events of later updates, left by a process that stopped after its last checkpoint, are
        hidden.
        """
        self._writer: Any = None
        if available():
            from tensorboardX import SummaryWriter

            self._writer = SummaryWriter(str(folder), purge_step=done + 1 if done else None)

    def write(self, update: int, numbers: Mapping[str, float]) -> None:
        """Write the numbers of one update that have a tag and are not NaN."""
        if self._writer is None:
            return
        for name, tag in TAGS.items():
            value = numbers.get(name, float("nan"))
            if value == value:
                self._writer.add_scalar(tag, value, update)

    def close(self) -> None:
        """Close the file."""
        if self._writer is not None:
            self._writer.close()
