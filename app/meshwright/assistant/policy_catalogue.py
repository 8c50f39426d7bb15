"""Lists shipped policies and reads the kind of policy files, without importing torch."""

import json
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

ENDING = ".safetensors"
_LONGEST_HEADER = 16 * 1024 * 1024


def shipped(kind: str) -> list[str]:
    """Names of the policies for meshes of ``kind`` ("tri" or "quad"), in alphabetical order."""
    folder = files("meshwright_assets") / "policies"
    if not folder.is_dir():
        return []
    names = [
        entry.name.removesuffix(ENDING)
        for entry in folder.iterdir()
        if entry.name.endswith(ENDING) and _kind_of(entry) == kind
    ]
    return sorted(names)


def kind_of(path: str | Path) -> str:
    """The kind of mesh, "tri" or "quad", that a policy file is for; only its header is read.

    Raises ValueError or OSError with one sentence where it is no policy file at all.
    """
    path = Path(path)
    if path.is_dir():
        raise ValueError(f"{path}: this is a folder, not a policy file.")
    if not path.is_file():
        raise ValueError(f"{path}: there is no such file.")
    length, header = _header(path)
    kind = _kind_in(header)
    if kind not in ("tri", "quad"):
        raise ValueError(f"{path.name}: this is no policy file of Meshwright.")
    if path.stat().st_size < 8 + length + _body(header):
        raise ValueError(f"{path.name}: this policy file is cut off.")
    return kind


def label(name: str) -> str:
    """The name to show for a policy: for a file, its name without folder and ending."""
    return Path(name).name.removesuffix(ENDING) if name.endswith(ENDING) else name


def _kind_of(entry: Traversable | Path) -> str:
    """The kind that the file's header names; empty if it is no policy."""
    return _kind_in(_header(entry)[1])


def _header(entry: Traversable | Path) -> tuple[int, dict[str, Any]]:
    """Bytes of the file's header, and its entries; (0, {}) if it has no valid header."""
    with entry.open("rb") as stream:
        length = int.from_bytes(stream.read(8), "little")
        if length > _LONGEST_HEADER:
            return 0, {}
        try:
            header = json.loads(stream.read(length))
        except (ValueError, RecursionError):
            return 0, {}
    entries = header.values() if isinstance(header, dict) else [None]
    return (length, header) if all(isinstance(one, dict) for one in entries) else (0, {})


def _body(header: dict[str, Any]) -> int:
    """Bytes that follow the header according to it; the full check is done when it is loaded."""
    spans = [one.get("data_offsets") for one in header.values()]
    ends = [span[1] for span in spans if isinstance(span, list) and len(span) == 2]
    return max((end for end in ends if type(end) is int), default=0)


def _kind_in(header: dict[str, Any]) -> str:
    values = header.get("__metadata__", {})
    if "kind" in values:
        return str(values["kind"])
    for value in values.values():
        try:
            inner = json.loads(value)
        except (TypeError, ValueError):
            continue
        if isinstance(inner, dict) and "kind" in inner:
            return str(inner["kind"])
    return ""
