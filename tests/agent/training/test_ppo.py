"""PPO against slow, readable twins: one loop for each sum, no vectorisation."""

from math import exp, log

import numpy as np
import pytest
import torch

from meshwright_agent.policy.network import NEVER
from meshwright_agent.training.distributed import Processes
from meshwright_agent.training.ppo import loss_terms, normalised_advantages, standardised

GAMMA, CLIP = 0.9, 0.2


def slow_advantage(
    rewards: list[float],
    gaps: list[float],
    values: list[float],
    terminated: list[bool],
    t: int,
    lambda_: float,
) -> tuple[float, float]:
    """Normalised advantage and lambda-return of step t of one environment, as explicit sums.

    Two things stop the sum. Termination: no reward follows, so the next value is 0 and the next
    step, which belongs to another episode, does not count. Truncation by the horizon: the episode
    continues unseen, and values[horizon] stands for the rest of its return.
    """
    horizon = len(rewards)
    advantage, weight = 0.0, 1.0
    for later in range(t, horizon):
        value = values[later] * gaps[later]
        next_value = 0.0 if terminated[later] else values[later + 1] * gaps[later + 1]
        advantage += weight * (rewards[later] + GAMMA * next_value - value)
        weight *= GAMMA * lambda_
        if terminated[later]:
            break
    return advantage / gaps[t], (advantage + values[t] * gaps[t]) / gaps[t]


@pytest.mark.parametrize("lambda_", [0.0, 0.7, 1.0])
def test_advantages_agree_with_the_slow_sums(lambda_):
    rng = np.random.default_rng(0)
    steps, environments = 12, 5
    rewards = rng.integers(-2, 3, (steps, environments)).astype(np.float32)
    gaps = rng.integers(1, 9, (steps + 1, environments)).astype(np.float32)
    values = rng.normal(0.5, 0.3, (steps + 1, environments)).astype(np.float32)
    terminated = rng.random((steps, environments)) < 0.2
    terminated[-1] = [True, False, True, False, False]  # the others are truncated
    advantages, targets = normalised_advantages(
        rewards, gaps, values, terminated.astype(np.float32), GAMMA, lambda_
    )
    for b in range(environments):
        for t in range(steps):
            found = slow_advantage(
                rewards[:, b].tolist(), gaps[:, b].tolist(), values[:, b].tolist(),
                terminated[:, b].tolist(), t, lambda_,
            )  # fmt: skip
            assert (advantages[t, b], targets[t, b]) == pytest.approx(found, rel=1e-4, abs=1e-5)


def test_truncation_bootstraps_and_termination_does_not():
    rewards, gaps = np.array([[1.0]], np.float32), np.array([[4.0], [3.0]], np.float32)
    values = np.array([[0.5], [0.8]], np.float32)
    truncated, _ = normalised_advantages(rewards, gaps, values, np.zeros((1, 1)), GAMMA, 0.95)
    terminated, _ = normalised_advantages(rewards, gaps, values, np.ones((1, 1)), GAMMA, 0.95)
    assert truncated[0, 0] == pytest.approx((1.0 + GAMMA * 0.8 * 3.0 - 0.5 * 4.0) / 4.0)
    assert terminated[0, 0] == pytest.approx((1.0 - 0.5 * 4.0) / 4.0)


def test_without_a_baseline_the_advantage_is_equation_6():
    rewards = np.array([[2.0], [-1.0], [3.0]], np.float32)
    gaps = np.array([[4.0], [2.0], [3.0], [7.0]], np.float32)  # the last is of the next episode
    ended = np.array([[0.0], [0.0], [1.0]], np.float32)
    advantages, _ = normalised_advantages(rewards, gaps, np.zeros_like(gaps), ended, GAMMA, 1.0)
    returns = [2.0 - GAMMA + GAMMA**2 * 3.0, -1.0 + GAMMA * 3.0, 3.0]
    expected = [g / gap for g, gap in zip(returns, [4.0, 2.0, 3.0], strict=True)]
    assert advantages[:, 0].tolist() == pytest.approx(expected)


def test_values_that_know_the_return_leave_no_advantage():
    rng = np.random.default_rng(3)
    rewards = rng.integers(-2, 3, (6, 2)).astype(np.float32)
    gaps = rng.integers(1, 9, (7, 2)).astype(np.float32)
    ended = np.zeros((6, 2), np.float32)
    ended[-1] = 1.0
    _, returns = normalised_advantages(rewards, gaps, np.zeros_like(gaps), ended, GAMMA, 1.0)
    values = np.concatenate([returns, np.zeros((1, 2), np.float32)])
    advantages, _ = normalised_advantages(rewards, gaps, values, ended, GAMMA, 0.7)
    assert np.abs(advantages).max() < 1e-5


def probabilities(logits: list[float]) -> list[float]:
    """Softmax of one row; what the mask forbids gets probability 0."""
    highest = max(logits)
    weights = [exp(x - highest) if x > NEVER else 0.0 for x in logits]
    return [weight / sum(weights) for weight in weights]


