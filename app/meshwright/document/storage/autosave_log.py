"""Append-only file of records with length and checksum, so that an incomplete end is detected.

A record is a header that JSON can hold and named arrays. On the disk: four letters, the length of
what follows the checksum, the checksum (CRC-32), then the length of a JSON text, the text, and the
arrays' bytes one after another. Everything is little-endian.
"""

import json
import math
import os
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.io.stored_arrays import KINDS, Arrays

_MARK = b"MWJR"
_FRAME = struct.Struct("<4sQI")
_LENGTH = struct.Struct("<I")
_KINDS = {kind.newbyteorder("<").str for kind in KINDS}


@dataclass(frozen=True)
class Record:
    """One record; ``arrays`` are views of the file's bytes."""

    header: dict[str, Any]
    arrays: Arrays


def encoded(header: dict[str, Any], arrays: Arrays) -> list[bytes | memoryview]:
    """A record as buffers to be written in order; arrays are not copied if possible."""
    plain = {name: _plain(array) for name, array in arrays.items()}
    table = [(name, array.dtype.str, array.shape) for name, array in plain.items()]
    text = json.dumps([header, table]).encode()
    body: list[bytes | memoryview] = [_LENGTH.pack(len(text)), text]
    body += [array.reshape(-1).view(np.uint8).data for array in plain.values() if array.size]
    checksum = 0
    for part in body:
        checksum = zlib.crc32(part, checksum)
    return [_FRAME.pack(_MARK, sum(map(len, body)), checksum), *body]


def records(path: Path) -> Iterator[Record]:
    """The records of a file, up to the first that is incomplete or damaged.

    Raises OSError if the file cannot be read.
    """
    with path.open("rb") as file:
        left = os.fstat(file.fileno()).st_size
        while len(frame := file.read(_FRAME.size)) == _FRAME.size:
            mark, length, checksum = _FRAME.unpack(frame)
            left -= _FRAME.size
            if mark != _MARK or length > left:
                return
            body = file.read(length)
            left -= length
            if len(body) != length or zlib.crc32(body) != checksum:
                return
            record = _decoded(body)
            if record is None:
                return
            yield record


def _decoded(body: bytes) -> Record | None:
    try:
        (length,) = _LENGTH.unpack_from(body)
        at = _LENGTH.size + length
        header, table = json.loads(body[_LENGTH.size : at])
        arrays = {}
        for name, kind, shape in table:
            if kind not in _KINDS:
                return None
            count = math.prod(shape)
            arrays[name] = np.frombuffer(body, kind, count, at).reshape(shape)
            at += arrays[name].nbytes
    except (ValueError, TypeError, struct.error, RecursionError, OverflowError):
        return None
    return Record(header, arrays) if isinstance(header, dict) else None


def _plain(array: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(array, array.dtype.newbyteorder("<"))
