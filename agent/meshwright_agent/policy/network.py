"""The policy network: the DCEL convolution on a local patch (section 4.2), or on a whole mesh.

Both evaluate the same layers; only what they gather from differs. Logits may carry a prior: minus
beta times the exact change of s of the operation, with beta learned.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import torch
from torch import Tensor, nn

from meshwright_agent.env.checked_settings import PositiveInt
from meshwright_agent.env.task import Task

SCALES = (6.0, 1.0, 1.0, 1.0, 32.0, 32.0)
"""Divisors that bring the channels of a patch to order one."""
NEVER = -1e9
"""The logit of what is not permitted."""


@dataclass(frozen=True)
class Architecture:
    """Size and form of the network; saved with the policy."""

    width: PositiveInt = 32
    """Features per half-edge."""
    embedding: PositiveInt = 16
    """Features per half-edge before the first block."""
    prior: bool = True
    """Whether exact one-step changes of s enter the logits."""
    prior_weight: float = 4.0
    """Where beta starts."""
    global_split_bias: float = -3.0
    """Where the prior's constant for global splits starts."""
    value_width: PositiveInt = 64
    """Width of the value head."""


class Block(nn.Module):
    """One convolution: cycle, twin, linear layer, normalisation, ReLU."""

    def __init__(self, k: int, width_in: int, width_out: int) -> None:
        """k + 1 half-edges of `width_in` features in, one of `width_out` out."""
        super().__init__()
        self.beyond = nn.Parameter(torch.zeros(1, width_in))
        """What a half-edge on the boundary gets for its twin."""
        self.linear = nn.Linear((k + 1) * width_in, width_out)
        self.norm = nn.LayerNorm(width_out)

    def forward(self, x: Tensor, reads: Tensor) -> Tensor:
        """x (N, F), reads (Q, k+1) into its rows, N for beyond the boundary: (Q, width_out)."""
        gathered = torch.cat([x, self.beyond]).index_select(0, reads.reshape(-1))
        gathered = gathered.view(len(reads), self.linear.in_features)  # reads may be empty
        out: Tensor = torch.relu(self.norm(self.linear(gathered)))
        return out


class PolicyNetwork(nn.Module):
    """Logits of every candidate's operations, and a value for the baseline."""

    def __init__(self, task: Task, architecture: Architecture) -> None:
        """For the candidates, patches and operations of `task`."""
        super().__init__()
        self.task, self.architecture = task, architecture
        width = architecture.width
        self.embed = nn.Linear(task.channels, architecture.embedding)
        widths = [architecture.embedding, *[width] * task.blocks]
        self.blocks = nn.ModuleList(Block(task.k, a, b) for a, b in pairwise(widths))
        self.head = nn.Linear(width, task.operations)
        nn.init.normal_(self.head.weight, std=0.01)
        nn.init.zeros_(self.head.bias)
        self.beta = nn.Parameter(torch.tensor(float(architecture.prior_weight)))
        bias = torch.zeros(task.operations)
        if task.kind == "quad":
            bias[-1] = architecture.global_split_bias
        self.operation_bias = nn.Parameter(bias)
        self.value = nn.Sequential(
            nn.Linear(2 * width + 3, architecture.value_width),
            nn.ReLU(),
            nn.Linear(architecture.value_width, 1),
        )
        self.scales: Tensor
        self.register_buffer("scales", torch.tensor(SCALES[: task.channels]), persistent=False)

    def convolve(self, features: Tensor, tables: list[Tensor]) -> Tensor:
        """Embeddings (Q, width): features (N, C), and for each block the rows that it reads."""
        x = self.embed(features.float() / self.scales)
        for block, reads in zip(self.blocks, tables, strict=True):
            x = block(x, reads)
        return x

    def convolve_mesh(self, features: Tensor, twins: Tensor) -> Tensor:
        """The same embeddings of all half-edges of a whole mesh: features (H, C), twins (H,), -1 on
        the boundary; half-edges in element order, so that the cycle is a reshape.
        """
        k = self.task.k
        index = torch.arange(len(twins))
        cycle = [index - index % k + (index + i) % k for i in range(k)]
        twin = torch.where(twins >= 0, twins, len(twins))
        return self.convolve(features, [torch.stack([*cycle, twin], dim=1)] * len(self.blocks))

    def logits_of(self, embedding: Tensor, changes: Tensor) -> Tensor:
        """Logits (..., A) from embeddings (..., width) and exact changes of s (..., A)."""
        logits: Tensor = self.head(embedding)
        if self.architecture.prior:
            logits = logits - self.beta * changes.float() + self.operation_bias
        return logits

    def forward(
        self,
        features: Tensor,
        tables: list[Tensor],
        real: Tensor,
        mask: Tensor,
        changes: Tensor,
        state: Tensor,
    ) -> tuple[Tensor, Tensor]:
        """Logits (B, K A), NEVER where not permitted, and values (B,).

        features, tables: from :func:`meshwright_agent.env.local_patch.assemble`; real (B, K): which
        candidates there
        are; mask, changes (B, K, A) and state (B, 3) from an Observation. All come from the
        processor's memory and the results go there, wherever the network is.
        """
        place, width = self.scales.device, self.architecture.width
        real, mask, changes, state = (x.to(place) for x in (real, mask, changes, state))
        convolved = self.convolve(features.to(place), [table.to(place) for table in tables])
        embedding = torch.zeros((*real.shape, width), device=place).masked_scatter(
            real.unsqueeze(2), convolved
        )
        logits = self.logits_of(embedding, changes).masked_fill(~mask, NEVER)
        mean = embedding.sum(dim=1) / real.sum(dim=1, keepdim=True).clamp(min=1)
        value = self.value(torch.cat([mean, embedding.amax(dim=1), state], dim=1)).squeeze(1)
        return logits.flatten(1).cpu(), value.cpu()
