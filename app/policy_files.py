"""The policies that travel with the program, found without torch: by their files' headers."""

import json
from importlib.resources import files
from importlib.resources.abc import Traversable

ENDING = ".safetensors"
_LONGEST_HEADER = 16 * 1024 * 1024


def shipped(kind: str) -> list[str]:
    """Names of the policies for meshes of ``kind`` ("tri" or "quad"), in alphabetical order."""
    folder = files("assets") / "policies"
    if not folder.is_dir():
        return []
    names = [
        entry.name.removesuffix(ENDING)
        for entry in folder.iterdir()
        if entry.name.endswith(ENDING) and _kind_of(entry) == kind
    ]
    return sorted(names)


def _kind_of(entry: Traversable) -> str:
    """The kind that the file's header names; empty if it is no policy."""
    with entry.open("rb") as stream:
        length = int.from_bytes(stream.read(8), "little")
        if length > _LONGEST_HEADER:
            return ""
        try:
            header = json.loads(stream.read(length))
        except ValueError:
            return ""
    values = header.get("__metadata__", {}) if isinstance(header, dict) else {}
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
