"""Training a policy from a configuration file, with checkpoints that a later run resumes."""

from __future__ import annotations

import json
import time
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import torch
from safetensors import SafetensorError
from safetensors.torch import load_file, save

from agent.batch import Batch, start_meshes
from agent.evaluate import evaluate, roll_out
from agent.figures import learning_curve
from agent.network import Architecture, PolicyNetwork
from agent.policies import Policy, save_policy
from agent.ppo import Settings, collect, update
from agent.task import Task
from meshcore.atomic import replacing


class ConfigurationError(ValueError):
    """A training configuration that cannot be used; the message says what and where."""


@dataclass(frozen=True)
class Training:
    """A whole training configuration."""

    task: Task
    architecture: Architecture = field(default_factory=Architecture)
    ppo: Settings = field(default_factory=Settings)
    sides: tuple[int, int] = (10, 30)
    """Sides of the polygons of self-play, a closed range."""
    pool: int = 2000
    """Start meshes, made once."""
    iterations: int = 100
    """Updates."""
    seed: int = 1
    evaluate_every: int = 5
    """Updates between two points of the learning curve."""
    evaluation_meshes: int = 100
    evaluation_seed: int = 987_001
    """Of the polygons of the learning curve: the same for all its points."""

    def to_dict(self) -> dict[str, Any]:
        """Plain values, as in the file."""
        return asdict(self)


