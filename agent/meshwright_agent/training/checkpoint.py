"""Checkpoints: the tensors of a training and plain values, in one safetensors file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import torch
from safetensors import SafetensorError
from safetensors.torch import load, save
from torch import Tensor

_NOTES = "checkpoint"


def pack(parts: Mapping[str, Mapping[str, Tensor]], notes: Mapping[str, Any]) -> bytes:
    """Serialise named groups of named tensors, and plain values as JSON in the header."""
    tensors = {
        f"{part}.{name}": value.detach().cpu().contiguous()
        for part, values in parts.items()
        for name, value in values.items()
    }
    return save(tensors, metadata={_NOTES: json.dumps(notes)})


def unpack(content: bytes) -> tuple[dict[str, dict[str, Tensor]], dict[str, Any]]:
    """The parts and notes of :func:`pack`. Raises ValueError if the content is damaged."""
    try:
        size = int.from_bytes(content[:8], "little")
        notes = json.loads(json.loads(content[8 : 8 + size])["__metadata__"][_NOTES])
        tensors = load(content)
    except (SafetensorError, KeyError, ValueError, TypeError) as error:
        raise ValueError(f"this checkpoint cannot be read ({error})") from None
    parts: dict[str, dict[str, Tensor]] = {}
    for key, value in tensors.items():
        part, _, name = key.partition(".")
        parts.setdefault(part, {})[name] = value
    return parts, notes


def optimiser_tensors(optimiser: torch.optim.Optimizer) -> dict[str, Tensor]:
    """The optimiser's state as one flat dictionary."""
    return {
        f"{i}.{name}": torch.as_tensor(value)
        for i, state in optimiser.state_dict()["state"].items()
        for name, value in state.items()
    }


def restore_optimiser(optimiser: torch.optim.Optimizer, tensors: Mapping[str, Tensor]) -> None:
    """Load the state that :func:`optimiser_tensors` returned."""
    state: dict[int, dict[str, Tensor]] = {}
    for key, value in tensors.items():
        i, _, name = key.partition(".")
        state.setdefault(int(i), {})[name] = value
    groups = optimiser.state_dict()["param_groups"]
    optimiser.load_state_dict({"state": state, "param_groups": groups})
