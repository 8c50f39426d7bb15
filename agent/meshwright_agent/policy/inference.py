"""Evaluating the policy network on observations: tensors in, sampled actions out."""

from __future__ import annotations

import numpy as np
import torch
from torch import Tensor

from meshwright_agent.env.local_patch import assemble
from meshwright_agent.env.task import Observation
from meshwright_agent.policy.network import PolicyNetwork


def tensors(
    observation: Observation,
) -> tuple[Tensor, list[Tensor], Tensor, Tensor, Tensor, Tensor]:
    """The arguments of :meth:`PolicyNetwork.forward` for all decisions of an observation."""
    features, tables = assemble(observation.patches, np.arange(len(observation.mask)))
    return (
        torch.from_numpy(features),
        [torch.from_numpy(table) for table in tables],
        torch.from_numpy(observation.chosen >= 0),
        torch.from_numpy(observation.mask),
        torch.from_numpy(observation.changes),
        torch.from_numpy(observation.state),
    )


@torch.no_grad()
def decide(
    network: PolicyNetwork, observation: Observation, generator: torch.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sample one action for each of B decisions from the masked softmax (section 4.2.1).

    Returns actions (B,) int64, -1 where no operation is permitted, their log-probabilities (B,)
    and the values (B,) that the value head predicts, both float32.
    """
    logits, values = network(*tensors(observation))
    log_probabilities = torch.log_softmax(logits, dim=1)
    actions = torch.multinomial(log_probabilities.exp(), 1, generator=generator)
    taken = log_probabilities.gather(1, actions).squeeze(1).numpy()
    possible = observation.mask.any(axis=(1, 2))
    return np.where(possible, actions.squeeze(1).numpy(), -1), taken, values.numpy()
