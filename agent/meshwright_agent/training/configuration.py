"""The configuration of a training: task, network, PPO and schedule, read from a TOML file."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

from msgspec import Meta

from meshwright_agent.env.checked_settings import (
    Fraction,
    NonNegativeInt,
    PositiveInt,
    SettingsError,
    settings_from,
)
from meshwright_agent.env.task import Task
from meshwright_agent.policy.network import Architecture
from meshwright_agent.training.ppo import PPOSettings

DEVICES = ("auto", "cpu", "cuda")

Sides = Annotated[int, Meta(ge=3)]
"""A number of sides of a polygon."""


class ConfigurationError(ValueError):
    """A training configuration that cannot be used; the message names the file and the key."""


@dataclass(frozen=True)
class TrainingConfiguration:
    """A whole training configuration."""

    task: Task
    architecture: Architecture = field(default_factory=Architecture)
    ppo: PPOSettings = field(default_factory=PPOSettings)
    sides: tuple[Sides, Sides] = (10, 30)
    """Smallest and largest number of sides of the polygons of self-play."""
    parts: Fraction = 0.0
    """Share of the start meshes that are random engineering parts, half of them with holes, in
    place of polygons."""
    pool: PositiveInt = 2000
    """Start meshes; they are generated once, and each episode starts from one of them."""
    iterations: NonNegativeInt = 100
    """Policy updates."""
    seed: NonNegativeInt = 1
    evaluate_every: PositiveInt = 5
    """Updates between two points of the learning curve."""
    evaluation_meshes: PositiveInt = 100
    """Polygons on which the learning curve is measured."""
    evaluation_seed: NonNegativeInt = 987_001
    """Seed of these polygons, which are the same for all points."""
    patience: NonNegativeInt = 0
    """Early stopping: evaluations without a better mean return after which the training ends; 0
    trains for all `iterations`."""
    table_meshes: NonNegativeInt = 100
    """Polygons in each row of the paper's tables, measured at the end; 0 leaves the table out."""
    device: str = "auto"
    """Where the network runs: "cpu", "cuda", or "auto" for a GPU if there is one."""

    def __post_init__(self) -> None:
        """Raise ValueError for an unknown device or an empty range of sides."""
        if self.device not in DEVICES:
            raise ValueError(f'device must be "auto", "cpu" or "cuda", not "{self.device}"')
        if self.sides[0] > self.sides[1]:
            raise ValueError(
                f"sides must hold the smaller number first, not {self.sides[0]}, {self.sides[1]}"
            )

    def to_dict(self) -> dict[str, Any]:
        """Plain values, as they are saved in checkpoints and policy headers."""
        return asdict(self)

    def resumes(self, earlier: TrainingConfiguration) -> bool:
        """Whether a training with this configuration can continue a checkpoint of `earlier`.

        They may differ in when to stop, in the device, and in what is measured at the end.
        """
        free = ("iterations", "patience", "table_meshes", "device")
        mine, theirs = self.to_dict(), earlier.to_dict()
        return all(mine[name] == theirs[name] for name in mine if name not in free)


def read_configuration(source: str | Path | Mapping[str, Any]) -> TrainingConfiguration:
    """A configuration from a TOML file, or from the values of one. Raises ConfigurationError."""
    if isinstance(source, Mapping):
        return configuration_of(source, "the configuration")
    try:
        values = tomllib.loads(Path(source).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigurationError(f"{source}: cannot be read as TOML ({error})") from None
    return configuration_of(values, str(source))


def configuration_of(given: Mapping[str, Any], name: str) -> TrainingConfiguration:
    """A configuration from plain values; error messages begin with `name`.

    The key ``lambda`` of a TOML file is the field ``lambda_``, as it is saved in checkpoints.
    """
    values = dict(given)
    ppo = values.get("ppo")
    if isinstance(ppo, Mapping):
        values["ppo"] = {("lambda_" if key == "lambda" else key): ppo[key] for key in ppo}
    try:
        return settings_from(values, TrainingConfiguration)
    except SettingsError as error:
        raise ConfigurationError(f"{name}: {error}".replace("lambda_", "lambda")) from None


def shipped_configuration(kind: str) -> Path:
    """The configuration with which the shipped policy of this name was trained."""
    return Path(str(files("meshwright_agent") / "configs" / f"{kind}.toml"))
