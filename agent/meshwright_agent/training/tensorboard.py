"""Event files for TensorBoard, where the optional package that writes them is installed."""

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
"""Where each number of a training appears; others are left out."""


def available() -> bool:
    """Whether event files can be written: the package comes with ``meshwright[train]``."""
    return find_spec("tensorboardX") is not None


class Events:
    """Scalars over the updates of one training; does nothing where the package is missing."""

    def __init__(self, folder: Path, done: int) -> None:
        """Into `folder`. A training that goes on after update `done` hides what an earlier run,
        stopped later than its last checkpoint, has written beyond it.
        """
        self._writer: Any = None
        if available():
            from tensorboardX import SummaryWriter

            self._writer = SummaryWriter(str(folder), purge_step=done + 1 if done else None)

    def write(self, update: int, numbers: Mapping[str, float]) -> None:
        """Add the numbers of one update, those that are finite and have a tag."""
        if self._writer is None:
            return
        for name, tag in TAGS.items():
            value = numbers.get(name, float("nan"))
            if value == value:
                self._writer.add_scalar(tag, value, update)

    def close(self) -> None:
        """Finish the file."""
        if self._writer is not None:
            self._writer.close()
