"""Training a policy from a configuration, in one process or several, with resumable checkpoints."""

from __future__ import annotations

import json
import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch

from meshwright_agent.env.vector_env import Batch, start_meshes
from meshwright_agent.evaluation.figures import learning_curve
from meshwright_agent.evaluation.rollouts import evaluate, paper_table, roll_out
from meshwright_agent.policy.network import PolicyNetwork
from meshwright_agent.policy.policy_files import TRAINED, Policy, save_policy
from meshwright_agent.training import checkpoint
from meshwright_agent.training.configuration import (
    ConfigurationError,
    TrainingConfiguration,
    configuration_of,
    read_configuration,
    shipped_configuration,
)
from meshwright_agent.training.distributed import DeviceError, Processes, joined
from meshwright_agent.training.ppo import collect, update
from meshwright_agent.training.tensorboard import Events
from meshwright_core.core.kinds import KIND_NOUN
from meshwright_core.io.atomic_write import replacing

__all__ = [
    "ConfigurationError",
    "Trainer",
    "TrainingConfiguration",
    "read_configuration",
    "shipped_configuration",
    "train",
]

CHECKPOINT, EVENTS = "checkpoint.safetensors", "events"


@dataclass
class TrainingProgress:
    """How far a training has come; saved in checkpoints and policy headers."""

    iteration: int = 0
    seconds: float = 0.0
    decisions: int = 0
    curve: list[dict[str, float]] = field(default_factory=list)
    """Points of the learning curve: iteration, decisions, seconds, mean, std, at_optimum."""
    best_iteration: int = 0
    """Number of updates at the best point of the curve; the policy of that point is the result."""
    best_return: float = -1.0
    """The mean return at that point; -1 before the first point."""
    waited: int = 0
    """Points of the curve since the best one, for early stopping."""


