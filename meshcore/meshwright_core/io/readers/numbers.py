"""Text and numbers of mesh files, with every count checked against the bytes that are there."""

from __future__ import annotations

import codecs
import re
import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CUT_OFF = "it is cut off"
_FORTRAN = re.compile(rb"(?<=[\d.])[dD](?=[-+]?\d)")
_DECIMAL_COMMA = re.compile(rb"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")
_END = 64
_WIDE = 2**53
"""Whole numbers beyond this are not exact as floating point numbers."""


def without_mark(data: bytes) -> bytes:
    """The bytes without a byte order mark; UTF-16 text becomes UTF-8."""
    if data.startswith(codecs.BOM_UTF8):
        return data[len(codecs.BOM_UTF8) :]
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        try:
            return data.decode("utf-16").encode()
        except UnicodeDecodeError:
            return data
    return data


def text_of(data: bytes) -> bytes:
    """The bytes of a text file with lines that end in a line feed, without a byte order mark.

    Bytes that DOS and some writers put behind the text (end of file, zeros) are left.
    """
    data = without_mark(data)
    if b"\x1a" in data[-_END:] or b"\0" in data[-_END:]:
        data = data.rstrip(b"\x1a\0\r\n")
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in data else data


def words_of(data: bytes) -> str:
    """Bytes as text: UTF-8, or Latin-1 where they are not."""
    try:
        return data.decode()
    except UnicodeDecodeError:
        return data.decode("latin-1")


def floats(text: bytes) -> Floats:
    """The numbers of a text, separated by blanks or line ends; MeshError if it holds others."""
    return np.asarray(_numbers(text, np.float64))


def ints(text: bytes) -> Ints:
    """The whole numbers of a text; "3.0" is one; MeshError if it holds others."""
    try:
        return np.asarray(_numbers(text, np.int64))
    except MeshError:
        return whole(_numbers(text, np.float64))


def _numbers(text: bytes, kind: type) -> NDArray[np.generic]:
    if not text.strip():
        return np.zeros(0, kind)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return np.fromstring(text, kind, sep=" ")
        except (ValueError, DeprecationWarning, RuntimeWarning):
            pass
        if kind is np.float64 and _FORTRAN.search(text):
            return _numbers(_FORTRAN.sub(b"e", text), kind)
    odd = _odd(text)
    if _DECIMAL_COMMA.fullmatch(odd):
        raise MeshError(f"its numbers have decimal commas, as in {_shown(odd)}: they need points")
    raise MeshError(f"it is damaged: there is no number in {_shown(odd)}")


def _odd(text: bytes) -> bytes:
    """The first word of a text that is no number."""
    for word in text.split():
        try:
            float(word)
        except ValueError:
            return word
    return text.split()[0]


def whole(values: NDArray[np.generic]) -> Ints:
    """Numbers as whole numbers; MeshError if they are none."""
    if values.dtype.kind in "iu":
        return values.astype(np.int64)
    with np.errstate(invalid="ignore"):
        good = (np.abs(values) <= _WIDE) & (values == np.floor(values))
    if not good.all():
        odd = values.flat[np.argmin(good)]
        raise MeshError(f"it is damaged: {odd:g} stands where a whole number belongs")
    return values.astype(np.int64)


def count_of(word: bytes | str, most: int) -> int:
    """A count that a file announces; MeshError if it is none, or more than `most` things fit."""
    shown = _shown(word if isinstance(word, bytes) else word.encode())
    try:
        count = int(word)
    except ValueError as error:
        raise MeshError(
            f"it is damaged: {shown} stands where a number of things belongs"
        ) from error
    if count < 0:
        raise MeshError(f"it is damaged: it announces {shown} things")
    if count > most:
        raise MeshError(
            f"{CUT_OFF} or damaged: it announces {shown} things, for which it is too short"
        )
    return count


def prefixed(flat: Ints, count: int) -> list[tuple[Ints, Ints]]:
    """Lists that are each preceded by their length, by length: (rows, members).

    flat: the lengths and lists end to end, and nothing after them. Returns for each length the
    numbers of its lists among all and their members (m, length).
    """
    if count == 0:
        return []
    size = int(flat[0]) if len(flat) else 0
    if 0 < size < len(flat) and len(flat) == count * (size + 1):
        table = flat.reshape(count, size + 1)
        if (table[:, 0] == size).all():
            return [(np.arange(count), table[:, 1:])]
    starts, at = np.empty(count, np.int64), 0
    values = flat.tolist()
    for i in range(count):
        starts[i] = at
        if at >= len(values) or values[at] < 0:
            raise MeshError(f"{CUT_OFF} or damaged: a list of points has no sound length")
        at += values[at] + 1
    if at > len(values):
        raise MeshError(f"{CUT_OFF} within a list of points")
    return by_length(flat, starts + 1, flat[starts])


def by_length(flat: Ints, starts: Ints, lengths: Ints) -> list[tuple[Ints, Ints]]:
    """Lists in `flat` that begin at `starts`, grouped by length: (rows, members (m, length))."""
    found = []
    for length in np.unique(lengths).tolist():
        rows = np.flatnonzero(lengths == length)
        found.append((rows, flat[starts[rows, None] + np.arange(length)]))
    return found


def joined_lines(lines: Sequence[bytes]) -> bytes:
    """Lines as one text, commas as blanks."""
    return b"\n".join(lines).replace(b",", b" ")


def _shown(text: bytes) -> str:
    shown = words_of(text[:40])
    return repr(shown if len(text) <= 40 else shown[:37] + "...")
