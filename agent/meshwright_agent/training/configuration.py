"""What a training is: its configuration, read from a TOML file."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

from meshwright_agent.env.task import Task
from meshwright_agent.policy.network import Architecture
from meshwright_agent.training.ppo import Settings

DEVICES = ("auto", "cpu", "cuda")


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
    parts: float = 0.0
    """Share of random parts, half of them with holes, in place of polygons."""
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
    patience: int = 0
    """Points of the learning curve without a better mean after which the training ends; 0: never
    before its last update."""
    table_meshes: int = 100
    """Polygons in each row of the paper's table, with which a training ends; 0: no table."""
    device: str = "auto"
    """Where the network decides and learns: "cpu", "cuda", or "auto", a GPU if there is one."""

    def __post_init__(self) -> None:
        """Refuse settings that mean nothing."""
        if self.device not in DEVICES:
            raise ValueError(f'device is "auto", "cpu" or "cuda", not "{self.device}"')
        least = {"pool": 1, "iterations": 0, "evaluate_every": 1, "evaluation_meshes": 1}
        for name in (*least, "patience", "table_meshes"):
            value = getattr(self, name)
            if not isinstance(value, int) or value < least.get(name, 0):
                raise ValueError(f"{name} is a whole number of at least {least.get(name, 0)}")
        if len(self.sides) != 2 or not 3 <= self.sides[0] <= self.sides[1]:
            raise ValueError(f"sides must be two numbers, 3 or more, not {self.sides}")

    def to_dict(self) -> dict[str, Any]:
        """Plain values, as in the file."""
        return asdict(self)

    def resumes(self, earlier: Training) -> bool:
        """Whether a training by that earlier configuration may go on by this one: whether they
        differ in nothing but when to stop, on what machine, and how to report.
        """
        free = ("iterations", "patience", "table_meshes", "device")
        mine, theirs = self.to_dict(), earlier.to_dict()
        return all(mine[name] == theirs[name] for name in mine if name not in free)


def read_configuration(source: str | Path | Mapping[str, Any]) -> Training:
    """A configuration from a TOML file, or from the values of one. Raises ConfigurationError."""
    if isinstance(source, Mapping):
        return configuration_of(source, "the configuration")
    try:
        values = tomllib.loads(Path(source).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigurationError(f"{source}: cannot be read as TOML ({error})") from None
    return configuration_of(values, str(source))


def configuration_of(given: Mapping[str, Any], name: str) -> Training:
    """A configuration from plain values; `name` is what the message of an error begins with."""
    values = dict(given)
    try:
        ppo = dict(values.pop("ppo", {}))
        if "lambda" in ppo:
            ppo["lambda_"] = ppo.pop("lambda")
        return Training(
            task=Task(**values.pop("task")),
            architecture=Architecture(**values.pop("architecture", {})),
            ppo=Settings(**ppo),
            sides=tuple(values.pop("sides", (10, 30))),
            **values,
        )
    except KeyError as error:
        raise ConfigurationError(f"{name}: the section {error} is missing") from None
    except (TypeError, ValueError) as error:
        raise ConfigurationError(f"{name}: {error}") from None


def shipped_configuration(kind: str) -> Path:
    """The configuration with which the shipped policy of this kind was trained."""
    return Path(str(files("meshwright_agent") / "configs" / f"{kind}.toml"))