def read_configuration(source: str | Path | Mapping[str, Any]) -> Training:
    """A configuration from a TOML file, or from the values of one. Raises ConfigurationError."""
    if isinstance(source, Mapping):
        name, values = "the configuration", dict(source)
    else:
        name = str(source)
        try:
            values = tomllib.loads(Path(source).read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise ConfigurationError(f"{name}: cannot be read as TOML ({error})") from None
    try:
        ppo = dict(values.pop("ppo", {}))
        if "lambda" in ppo:
            ppo["lambda_"] = ppo.pop("lambda")
        sides = tuple(values.pop("sides", (10, 30)))
        if len(sides) != 2 or not 3 <= sides[0] <= sides[1]:
            raise ConfigurationError(f"{name}: sides must be two numbers, 3 or more, not {sides}")
        return Training(
            task=Task(**values.pop("task")),
            architecture=Architecture(**values.pop("architecture", {})),
            ppo=Settings(**ppo),
            sides=sides,
            **values,
        )
    except KeyError as error:
        raise ConfigurationError(f"{name}: the section {error} is missing") from None
    except (TypeError, ValueError) as error:
        raise ConfigurationError(f"{name}: {error}") from None


def shipped_configuration(kind: str) -> Path:
    """The configuration with which the shipped policy of this kind was trained."""
    return Path(str(files("agent") / "configs" / f"{kind}.toml"))


@dataclass
class Progress:
    """Where a training stands."""

    iteration: int = 0
    seconds: float = 0.0
    decisions: int = 0
    curve: list[dict[str, float]] = field(default_factory=list)
    """Points of the learning curve: iteration, decisions, seconds, mean, std, at_optimum."""


class Trainer:
    """One training: network, optimiser, self-play and learning curve."""

    def __init__(self, training: Training, folder: Path) -> None:
        """Writes into `folder`; resumes what is there."""
        self.training, self.folder = training, folder
        self.progress = Progress()
        torch.manual_seed(training.seed)
        self.network = PolicyNetwork(training.task, training.architecture)
        self.optimiser = torch.optim.Adam(
            self.network.parameters(), lr=training.ppo.learning_rate, eps=1e-5
        )
        self._resume()
        # a resumed run draws afresh: what was played before is not played again
        self.rng = np.random.default_rng([training.seed, self.progress.iteration])
        self.generator = torch.Generator().manual_seed(training.seed + self.progress.iteration)
        pool_rng = np.random.default_rng([training.seed, 7])
        pool = start_meshes(training.task.kind, training.sides, training.pool, pool_rng)
        self.batch = Batch(training.task, pool, training.ppo.environments, self.rng)
        drawn = start_meshes(
            training.task.kind,
            training.sides,
            training.evaluation_meshes,
            np.random.default_rng(training.evaluation_seed),
        )
        self.judges = [mesh for mesh in drawn if mesh.score > mesh.optimum]

    def policy(self) -> Policy:
        """The policy as it stands."""
        header = {"training": self.training.to_dict(), "progress": asdict(self.progress)}
        return Policy(self.training.task.kind, self.network, header)

    def measure(self) -> dict[str, float]:
        """A point of the learning curve: single rollouts on the same polygons each time."""
        rolled = roll_out(self.policy(), self.judges, 1, self.training.evaluation_seed)
        point = {
            "iteration": float(self.progress.iteration),
            "decisions": float(self.progress.decisions),
            "seconds": self.progress.seconds,
            "mean": float(rolled.returns.mean()),
            "std": float(rolled.returns.std()),
            "at_optimum": float((rolled.gaps == 0).mean()),
        }
        self.progress.curve.append(point)
        return point

    def improve(self) -> dict[str, float]:
        """One round of self-play and one update."""
        began = time.perf_counter()
        settings = self.training.ppo
        done = self.progress.iteration / self.training.iterations
        for group in self.optimiser.param_groups:
            group["lr"] = settings.learning_rate * max(0.1, 1.0 - 0.9 * done)
        collected = collect(self.batch, self.network, settings, self.generator)
        report = update(self.network, self.optimiser, collected, settings, self.rng)
        report["played"] = float(collected.returns.mean()) if len(collected.returns) else np.nan
        self.progress.iteration += 1
        self.progress.decisions += int(collected.valid.sum())
        self.progress.seconds += time.perf_counter() - began
        return report

    # -- checkpoints -----------------------------------------------------------------------------

    def save(self) -> None:
        """Write a checkpoint; the one before stays whole until this one is complete."""
        tensors = {f"network.{k}": v.contiguous() for k, v in self.network.state_dict().items()}
        for i, state in self.optimiser.state_dict()["state"].items():
            for name, value in state.items():
                tensors[f"optimiser.{i}.{name}"] = torch.as_tensor(value).contiguous()
        notes = {"training": self.training.to_dict(), "progress": asdict(self.progress)}
        content = save(tensors, metadata={"checkpoint": json.dumps(notes)})
        self.folder.mkdir(parents=True, exist_ok=True)
        with replacing(self.folder / "checkpoint.safetensors") as temporary:
            temporary.write_bytes(content)

    def _resume(self) -> None:
        path = self.folder / "checkpoint.safetensors"
        if not path.exists():
            return
        try:
            tensors = load_file(path)
            header_size = int.from_bytes(path.read_bytes()[:8], "little")
            header = json.loads(path.read_bytes()[8 : 8 + header_size])
            notes = json.loads(header["__metadata__"]["checkpoint"])
        except (SafetensorError, KeyError, ValueError) as error:
            raise ConfigurationError(f"{path}: this checkpoint cannot be read ({error})") from None
        now = json.loads(json.dumps(self.training.to_dict()))
        if {**notes["training"], "iterations": 0} != {**now, "iterations": 0}:
            raise ConfigurationError(
                f"{self.folder}: it holds a checkpoint of another configuration; choose another"
                " folder or remove it"
            )
        self.progress = Progress(**notes["progress"])
        own = {k[8:]: v for k, v in tensors.items() if k.startswith("network.")}
        self.network.load_state_dict(own)
        state: dict[int, dict[str, torch.Tensor]] = {}
        for key, value in tensors.items():
            if key.startswith("optimiser."):
                _, i, name = key.split(".")
                state.setdefault(int(i), {})[name] = value
        self.optimiser.load_state_dict(
            {"state": state, "param_groups": self.optimiser.state_dict()["param_groups"]}
        )


def train(
    configuration: str | Path | Mapping[str, Any],
    folder: str | Path,
    *,
    minutes: float | None = None,
    seed: int | None = None,
    report: Callable[[int, int, dict[str, float]], None] | None = None,
) -> dict[str, Any]:
    """Train until the configured number of updates, or for so many minutes; returns the results.

    Writes policy.safetensors, configuration.json, curve.json, curve.png and, for a later call to
    resume, checkpoint.safetensors into `folder`. `report(done, total, numbers)` is called after
    each update. Ctrl-C leaves the last checkpoint.
    """
    training = read_configuration(configuration)
    if seed is not None:
        training = Training(**{**training.__dict__, "seed": seed})
    folder = Path(folder)
    trainer = Trainer(training, folder)
    progress, began = trainer.progress, time.perf_counter()
    if not progress.curve:
        trainer.measure()
    while progress.iteration < training.iterations:
        numbers = trainer.improve()
        if progress.iteration % training.evaluate_every == 0:
            numbers |= trainer.measure()
            trainer.save()
        if report is not None:
            report(progress.iteration, training.iterations, numbers)
        if minutes is not None and time.perf_counter() - began > 60.0 * minutes:
            break
    trainer.save()
    return finish(trainer)


def finish(trainer: Trainer) -> dict[str, Any]:
    """Evaluate the trained policy and write it with its configuration and learning curve."""
    training, folder = trainer.training, trainer.folder
    policy = trainer.policy()
    sides = training.sides
    row = evaluate(training.task.kind, sides, 100, 10, training.evaluation_seed + 1, policy)
    policy.header["evaluation"] = {"sides": list(sides), "meshes": 100, "rollouts": 10, **row}
    save_policy(policy, folder / "policy.safetensors")
    for name, content in (
        ("configuration.json", training.to_dict()),
        ("curve.json", trainer.progress.curve),
    ):
        with replacing(folder / name) as temporary:
            temporary.write_text(json.dumps(content, indent=1), encoding="utf-8")
    sides_text = f"{sides[0]} to {sides[1]} sides"
    title = f"{'Triangles' if training.task.kind == 'tri' else 'Quads'}, polygons of {sides_text}"
    learning_curve(trainer.progress.curve, training.task.kind, title, folder / "curve.png")
    row["evaluation_seconds"] = row.pop("seconds")
    return {"policy": str(folder / "policy.safetensors"), **asdict(trainer.progress), **row}
