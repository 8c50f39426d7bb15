"""Reads the files of a training: its learning curve, and the quantities of every update."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core import MeshError

POINT = ("iteration", "decisions", "seconds", "mean", "std", "at_optimum")
"""The numbers of a point of a learning curve; see
:class:`meshwright_agent.training.trainer.Progress`.
"""
FILES = ("checkpoint.safetensors", "curve.json", "policy.safetensors")
"""Files with a learning curve, newest first; a running training has a checkpoint only."""
_LONGEST_HEADER = 64 * 1024 * 1024
_EVENTS = "events.out.tfevents.*"


def points(path: Path) -> dict[str, np.ndarray]:
    """The learning curve in the folder of a training, or in one of its FILES: for each of POINT
    an array (n,). MeshError if there is none, or the file is damaged or of another kind.
    """
    if path.is_dir():
        found = next((path / name for name in FILES if (path / name).is_file()), None)
        if found is None:
            raise MeshError(f"{path}: this folder holds no training; it has none of its files.")
        return points(found)
    if not path.is_file():
        raise MeshError(f"{path}: there is no such file or folder.")
    try:
        rows = _rows(path)
        columns = {name: np.array([float(row[name]) for row in rows]) for name in POINT}
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        raise MeshError(
            f"{path}: this is no learning curve of a training, or only part of one."
        ) from None
    if not rows:
        raise MeshError(f"{path}: this training has not been evaluated yet.")
    return columns


def _rows(path: Path) -> list[dict[str, Any]]:
    """The points of the curve in a file of any of the three kinds."""
    if path.suffix != ".safetensors":
        rows = json.loads(path.read_text(encoding="utf-8"))
    else:
        rows = _notes(path)["progress"]["curve"]
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise ValueError("no list of points")
    return rows


def _notes(path: Path) -> dict[str, Any]:
    """The metadata in the header of a checkpoint or policy; no tensor is read."""
    with path.open("rb") as file:
        length = int.from_bytes(file.read(8), "little")
        if not 0 < length <= _LONGEST_HEADER:
            raise ValueError("no header")
        header = json.loads(file.read(length))
        # a file that ends before its tensors do is refused as well
        ends = [entry["data_offsets"][1] for name, entry in header.items() if name[:2] != "__"]
        if path.stat().st_size < 8 + length + max(ends, default=0):
            raise ValueError("torn")
    values = header["__metadata__"]
    notes: dict[str, Any] = json.loads(values.get("checkpoint") or values["meshwright"])
    return notes


def updates(folder: Path) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """The quantities of every update in the TensorBoard events of a training, by their names in
    :data:`meshwright_agent.training.tensorboard.TAGS`: updates (n,) and values (n,). Empty without
    events, which need an optional package; MeshError if they are damaged.
    """
    from meshwright_agent.training.tensorboard import TAGS

    names = {tag: name for name, tag in TAGS.items()}
    found: dict[str, dict[int, float]] = {}
    for path in sorted((folder / "events").glob(_EVENTS)):
        try:
            for step, tag, value in _scalars(path.read_bytes()):
                # where two runs wrote the same update, the later one is kept
                found.setdefault(names.get(tag, tag), {})[step] = value
        except (ValueError, struct.error, IndexError, UnicodeDecodeError):
            raise MeshError(f"{path}: these are no events of a training, or torn ones.") from None
    return {
        name: (np.array(sorted(values)), np.array([values[step] for step in sorted(values)]))
        for name, values in found.items()
    }


# A TensorBoard file is a sequence of records of length, checksum, content, checksum. The content is
# a protocol buffer: fields of a key (field number and wire type) and a value.


def _scalars(content: bytes) -> Iterator[tuple[int, str, float]]:
    """Step, tag and value of every scalar in an event file."""
    at = 0
    while at < len(content):
        (length,) = struct.unpack_from("<Q", content, at)
        event = content[at + 12 : at + 12 + length]
        if len(event) < length:
            raise ValueError("torn")
        at += 12 + length + 4
        fields = _fields(event)
        step = next((value for number, value in fields if number == 2), 0)
        for summary in (value for number, value in fields if number == 5):
            for _, row in _fields(summary):
                entries = dict(_fields(row))
                if isinstance(entries.get(1), bytes) and isinstance(entries.get(2), bytes):
                    yield int(step), entries[1].decode(), struct.unpack("<f", entries[2])[0]


def _fields(message: Any) -> list[tuple[int, Any]]:
    """Number and value of each field; values are ints or raw bytes."""
    if not isinstance(message, bytes):
        raise ValueError("no message")
    found: list[tuple[int, Any]] = []
    at = 0
    while at < len(message):
        key, at = _integer(message, at)
        number, form = key >> 3, key & 7
        if form == 0:
            value: Any
            value, at = _integer(message, at)
        elif form in (1, 2, 5):
            size = 8 if form == 1 else 4
            if form == 2:
                size, at = _integer(message, at)
            value, at = message[at : at + size], at + size
            if at > len(message):
                raise ValueError("torn")
        else:
            raise ValueError("no such form")
        found.append((number, value))
    return found


def _integer(message: bytes, at: int) -> tuple[int, int]:
    """A variable-length integer, seven bits a byte, and the position after it."""
    value = shift = 0
    while True:
        byte = message[at]
        value |= (byte & 127) << shift
        at, shift = at + 1, shift + 7
        if byte < 128:
            return value, at
        if shift > 63:
            raise ValueError("too long")