class Trainer:
    """A training: network, optimiser, self-play and learning curve."""

    def __init__(
        self, training: TrainingConfiguration, folder: Path, processes: Processes | None = None
    ) -> None:
        """Start a training that writes into `folder`, or resume the checkpoint there.

        Raises ConfigurationError if the checkpoint is damaged or of another configuration.
        """
        self.training, self.folder = training, folder
        self.processes = processes = processes or Processes()
        self.progress = TrainingProgress()
        torch.manual_seed(training.seed)
        self.network = PolicyNetwork(training.task, training.architecture).to(processes.device)
        self.optimiser = torch.optim.Adam(
            self.network.parameters(), lr=training.ppo.learning_rate, eps=1e-5
        )
        self.best: dict[str, torch.Tensor] = {}
        """The weights at the best point of the curve; empty before the first point."""
        self._resume()
        processes.copy_from_first(self.network.state_dict().values())
        # a resumed training must not replay the random numbers of its beginning
        draw = [training.seed, self.progress.iteration, *([processes.rank] * (processes.rank > 0))]
        self.rng = np.random.default_rng(draw)
        self.generator = torch.Generator().manual_seed(
            training.seed + self.progress.iteration + 1_000_003 * processes.rank
        )
        pool_rng = np.random.default_rng([training.seed, 7])
        pool = start_meshes(
            training.task.kind, training.sides, training.pool, pool_rng, training.parts
        )
        self.settings = replace(
            training.ppo,
            environments=processes.share(training.ppo.environments),
            minibatch=processes.share(training.ppo.minibatch),
        )
        self.batch = Batch(training.task, pool, self.settings.environments, self.rng)
        drawn = start_meshes(
            training.task.kind,
            training.sides,
            training.evaluation_meshes,
            np.random.default_rng(training.evaluation_seed),
        )
        self.evaluation_meshes = [mesh for mesh in drawn if mesh.score > mesh.optimum]

    def policy(self) -> Policy:
        """The policy with the current weights."""
        header = {"training": self.training.to_dict(), "progress": asdict(self.progress)}
        return Policy(self.training.task.kind, self.network, header)

    def best_policy(self) -> Policy:
        """The policy at the best point of the learning curve."""
        policy = self.policy()
        if self.best:
            policy.network = PolicyNetwork(self.training.task, self.training.architecture)
            policy.network.load_state_dict(self.best)
        return policy

    @property
    def ended(self) -> bool:
        """Whether all updates are done, or early stopping applies."""
        patience = self.training.patience
        late = patience > 0 and self.progress.waited >= patience
        return late or self.progress.iteration >= self.training.iterations

    def measure(self) -> dict[str, float]:
        """Add a point to the learning curve: single rollouts on the same polygons each time.

        The first process plays them and sends the result to the others.
        """
        if self.processes.first:
            rolled = roll_out(
                self.policy(), self.evaluation_meshes, 1, self.training.evaluation_seed
            )
            numbers = {
                "mean": float(rolled.returns.mean()),
                "std": float(rolled.returns.std()),
                "at_optimum": float((rolled.gaps <= 0).mean()),
            }
        else:
            numbers = {}
        progress = self.progress
        point = {
            "iteration": float(progress.iteration),
            "decisions": float(progress.decisions),
            "seconds": progress.seconds,
            **self.processes.from_first(numbers),
        }
        progress.curve.append(point)
        progress.waited += 1
        if point["mean"] > progress.best_return:
            progress.best_iteration, progress.best_return = progress.iteration, point["mean"]
            progress.waited = 0
            weights = self.network.state_dict()
            self.best = {name: value.detach().cpu().clone() for name, value in weights.items()}
        return point

    def improve(self) -> dict[str, float]:
        """Collect experience by self-play and update the network once."""
        began = time.perf_counter()
        settings, progress = self.settings, self.progress
        done = progress.iteration / self.training.iterations
        rate = settings.learning_rate * max(0.1, 1.0 - 0.9 * done)
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        collected = collect(self.batch, self.network, settings, self.generator)
        report = update(self.network, self.optimiser, collected, settings, self.rng, self.processes)
        decided, ended, played = self.processes.totals(
            np.array([collected.valid.sum(), len(collected.returns), collected.returns.sum()])
        )
        seconds = time.perf_counter() - began
        progress.iteration += 1
        progress.decisions += int(decided)
        progress.seconds += seconds
        return report | {
            "played": float(played / ended) if ended else np.nan,
            "learning_rate": rate,
            "decisions": float(progress.decisions),
            "decisions_per_second": float(decided / seconds),
        }

    def save(self) -> None:
        """Write a checkpoint atomically; only the first process does."""
        if not self.processes.first:
            return
        parts = {
            "network": self.network.state_dict(),
            "optimiser": checkpoint.optimiser_tensors(self.optimiser),
            "best": self.best,
        }
        notes = {"training": self.training.to_dict(), "progress": asdict(self.progress)}
        content = checkpoint.pack(parts, notes)
        self.folder.mkdir(parents=True, exist_ok=True)
        with replacing(self.folder / CHECKPOINT) as temporary:
            temporary.write_bytes(content)

    def save_policy(self) -> None:
        """Write the policy of the best evaluation so far, with the curve but without results."""
        if self.processes.first:
            self.folder.mkdir(parents=True, exist_ok=True)
            save_policy(self.best_policy(), self.folder / TRAINED)

    def _resume(self) -> None:
        path = self.folder / CHECKPOINT
        found = path.read_bytes() if self.processes.first and path.exists() else None
        content = self.processes.from_first(found)
        if content is None:
            return
        try:
            parts, notes = checkpoint.unpack(content)
            earlier = configuration_of(notes["training"], str(path))
            self.progress = TrainingProgress(**notes["progress"])
        except (KeyError, TypeError, ValueError) as error:
            raise ConfigurationError(f"{path}: {error}") from None
        if not self.training.resumes(earlier):
            raise ConfigurationError(
                f"{self.folder}: this folder has a checkpoint of another configuration; choose"
                " another folder or remove the checkpoint"
            )
        self.network.load_state_dict(parts["network"])
        checkpoint.restore_optimiser(self.optimiser, parts.get("optimiser", {}))
        self.best = parts.get("best", {})


