"""Proximal policy optimisation (section 4.2.2): collect experience, compute advantages, update.

The advantage is the paper's normalised return (equation 6), G_t / (s_t - s*). With a baseline,
which the paper does without, a learned value of the same quantity is subtracted, and G_t is a
lambda-return (generalised advantage estimation).

An episode terminates at the optimum, when its steps are used up, or when no operation is permitted.
The number of steps is part of the task and the value head sees the share of steps left, so all
three are terminations: nothing follows them. Only the horizon truncates: an episode that continues
beyond it is bootstrapped with the value of its last state.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from meshwright_agent.env.checked_settings import (
    Fraction,
    NonNegativeFloat,
    PositiveFloat,
    PositiveInt,
)
from meshwright_agent.env.local_patch import Patches, assemble
from meshwright_agent.env.task import Observation
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.network import PolicyNetwork
from meshwright_agent.training.distributed import Processes


@dataclass(frozen=True)
class PPOSettings:
    """Hyperparameters of the algorithm."""

    environments: PositiveInt = 256
    """Episodes in parallel, B."""
    horizon: PositiveInt = 32
    """Steps of each episode between two updates, T."""
    epochs: PositiveInt = 2
    """Passes over the collected decisions in one update."""
    minibatch: PositiveInt = 256
    """Decisions per gradient step."""
    learning_rate: PositiveFloat = 1.5e-3
    """Initial learning rate of Adam; it falls linearly to a tenth over the training."""
    gamma: Fraction = 0.99
    """Discount factor (equation 5)."""
    lambda_: Fraction = 0.95
    """Decay of the lambda-return; without a baseline 1 is used."""
    clip: PositiveFloat = 0.2
    """Largest relative change of a probability in one update that is still rewarded."""
    entropy: NonNegativeFloat = 0.003
    """Weight of the entropy bonus."""
    value: NonNegativeFloat = 0.5
    """Weight of the value loss."""
    baseline: bool = True
    """Whether a learned value is subtracted from the returns."""
    gradient_norm: PositiveFloat = 0.5
    """Gradients are clipped to this norm."""
    operation_price: NonNegativeFloat = 0.0
    """Subtracted from the reward of each operation, in units of s."""
    element_price: NonNegativeFloat = 0.0
    """Subtracted from the reward for each element added, and added for each removed, in units of
    s."""


@dataclass
class RolloutBuffer:
    """T x B decisions and what followed from them, flattened in that order to N = T B."""

    observations: list[Observation]
    """T observations of B decisions each."""
    actions: np.ndarray
    """(N,) int64, -1 where no operation was permitted."""
    log_probabilities: np.ndarray
    """(N,) float32: of the actions, under the policy that took them."""
    advantages: np.ndarray
    """(N,) float32, see :func:`normalised_advantages`."""
    targets: np.ndarray
    """(N,) float32: what the value head is trained towards, the normalised lambda-return."""
    valid: np.ndarray
    """(N,) bool: whether any operation was permitted."""
    returns: np.ndarray
    """Normalised returns of the episodes that ended meanwhile."""


def normalised_advantages(
    rewards: np.ndarray,
    gaps: np.ndarray,
    values: np.ndarray,
    ended: np.ndarray,
    gamma: float,
    lambda_: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Generalised advantage estimates of the normalised return, and the targets of the values.

    The recursion runs on the return G itself, whose value is V_t = values_t (s_t - s*):

        delta_t = r_t + gamma (1 - ended_t) V_{t+1} - V_t
        A_t     = delta_t + gamma lambda (1 - ended_t) A_{t+1}

    and both results, A_t and the lambda-return A_t + V_t, are divided by s_t - s* at the end. With
    values of zero and lambda = 1 the advantage is equation 6.

    Args:
        rewards: (T, B) r_t (equation 4).
        gaps: (T+1, B) s_t - s*.
        values: (T+1, B) predicted normalised returns; the last row bootstraps the episodes that
            the horizon truncates.
        ended: (T, B) 1 where the episode terminated with this step, else 0.
        gamma: discount factor.
        lambda_: decay of the lambda-return.

    Returns:
        advantages (T, B) and targets (T, B).
    """
    raw = values * gaps
    advantages = np.zeros_like(rewards)
    running = np.zeros(rewards.shape[1], rewards.dtype)
    for t in range(len(rewards) - 1, -1, -1):
        going = 1.0 - ended[t]
        error = rewards[t] + gamma * going * raw[t + 1] - raw[t]
        running = error + gamma * lambda_ * going * running
        advantages[t] = running
    scale = np.maximum(gaps[:-1], 1.0)
    return advantages / scale, (advantages + raw[:-1]) / scale


