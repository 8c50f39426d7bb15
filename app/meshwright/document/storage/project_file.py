"""The project file, ``.meshwright``: a mesh with its whole history, branches, and settings.

It is a zip archive, as ``numpy.load`` reads it: ``project.json`` and one ``.npy`` for each array
(:mod:`meshwright_core.io.snapshot` lists them). Nothing in it is executed.
"""

import io
import json
import math
import os
import struct
import zipfile
import zlib
from pathlib import Path

import numpy as np

from meshwright.document.storage import document_state
from meshwright.document.storage.document_state import DocumentState
from meshwright_core import MeshError
from meshwright_core.io.atomic_write import replacing
from meshwright_core.io.file_checks import naming
from meshwright_core.io.stored_arrays import KINDS, Arrays

ENDING = ".meshwright"
_HEADER = "project.json"
_FORMAT = "Meshwright project"
_MOST_BYTES = 8 << 30
_SPARE_BYTES, _MOST_RATIO = 16 << 20, 100
"""A project that takes more bytes than these, and more than so many times its file, is none of
ours: the arrays of a mesh are not compressed to a hundredth.
"""
_SWIFT = 1  # compression level: higher ones take twice as long for files a tenth smaller
_BROKEN = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    KeyError,
    ValueError,
    NotImplementedError,
    RuntimeError,
    RecursionError,
    OverflowError,
    MemoryError,
)


def is_project(path: str | os.PathLike[str]) -> bool:
    """Whether the path has the ending of projects."""
    return Path(path).suffix.lower() == ENDING


def write(path: str | os.PathLike[str], kept: DocumentState) -> None:
    """Write a project atomically.

    Raises MeshError, one sentence that begins with the path, if the system refuses; an old file is
    then unchanged.
    """
    header, arrays = document_state.packed(kept)
    text = json.dumps({"format": _FORMAT, **header}, ensure_ascii=False)
    with (
        replacing(path) as temporary,
        zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=_SWIFT) as archive,
    ):
        archive.writestr(_HEADER, text)
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                plain = np.ascontiguousarray(array)
                np.lib.format.write_array(member, plain, (1, 0), allow_pickle=False)


def read(path: str | os.PathLike[str]) -> DocumentState:
    """Read a project; its `path` is where it was read from.

    Raises MeshError, one sentence that begins with the path, if the file is missing, no project,
    truncated, or does not hold a valid mesh.
    """
    place = Path(path)
    with naming(place):
        try:
            header, arrays = _members(place)
            if not isinstance(header, dict) or header.get("format") != _FORMAT:
                raise MeshError("it is not a Meshwright project")
            kept = document_state.unpacked(header, arrays)
        except MeshError:
            raise
        except _BROKEN as error:
            raise MeshError("it is not a Meshwright project, or not a whole one") from error
    return DocumentState(
        kept.mesh,
        kept.history,
        place.stem,
        place,
        (kept.history.mark, kept.history.given[0]),
        kept.settings,
    )


def _members(place: Path) -> tuple[object, Arrays]:
    with zipfile.ZipFile(place) as archive:
        members = {info.filename: info for info in archive.infolist()}
        size, packed = sum(info.file_size for info in members.values()), place.stat().st_size
        if size > min(_MOST_BYTES, _SPARE_BYTES + _MOST_RATIO * packed):
            raise MeshError("it is too large")
        header = json.loads(archive.read(_HEADER))
        arrays = {
            name.removesuffix(".npy"): _array(archive.read(name))
            for name in members
            if name.endswith(".npy")
        }
    return header, arrays


def _array(data: bytes) -> np.ndarray:
    """The array in the bytes of an .npy file of version 1; ValueError if it is none of ours."""
    stream = io.BytesIO(data)
    if np.lib.format.read_magic(stream) != (1, 0):
        raise ValueError("an array of another version")
    shape, by_columns, kind = np.lib.format.read_array_header_1_0(stream)
    native = kind.newbyteorder("=")
    if native not in KINDS or (by_columns and len(shape) > 1):
        raise ValueError("an array of another kind")
    if math.prod(shape) * kind.itemsize != len(data) - stream.tell():
        raise ValueError("an array of another length")
    found = np.frombuffer(data, kind, offset=stream.tell()).reshape(shape)
    return found.astype(native, copy=False)
