"""Proximal policy optimisation in the paper's order (section 4.2.2): self-play, advantages, update.

The advantage is the paper's normalised return (equation 5), G_t / (s_t - s*). With a baseline,
which the paper does without, a learned value of the same quantity is subtracted, and G_t is a
lambda-return. A run ends at the optimum or after a number of steps proportional to its size; that
number is part of the task, and the value sees how many steps are left, so that nothing is
bootstrapped at the end of a run.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import torch

from meshwright_agent.env.local_patch import Patches, assemble
from meshwright_agent.env.task import Observation
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.network import PolicyNetwork
from meshwright_agent.training.distributed import Processes


@dataclass(frozen=True)
class Settings:
    """Numbers of the algorithm."""

    environments: int = 256
    """Runs side by side."""
    horizon: int = 32
    """Steps of every run between updates."""
    epochs: int = 2
    """Passes over the collected decisions in one update."""
    minibatch: int = 256
    """Decisions per gradient step."""
    learning_rate: float = 1.5e-3
    """Of Adam, at the beginning; it falls linearly to a tenth over the training."""
    gamma: float = 0.99
    """Discount (equation 4)."""
    lambda_: float = 0.95
    """Of the lambda-return; 1 with no baseline."""
    clip: float = 0.2
    """How far probabilities may move in one update, relatively."""
    entropy: float = 0.003
    """Weight of the entropy term."""
    value: float = 0.5
    """Weight of the baseline's error."""
    baseline: bool = True
    """Whether a learned value is subtracted."""
    gradient_norm: float = 0.5
    """Gradients are cut to this length."""
    operation_price: float = 0.0
    """What each operation costs, in units of s."""
    element_price: float = 0.0
    """What each new element costs, in units of s; one that goes pays as much back."""


@dataclass
class Collected:
    """T x B decisions and what became of them, flattened in that order."""

    observations: list[Observation]
    actions: np.ndarray
    log_probabilities: np.ndarray
    advantages: np.ndarray
    targets: np.ndarray
    """What the value should have said: the normalised return."""
    valid: np.ndarray
    """Which decisions had anything to choose."""
    returns: np.ndarray
    """Normalised returns of the runs that ended meanwhile."""


def normalised_advantages(
    rewards: np.ndarray,
    gaps: np.ndarray,
    values: np.ndarray,
    ended: np.ndarray,
    gamma: float,
    lambda_: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Normalised lambda-returns less the values, and those returns themselves, both (T, B).

    rewards, ended (T, B); gaps s - s* and values of the normalised return (T+1, B). With values of
    zero and lambda 1 the first is equation 5. Values are of G / gap; the recursion runs on G
    itself.
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
    batch: Batch, network: PolicyNetwork, settings: Settings, generator: torch.Generator
) -> Collected:
    """Play `horizon` steps of every run with the current policy."""
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
    return Collected(
        observations,
        actions.ravel(),
        log_probabilities.ravel(),
        advantages.ravel(),
        targets.ravel(),
        actions.ravel() >= 0,
        np.concatenate(returns),
    )


def update(
    network: PolicyNetwork,
    optimiser: torch.optim.Optimizer,
    collected: Collected,
    settings: Settings,
    rng: np.random.Generator,
    processes: Processes | None = None,
) -> dict[str, float]:
    """Some epochs of clipped policy gradient; returns the means of loss terms and entropy.

    processes: those that train together; each brings its own decisions, and all make the same
    steps, with advantages normalised over all and the mean of their gradients.
    """
    processes = processes or Processes()
    patches = Patches.join([observation.patches for observation in collected.observations])
    joined = {
        name: np.concatenate([getattr(o, name) for o in collected.observations])
        for name in ("chosen", "mask", "changes", "state")
    }
    usable = np.flatnonzero(collected.valid)
    mean, deviation = processes.mean_and_deviation(collected.advantages[usable])
    advantages = (collected.advantages - mean) / (deviation + 1e-8)
    shared = processes.least(len(usable))
    totals = {"policy": 0.0, "value": 0.0, "entropy": 0.0, "clipped": 0.0}
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
            log_probabilities = torch.log_softmax(logits, dim=1)
            taken = log_probabilities.gather(
                1, torch.from_numpy(collected.actions[picked]).unsqueeze(1)
            ).squeeze(1)
            ratio = (taken - torch.from_numpy(collected.log_probabilities[picked])).exp()
            advantage = torch.from_numpy(advantages[picked])
            low, high = 1.0 - settings.clip, 1.0 + settings.clip
            policy = -torch.min(ratio * advantage, ratio.clamp(low, high) * advantage).mean()
            entropy = -(log_probabilities.exp() * log_probabilities.clamp(min=-100)).sum(1).mean()
            error = (values - torch.from_numpy(collected.targets[picked])).square().mean()
            loss = policy - settings.entropy * entropy
            if settings.baseline:
                loss = loss + settings.value * error
            optimiser.zero_grad()
            loss.backward()
            processes.average_gradients(network.parameters())
            torch.nn.utils.clip_grad_norm_(network.parameters(), settings.gradient_norm)
            optimiser.step()
            steps += 1
            totals["policy"] += policy.item()
            totals["value"] += error.item()
            totals["entropy"] += entropy.item()
            totals["clipped"] += ((ratio - 1.0).abs() > settings.clip).float().mean().item()
    return {name: total / max(steps, 1) for name, total in totals.items()}