def decisions(count: int = 7, operations: int = 6) -> dict[str, torch.Tensor]:
    """Random logits with a mask, and actions of an older policy that the mask permits."""
    rng = np.random.default_rng(5)
    logits = rng.normal(0.0, 1.0, (count, operations)).astype(np.float32)
    mask = rng.random(logits.shape) < 0.7
    mask[0] = False  # one operation is left
    mask[:, 2] = True
    actions = [int(rng.choice(np.flatnonzero(row))) for row in mask]
    older = [log(rng.uniform(0.1, 0.9)) for _ in range(count)]
    return {
        "logits": torch.from_numpy(logits).masked_fill(~torch.from_numpy(mask), NEVER),
        "values": torch.from_numpy(rng.normal(0.5, 0.3, count).astype(np.float32)),
        "actions": torch.tensor(actions),
        "log_probabilities": torch.tensor(older),
        "advantages": torch.from_numpy(rng.normal(0.0, 1.0, count).astype(np.float32)),
        "targets": torch.from_numpy(rng.normal(0.5, 0.3, count).astype(np.float32)),
    }


def test_loss_terms_agree_with_slow_sums():
    given = decisions()
    count = len(given["actions"])
    objective = entropy = error = clipped = 0.0
    for i in range(count):
        spread = probabilities(given["logits"][i].tolist())
        ratio = spread[given["actions"][i]] / exp(given["log_probabilities"][i])
        advantage = float(given["advantages"][i])
        nearest = min(max(ratio, 1.0 - CLIP), 1.0 + CLIP)
        objective += min(ratio * advantage, nearest * advantage) / count
        entropy -= sum(p * log(p) for p in spread if p > 0.0) / count
        error += float(given["values"][i] - given["targets"][i]) ** 2 / count
        clipped += (abs(ratio - 1.0) > CLIP) / count
    terms = loss_terms(**given, clip=CLIP)
    assert [term.item() for term in terms] == pytest.approx(
        [-objective, error, entropy, clipped], rel=1e-5
    )
    assert 0.0 < clipped < 1.0


@pytest.mark.parametrize(
    ("ratio", "advantage", "pushes"),
    [(1.5, 1.0, False), (1.5, -1.0, True), (0.5, 1.0, True), (0.5, -1.0, False), (1.1, 1.0, True)],
)
def test_clipping_stops_the_gradient_only_where_the_change_has_paid_off(ratio, advantage, pushes):
    logits = torch.zeros(1, 4, requires_grad=True)
    loss_terms(
        logits, torch.zeros(1), torch.tensor([1]), torch.tensor([log(0.25 / ratio)]),
        torch.tensor([advantage]), torch.zeros(1), CLIP,
    ).policy.backward()  # fmt: skip
    assert bool((logits.grad != 0.0).any()) == pushes


def test_forbidden_operations_have_no_probability_no_entropy_and_no_gradient():
    given = decisions()
    logits = given["logits"].clone().requires_grad_()
    terms = loss_terms(**{**given, "logits": logits}, clip=CLIP)
    (terms.policy - terms.entropy).backward()
    forbidden = given["logits"] == NEVER
    assert forbidden.any() and (logits.grad[forbidden] == 0.0).all()
    assert torch.isfinite(logits.grad).all()
    # a single permitted operation is certain
    certain = loss_terms(**{name: value[:1] for name, value in given.items()}, clip=CLIP)
    assert certain.entropy.item() == 0.0
    # the same operations without the forbidden ones have the same entropy
    row = given["logits"][1]
    left = row[row > NEVER]
    alone = {name: value[1:2] for name, value in given.items()}
    some = {**alone, "logits": left.unsqueeze(0), "actions": torch.tensor([0])}
    assert loss_terms(**alone, clip=CLIP).entropy.item() == pytest.approx(
        loss_terms(**some, clip=CLIP).entropy.item()
    )


def test_entropy_of_equal_logits_is_the_logarithm_of_their_number():
    given = {name: value[:2] for name, value in decisions().items()}
    equal = {**given, "logits": torch.full((2, 5), 0.3), "actions": torch.tensor([0, 4])}
    assert loss_terms(**equal, clip=CLIP).entropy.item() == pytest.approx(log(5.0))


def test_advantages_are_standardised_over_valid_decisions():
    advantages = np.array([1.0, 2.0, 100.0, 6.0], np.float32)
    valid = np.array([True, True, False, True])
    mean = (1.0 + 2.0 + 6.0) / 3.0
    variance = sum((x - mean) ** 2 for x in (1.0, 2.0, 6.0)) / 3.0
    found = standardised(advantages, valid, Processes())
    assert found[valid].tolist() == pytest.approx(
        [(x - mean) / variance**0.5 for x in (1.0, 2.0, 6.0)]
    )
    equal = standardised(np.full(3, 2.0, np.float32), np.ones(3, bool), Processes())
    assert equal.tolist() == [0.0, 0.0, 0.0]
