"""Checks of glTF and 3MF files before trimesh reads them: of what they announce, and unpack to."""

from __future__ import annotations

import zipfile
from pathlib import Path

import msgspec

from meshwright_core.errors import MeshError
from meshwright_core.io.readers.numbers import CUT_OFF

_LARGEST = 2**30
"""Bytes that a 3MF file may unpack to."""
_SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


class _Accessor(msgspec.Struct):
    count: int
    type: str
    bufferView: int | None = None  # noqa: N815 - as glTF names it


class _Node(msgspec.Struct):
    children: list[int] = []


class _Buffer(msgspec.Struct):
    byteLength: int  # noqa: N815 - as glTF names it
    uri: str | None = None


class _Scene(msgspec.Struct):
    accessors: list[_Accessor] = []
    nodes: list[_Node] = []
    buffers: list[_Buffer] = []


def require_bounded(path: Path, kind: str) -> None:
    """MeshError if a file announces more than it can hold, or unpacks to too much.

    kind: "glb", "gltf" or "3mf".
    """
    if kind == "3mf":
        _require_bounded_archive(path)
        return
    data = path.read_bytes()
    scene = data
    if kind == "glb":
        size = int.from_bytes(data[12:16], "little")
        if not data.startswith(b"glTF") or data[16:20] != b"JSON":
            raise MeshError("it does not begin like a binary glTF file")
        if size > len(data) - 20:
            raise MeshError(CUT_OFF)
        scene = data[20 : 20 + size]
    try:
        tree = msgspec.json.decode(scene.strip(b" \0\r\n\t"), type=_Scene)
    except (msgspec.DecodeError, RecursionError) as error:
        raise MeshError(f"it is cut off or damaged: {error}") from error
    there = len(data)
    for buffer in tree.buffers:
        uri = buffer.uri
        if uri is not None and not uri.startswith("data:"):
            beside = (path.parent / uri).resolve()
            if not beside.is_relative_to(path.parent.resolve()) or not beside.is_file():
                raise MeshError(f"the file {uri[:60]!r} with its data is not beside it")
            there += beside.stat().st_size
    for accessor in tree.accessors:
        width = _SIZES.get(accessor.type, 1)
        if not 0 <= accessor.count * width <= there:
            raise MeshError(f"{CUT_OFF} or damaged: it announces {accessor.count} numbers")
    _require_tree(tree.nodes)


def _require_tree(nodes: list[_Node]) -> None:
    """MeshError if a node has two parents, or is its own ancestor."""
    parents = [0] * len(nodes)
    for node in nodes:
        for child in node.children:
            if not 0 <= child < len(nodes) or parents[child]:
                raise MeshError("it is damaged: its nodes are no tree")
            parents[child] = 1
    seen, left = 0, [i for i, parent in enumerate(parents) if not parent]
    while left:
        seen += 1
        left += nodes[left.pop()].children
    if seen < len(nodes):
        raise MeshError("it is damaged: its nodes are no tree")


def _require_bounded_archive(path: Path) -> None:
    try:
        with zipfile.ZipFile(path) as archive:
            total = sum(entry.file_size for entry in archive.infolist())
    except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
        raise MeshError("it is cut off or damaged: it is no zip archive") from error
    if total > _LARGEST:
        raise MeshError(f"it unpacks to {total} bytes, and at most {_LARGEST} are read")
