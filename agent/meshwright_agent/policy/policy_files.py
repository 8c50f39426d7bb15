"""Policy files: safetensors with a JSON header.

The header holds the format version, kind, task, architecture, training configuration and evaluation
results. Pickle is not used, since loading a pickle can execute code.
"""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

import msgspec
import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save

from meshwright_agent.env.checked_settings import settings_from
from meshwright_agent.env.task import Task
from meshwright_agent.policy.network import Architecture, PolicyNetwork
from meshwright_core.core.kinds import KIND_NOUN
from meshwright_core.io.atomic_write import replacing

FORMAT = 1
_ENDING = ".safetensors"
TRAINED = f"policy{_ENDING}"
"""The file in the folder of a training that holds its policy."""


class PolicyError(ValueError):
    """A policy that cannot be loaded or used; the message names it and the reason."""


@dataclass
class Policy:
    """A trained network with its name and the rest of its file header."""

    name: str
    network: PolicyNetwork
    header: dict[str, Any] = field(default_factory=dict)
    """Training configuration, progress and evaluation, as plain values."""

    @property
    def task(self) -> Task:
        """The task that it was trained for."""
        return self.network.task

    @property
    def kind(self) -> str:
        """The kind of mesh it is for, "tri" or "quad"."""
        return self.task.kind


def require_kind(policy: Policy, kind: str, name: str | None = None) -> None:
    """Raise PolicyError unless the policy was trained for meshes of this kind.

    name: what the message calls the policy, by default its own name.
    """
    if policy.kind != kind:
        raise PolicyError(
            f"{policy.name if name is None else name}: this policy is for"
            f" {KIND_NOUN[policy.kind]}, the mesh is of {KIND_NOUN[kind]}"
        )


def _shipped_folder() -> Path:
    return Path(str(files("meshwright_assets") / "policies"))


def shipped(kind: str | None = None) -> list[str]:
    """Names of the policies installed with the program, for one kind or both, sorted.

    A name begins with the kind; the one that equals the kind comes first and is the default.
    """
    names = sorted(path.name[: -len(_ENDING)] for path in _shipped_folder().glob(f"*{_ENDING}"))
    return [name for name in names if kind is None or name.split("-")[0] == kind]


def decide_on_one_thread() -> None:
    """Limit PyTorch to one thread in this process, for programs that run policies.

    The matrices of a decision are small: more threads gain little on an idle machine, and on a busy
    one waiting for them makes a decision up to fifty times slower.
    """
    torch.set_num_threads(1)


def load(name_or_path: str | os.PathLike[str]) -> Policy:
    """Load a shipped policy by name, any policy file by path, or the policy of a training by its
    folder. Raises PolicyError.

    A policy is named after its file, that of a training after the folder.
    """
    text = os.fspath(name_or_path)
    path = Path(text)
    if text in shipped():
        path = _shipped_folder() / f"{text}{_ENDING}"
    elif not path.exists():
        known = ", ".join(shipped()) or "none"
        raise PolicyError(
            f"{text}: there is no such policy file and no installed policy of that name ({known})"
        )
    elif path.is_dir():
        path /= TRAINED
        if not path.exists():
            raise PolicyError(
                f"{text}: this folder has no {TRAINED}; a training writes it when it ends"
            )
    try:
        with safe_open(path, framework="pt") as file:
            metadata = file.metadata() or {}
            weights = {key: file.get_tensor(key) for key in file.keys()}  # noqa: SIM118
    except (SafetensorError, OSError, ValueError, TypeError, RuntimeError, KeyError) as error:
        raise PolicyError(
            f"{text}: this is not a policy file, or it is incomplete ({_short(str(error))})"
        ) from None
    folder = path.absolute().parent.name if path.name == TRAINED else ""
    return _rebuild(text, folder or path.name.removesuffix(_ENDING), metadata, weights)


def _rebuild(
    text: str, name: str, metadata: dict[str, str], weights: dict[str, torch.Tensor]
) -> Policy:
    try:
        header = json.loads(metadata["meshwright"])
        if header["format"] != FORMAT:
            raise PolicyError(
                f"{text}: this is policy format {_short(str(header['format']))},"
                f" but this program reads {FORMAT}"
            )
        task = settings_from(header["task"], Task)
        architecture = settings_from(header["architecture"], Architecture)
        if header.get("kind", task.kind) != task.kind:
            raise ValueError(f"it is for {header['kind']!r} and for {task.kind!r}")
        msgspec.convert(header, _Reports)
    except PolicyError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        reason = f"there is no {error}" if isinstance(error, KeyError) else str(error)
        raise PolicyError(
            f"{text}: its header is not that of a Meshwright policy ({_short(reason)})"
        ) from None
    with torch.device("meta"):  # the shapes alone, before any memory is taken
        wanted = PolicyNetwork(task, architecture).state_dict()
    shapes = {name: (value.shape, value.dtype) for name, value in weights.items()}
    if shapes != {name: (value.shape, value.dtype) for name, value in wanted.items()}:
        raise PolicyError(f"{text}: its weights do not fit its header")
    if not all(bool((value.abs() <= _LARGEST_WEIGHT).all()) for value in weights.values()):
        raise PolicyError(f"{text}: some of its weights are not finite numbers, or too large")
    network = PolicyNetwork(task, architecture)
    network.load_state_dict(weights)
    network.eval()
    return Policy(name, network, {k: v for k, v in header.items() if k not in _OWN})


def _short(reason: str) -> str:
    """The first line of a reason, cut where it is long."""
    line = reason.partition("\n")[0]
    return line if len(line) <= 100 else f"{line[:97]}..."


class _Point(msgspec.Struct):
    """One point of a learning curve."""

    decisions: float
    mean: float
    std: float
    at_optimum: float


class _Progress(msgspec.Struct):
    """What is read of the progress of a training."""

    curve: list[_Point] = []


class _Training(msgspec.Struct):
    """What is read of the settings of a training."""

    sides: tuple[int, int]


class _Reports(msgspec.Struct):
    """The parts of a header that are shown; others may be anything."""

    progress: _Progress | None = None
    training: _Training | None = None


_LARGEST_WEIGHT = 1e6
"""Bound on the size of weights: with it no layer overflows."""

_OWN = ("format", "kind", "task", "architecture")


def save_policy(policy: Policy, path: str | os.PathLike[str]) -> None:
    """Write the policy file atomically: if it fails, with MeshError, an older file is kept."""
    header = {
        "format": FORMAT,
        "kind": policy.kind,
        "task": policy.task.to_dict(),
        "architecture": asdict(policy.network.architecture),
        **policy.header,
    }
    weights = {key: value.contiguous() for key, value in policy.network.state_dict().items()}
    metadata = {"kind": policy.kind, "meshwright": json.dumps(header)}
    with replacing(path) as temporary:
        temporary.write_bytes(save(weights, metadata=metadata))
