"""Data-parallel training: a single process, or those that ``torchrun`` has started.

Each process plays its share of the episodes. Gradients are averaged and statistics summed over all
processes, so that each makes the same update and the networks stay equal. Only the first process
evaluates and writes files.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from datetime import timedelta
from typing import TypeVar

import numpy as np
import torch
import torch.distributed as distributed

T = TypeVar("T")

_LONGEST_WAIT = timedelta(hours=2)  # the other processes wait while the first evaluates


class DeviceError(ValueError):
    """The device of the configuration does not exist; the message names it."""


class Processes:
    """This process as one of `size`. For a single process every method returns its input."""

    def __init__(self, rank: int = 0, size: int = 1, device: torch.device | str = "cpu") -> None:
        """rank: the number of this process, from 0. device: of its network."""
        self.rank, self.size, self.device = rank, size, torch.device(device)
        over_nccl = size > 1 and distributed.get_backend() == "nccl"
        self._wire = self.device if over_nccl else torch.device("cpu")

    @property
    def first(self) -> bool:
        """Whether this process evaluates and writes files."""
        return self.rank == 0

    def share(self, count: int) -> int:
        """The share of this process when `count` items are divided, at least 1."""
        return max(1, count // self.size + (self.rank < count % self.size))

    def average_gradients(self, parameters: Iterable[torch.nn.Parameter]) -> None:
        """Replace each gradient by its mean over all processes; a missing one counts as zero."""
        if self.size == 1:
            return
        learned = [parameter for parameter in parameters if parameter.requires_grad]
        own = [
            torch.zeros_like(parameter) if parameter.grad is None else parameter.grad
            for parameter in learned
        ]
        mean = torch.cat([gradient.flatten() for gradient in own]).to(self._wire) / self.size
        distributed.all_reduce(mean)
        pieces = mean.to(self.device).split([gradient.numel() for gradient in own])
        for parameter, piece in zip(learned, pieces, strict=True):
            parameter.grad = piece.view_as(parameter)

    def totals(self, values: np.ndarray) -> np.ndarray:
        """The sum over all processes, as float64, of an array with the same shape in each."""
        if self.size == 1:
            return values.astype(np.float64)
        sums = torch.from_numpy(values.astype(np.float64)).to(self._wire)
        distributed.all_reduce(sums)
        total: np.ndarray = sums.cpu().numpy()
        return total

    def mean_and_deviation(self, values: np.ndarray) -> tuple[float, float]:
        """Mean and standard deviation of all values (N,) of all processes; N may differ."""
        moments = np.array([len(values), values.sum(dtype=np.float64)])
        count, total = self.totals(moments)
        mean = total / max(count, 1.0)
        spread = self.totals(np.array([np.square(values - mean, dtype=np.float64).sum()]))[0]
        return float(mean), float(np.sqrt(spread / max(count, 1.0)))

    def least(self, number: int) -> int:
        """The smallest `number` over all processes."""
        if self.size == 1:
            return number
        smallest = torch.tensor([number], device=self._wire)
        distributed.all_reduce(smallest, distributed.ReduceOp.MIN)
        return int(smallest.item())

    def from_first(self, value: T) -> T:
        """The `value` of the first process, in all processes; it must be picklable."""
        if self.size == 1:
            return value
        carried = [value]
        distributed.broadcast_object_list(carried, src=0, device=self._wire)
        return carried[0]

    def copy_from_first(self, tensors: Iterable[torch.Tensor]) -> None:
        """Overwrite the tensors with those of the first process."""
        if self.size == 1:
            return
        for tensor in tensors:
            sent = tensor.detach().to(self._wire).contiguous()
            distributed.broadcast(sent, src=0)
            with torch.no_grad():
                tensor.copy_(sent)


@contextmanager
def joined(device: str = "auto") -> Iterator[Processes]:
    """Join the process group of ``torchrun``, if there is one; leave it at the end.

    device: "cpu", "cuda", or "auto" for a GPU if there is one. With several GPUs each process uses
    another. Raises DeviceError for "cuda" without a GPU.
    """
    place, size = _place(device), int(os.environ.get("WORLD_SIZE", "1"))
    if size == 1 or not distributed.is_available():
        yield Processes(device=place)
        return
    if place.type == "cuda":
        torch.cuda.set_device(place)
    # NCCL refuses two processes on one GPU; Gloo copies by way of the CPU
    here = int(os.environ.get("LOCAL_WORLD_SIZE", size))
    own_gpu = place.type == "cuda" and torch.cuda.device_count() >= here
    distributed.init_process_group("nccl" if own_gpu else "gloo", timeout=_LONGEST_WAIT)
    try:
        yield Processes(distributed.get_rank(), distributed.get_world_size(), place)
    finally:
        distributed.destroy_process_group()


def _place(device: str) -> torch.device:
    """The device that a process uses."""
    if device == "cpu" or (device == "auto" and not torch.cuda.is_available()):
        return torch.device("cpu")
    if not torch.cuda.is_available():
        raise DeviceError('device is "cuda", but PyTorch finds no GPU; "auto" trains without one')
    return torch.device("cuda", int(os.environ.get("LOCAL_RANK", "0")) % torch.cuda.device_count())
