"""The policy network: the DCEL convolution (section 4.2) on a local patch or on a whole mesh.

Both evaluate the same layers and differ only in the indices that they gather from. Beyond the
paper, logits may contain a prior: minus beta times the exact change of s of the operation, with
beta learned.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated

import torch
from msgspec import Meta
from torch import Tensor, nn

from meshwright_agent.env.checked_settings import AnyFloat
from meshwright_agent.env.task import Task

SCALES = (6.0, 1.0, 1.0, 1.0, 32.0, 32.0)
"""Divisors that scale the channels of a patch to order one."""
NEVER = -1e9
"""The logit of an operation that is not permitted."""
_MOST = 1e8
"""Bound on the size of all other logits."""
Width = Annotated[int, Meta(ge=1, le=1024)]
"""Features of a layer."""


@dataclass(frozen=True)
class Architecture:
    """Hyperparameters of the network; saved with the policy."""

    width: Width = 32
    """Features per half-edge in and after each block."""
    embedding: Width = 16
    """Features per half-edge before the first block."""
    prior: bool = True
    """Whether the exact changes of s enter the logits."""
    prior_weight: AnyFloat = 4.0
    """Initial value of beta."""
    global_split_bias: AnyFloat = -3.0
    """Initial value of the constant that the prior adds for global splits."""
    value_width: Width = 64
    """Hidden units of the value head."""


class Block(nn.Module):
    """One convolution (section 4.2): cycle, twin, linear layer, layer normalisation, ReLU."""

    def __init__(self, k: int, width_in: int, width_out: int) -> None:
        """From `width_in` features of k + 1 half-edges to `width_out` of one."""
        super().__init__()
        self.beyond = nn.Parameter(torch.zeros(1, width_in))
        """Learned features in place of the twin on the boundary."""
        self.linear = nn.Linear((k + 1) * width_in, width_out)
        self.norm = nn.LayerNorm(width_out)

    def forward(self, x: Tensor, reads: Tensor) -> Tensor:
        """From x (N, width_in) and reads (Q, k+1) to (Q, width_out).

        reads: rows of x, or N for "beyond the boundary".
        """
        gathered = torch.cat([x, self.beyond]).index_select(0, reads.reshape(-1))
        gathered = gathered.view(len(reads), self.linear.in_features)  # reads may be empty
        out: Tensor = torch.relu(self.norm(self.linear(gathered)))
        return out


class PolicyNetwork(nn.Module):
    """The policy and value network: logits of all actions, and the predicted normalised return."""

    def __init__(self, task: Task, architecture: Architecture) -> None:
        """Initialise the weights from PyTorch's global random state."""
        super().__init__()
        self.task, self.architecture = task, architecture
        width = architecture.width
        self.embed = nn.Linear(task.channels, architecture.embedding)
        widths = [architecture.embedding, *[width] * task.blocks]
        self.blocks = nn.ModuleList(Block(task.k, a, b) for a, b in pairwise(widths))
        self.head = nn.Linear(width, task.operations)
        if not self.head.weight.is_meta:  # drawing normally on "meta" imports PyTorch's compiler
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
        """Embeddings (Q, width) from features (N, C) and the reads of each block."""
        x = self.embed(features.float() / self.scales)
        for block, reads in zip(self.blocks, tables, strict=True):
            x = block(x, reads)
        return x

    def convolve_mesh(self, features: Tensor, twins: Tensor) -> Tensor:
        """Embeddings (H, width) of all half-edges of a mesh, in element order.

        features: (H, C). twins: (H,), -1 on the boundary.
        """
        k = self.task.k
        index = torch.arange(len(twins))
        cycle = [index - index % k + (index + i) % k for i in range(k)]
        twin = torch.where(twins >= 0, twins, len(twins))
        return self.convolve(features, [torch.stack([*cycle, twin], dim=1)] * len(self.blocks))

    def logits_of(self, embedding: Tensor, changes: Tensor) -> Tensor:
        """Logits (..., A) from embeddings (..., width) and the exact changes of s (..., A)."""
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

        All tensors are on the CPU, and so are the results, on whatever device the network is.

        Args:
            features: (N, C) from :func:`meshwright_agent.env.local_patch.assemble`.
            tables: the reads of each block, from the same.
            real: (B, K) bool, which candidates exist.
            mask: (B, K, A) bool, permitted operations.
            changes: (B, K, A) exact changes of s.
            state: (B, 3), see :class:`meshwright_agent.env.task.Observation`.
        """
        place, width = self.scales.device, self.architecture.width
        real, mask, changes, state = (x.to(place) for x in (real, mask, changes, state))
        convolved = self.convolve(features.to(place), [table.to(place) for table in tables])
        embedding = torch.zeros((*real.shape, width), device=place).masked_scatter(
            real.unsqueeze(2), convolved
        )
        logits = self.logits_of(embedding, changes).clamp(-_MOST, _MOST).masked_fill(~mask, NEVER)
        mean = embedding.sum(dim=1) / real.sum(dim=1, keepdim=True).clamp(min=1)
        value = self.value(torch.cat([mean, embedding.amax(dim=1), state], dim=1)).squeeze(1)
        return logits.flatten(1).cpu(), value.cpu()