def collect(
    batch: Batch, network: PolicyNetwork, settings: PPOSettings, generator: torch.Generator
) -> RolloutBuffer:
    """Play `horizon` steps of every episode with the current policy."""
    shape = (settings.horizon, len(batch.active))
    observations = []
    actions = np.zeros(shape, np.int64)
    log_probabilities = np.zeros(shape, np.float32)
    rewards, ended = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    gaps, values = (np.zeros((shape[0] + 1, shape[1]), np.float32) for _ in range(2))
    returns = []
    for t in range(settings.horizon):
        observation = batch.observe()
        gaps[t] = batch.gaps
        actions[t], log_probabilities[t], values[t] = decide(network, observation, generator)
        outcome = batch.step(observation, actions[t])
        rewards[t] = outcome.rewards - settings.operation_price
        rewards[t] -= settings.element_price * outcome.growth
        ended[t] = outcome.ended
        returns.append(outcome.returns[outcome.ended])
        observations.append(observation)
    gaps[-1] = batch.gaps
    values[-1] = decide(network, batch.observe(), generator)[2]
    if not settings.baseline:
        values[:] = 0.0
    advantages, targets = normalised_advantages(
        rewards, gaps, values, ended, settings.gamma, settings.lambda_ if settings.baseline else 1.0
    )
    return RolloutBuffer(
        observations,
        actions.ravel(),
        log_probabilities.ravel(),
        advantages.ravel(),
        targets.ravel(),
        actions.ravel() >= 0,
        np.concatenate(returns),
    )


class LossTerms(NamedTuple):
    """Means over one minibatch, as scalar tensors."""

    policy: Tensor
    """The negative clipped objective."""
    value: Tensor
    """Squared error of the predicted normalised returns."""
    entropy: Tensor
    """Of the distribution over operations, in nats."""
    clipped: Tensor
    """Share of decisions whose probability has changed by more than the clip."""


def loss_terms(
    logits: Tensor,
    values: Tensor,
    actions: Tensor,
    log_probabilities: Tensor,
    advantages: Tensor,
    targets: Tensor,
    clip: float,
) -> LossTerms:
    """The terms of the PPO loss (Schulman et al. 2017, equation 7) for M decisions.

    Args:
        logits: (M, K A), of forbidden operations very low.
        values: (M,) predicted normalised returns.
        actions: (M,) int64, those taken.
        log_probabilities: (M,) of these actions under the policy that took them.
        advantages: (M,).
        targets: (M,) of the values.
        clip: epsilon, the range in which the probability ratio is left as it is.
    """
    logs = torch.log_softmax(logits, dim=1)
    taken = logs.gather(1, actions.unsqueeze(1)).squeeze(1)
    ratio = (taken - log_probabilities).exp()
    clipped = ratio.clamp(1.0 - clip, 1.0 + clip)
    return LossTerms(
        policy=-torch.min(ratio * advantages, clipped * advantages).mean(),
        value=(values - targets).square().mean(),
        # the lower bound keeps 0 * -inf out where a probability has underflowed
        entropy=-(logs.exp() * logs.clamp(min=-100)).sum(1).mean(),
        clipped=((ratio - 1.0).abs() > clip).float().mean(),
    )


def standardised(advantages: np.ndarray, valid: np.ndarray, processes: Processes) -> np.ndarray:
    """Advantages (N,) less their mean, divided by their standard deviation.

    Both are taken over the valid decisions (N,) of all processes.
    """
    mean, deviation = processes.mean_and_deviation(advantages[valid])
    result: np.ndarray = (advantages - mean) / (deviation + 1e-8)
    return result


def update(
    network: PolicyNetwork,
    optimiser: torch.optim.Optimizer,
    buffer: RolloutBuffer,
    settings: PPOSettings,
    rng: np.random.Generator,
    processes: Processes | None = None,
) -> dict[str, float]:
    """Train the network on the buffer for some epochs; returns the means of :class:`LossTerms`.

    processes: those that train together. Each brings a buffer of its own; all make the same steps,
    with advantages standardised over all and the mean of their gradients.
    """
    processes = processes or Processes()
    patches = Patches.join([observation.patches for observation in buffer.observations])
    joined = {
        name: np.concatenate([getattr(o, name) for o in buffer.observations])
        for name in ("chosen", "mask", "changes", "state")
    }
    usable = np.flatnonzero(buffer.valid)
    advantages = standardised(buffer.advantages, buffer.valid, processes)
    shared = processes.least(len(usable))
    totals = dict.fromkeys(LossTerms._fields, 0.0)
    steps = 0
    for _ in range(settings.epochs):
        order = rng.permutation(usable)[:shared]
        for begin in range(0, len(order), settings.minibatch):
            picked = order[begin : begin + settings.minibatch]
            features, tables = assemble(patches, picked)
            logits, values = network(
                torch.from_numpy(features),
                [torch.from_numpy(table) for table in tables],
                torch.from_numpy(joined["chosen"][picked] >= 0),
                torch.from_numpy(joined["mask"][picked]),
                torch.from_numpy(joined["changes"][picked]),
                torch.from_numpy(joined["state"][picked]),
            )
            terms = loss_terms(
                logits,
                values,
                torch.from_numpy(buffer.actions[picked]),
                torch.from_numpy(buffer.log_probabilities[picked]),
                torch.from_numpy(advantages[picked]),
                torch.from_numpy(buffer.targets[picked]),
                settings.clip,
            )
            loss = terms.policy - settings.entropy * terms.entropy
            if settings.baseline:
                loss = loss + settings.value * terms.value
            optimiser.zero_grad()
            loss.backward()
            processes.average_gradients(network.parameters())
            torch.nn.utils.clip_grad_norm_(network.parameters(), settings.gradient_norm)
            optimiser.step()
            steps += 1
            for name, term in terms._asdict().items():
                totals[name] += term.item()
    return {name: total / max(steps, 1) for name, total in totals.items()}