def train(
    configuration: str | Path | Mapping[str, Any],
    folder: str | Path,
    *,
    minutes: float | None = None,
    seed: int | None = None,
    report: Callable[[int, int, dict[str, float]], None] | None = None,
    finishing: Callable[[], None] | None = None,
    table: bool = True,
) -> dict[str, Any]:
    """Train a policy (section 4.2.2) and evaluate it; returns the results as plain values.

    Writes into `folder`: policy.safetensors (the policy of the best evaluation, with its results),
    configuration.json, curve.json, curve.png, events for TensorBoard, and checkpoint.safetensors,
    from which a later call with the same folder continues. After Ctrl-C the present update is
    ended first, then the checkpoint and the best policy so far are written, and KeyboardInterrupt
    is raised; a second Ctrl-C does not wait.

    With ``torchrun`` each process calls this; the first reports, writes and returns the results,
    the others return {}.

    Args:
        configuration: a TOML file, or its values.
        folder: where to write; it is created if necessary.
        minutes: stop after the update at which this time has passed.
        seed: in place of that of the configuration.
        report: called after each update with (updates done, total, numbers of the update).
        finishing: called before the final evaluation.
        table: whether that includes the rows of the paper's table, if the configuration has them.

    Raises ConfigurationError for a configuration that cannot be used.
    """
    training = read_configuration(configuration)
    if seed is not None:
        training = replace(training, seed=seed)
    folder = Path(folder)
    try:
        with joined(training.device) as processes:
            trainer = Trainer(training, folder, processes)
            with deferred_interrupt() as interrupted:
                _run_updates(trainer, minutes, report, interrupted)
    except DeviceError as error:
        raise ConfigurationError(str(error)) from None
    if not trainer.processes.first:
        return {}
    if finishing is not None:
        finishing()
    return finish(trainer, table)


@contextmanager
def deferred_interrupt() -> Iterator[Callable[[], bool]]:
    """Inside the block the first Ctrl-C is only noted: the yielded function returns whether there
    was one. The second one raises KeyboardInterrupt. Outside the main thread nothing changes.
    """
    came: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield lambda: False
        return

    def note(number: int, frame: object) -> None:
        came.append(number)
        if len(came) > 1:
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, note)
    try:
        yield lambda: bool(came)
    finally:
        signal.signal(signal.SIGINT, before)


def _run_updates(
    trainer: Trainer,
    minutes: float | None,
    report: Callable[[int, int, dict[str, float]], None] | None,
    interrupted: Callable[[], bool] = lambda: False,
) -> None:
    training, progress, processes = trainer.training, trainer.progress, trainer.processes
    events = Events(trainer.folder / EVENTS, progress.iteration) if processes.first else None
    began = time.perf_counter()
    late = stopped = False
    if not progress.curve:
        trainer.measure()
    while not (trainer.ended or late or stopped):
        numbers = trainer.improve()
        if progress.iteration % training.evaluate_every == 0:
            numbers |= trainer.measure()
            trainer.save()
        if events is not None:
            events.write(progress.iteration, numbers)
        if report is not None and processes.first:
            report(progress.iteration, training.iterations, numbers)
        spent = time.perf_counter() - began
        late = processes.from_first(minutes is not None and spent > 60.0 * minutes)
        stopped = processes.from_first(interrupted())
    if events is not None:
        events.close()
    trainer.save()
    if stopped:
        trainer.save_policy()
        raise KeyboardInterrupt


def finish(trainer: Trainer, table: bool = True) -> dict[str, Any]:
    """Evaluate the best policy and write it, its configuration and its learning curve.

    table: whether to measure the rows of the paper's table, if the configuration asks for them.
    """
    training, folder = trainer.training, trainer.folder
    policy = trainer.best_policy()
    kind, sides = training.task.kind, training.sides
    seed = training.evaluation_seed + 1
    row = evaluate(kind, sides, 100, 10, seed, policy)
    policy.header["evaluation"] = {"sides": list(sides), "meshes": 100, "rollouts": 10, **row}
    if table and training.table_meshes:
        policy.header["table"] = paper_table(kind, training.table_meshes, 10, seed, policy)
    save_policy(policy, folder / TRAINED)
    for name, content in (
        ("configuration.json", training.to_dict()),
        ("curve.json", trainer.progress.curve),
    ):
        with replacing(folder / name) as temporary:
            temporary.write_text(json.dumps(content, indent=1), encoding="utf-8")
    sides_text = f"{sides[0]} to {sides[1]} sides"
    title = f"{KIND_NOUN[kind].capitalize()}, polygons of {sides_text}"
    learning_curve(trainer.progress.curve, kind, title, folder / "curve.png")
    row["evaluation_seconds"] = row.pop("seconds")
    return {"policy": str(folder / TRAINED), **asdict(trainer.progress), **row}
