"""Walks through the bytes of a file of lines, words and arrays, text or binary."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.numbers import CUT_OFF, Floats, Ints

_BLANK = ord(" ")
"""Bytes up to this one separate words."""
_SPACE = re.compile(rb"[\x00-\x20]")


class Words:
    """The bytes of a file and a place in them.

    Attributes:
        data: the bytes.
        at: the place.
        binary: whether arrays are binary.
        order: byte order of binary numbers, "<" or ">".
    """

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0
        self.binary, self.order = False, "<"

    def left(self) -> int:
        """Bytes that are left."""
        return max(0, len(self.data) - self.at)

    def line(self) -> str:
        """The rest of the line; empty at the end of the file."""
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        text = numbers.words_of(self.data[self.at : end]).rstrip("\r")
        self.at = end + 1
        return text

    def words(self) -> list[str]:
        """The words of the next line that has any; none at the end of the file."""
        while self.at < len(self.data):
            words = self.line().split()
            if words:
                return words
        return []

    def count_line(self, least: int = 1) -> int:
        """The count that stands alone on the next line, of things of at least so many bytes."""
        words = self.words()
        if not words:
            raise MeshError(CUT_OFF)
        return numbers.count_of(words[0], self.left() // least)

    def skip_past(self, mark: bytes) -> bool:
        """Go behind the next place where the mark stands; False if it does not."""
        found = self.data.find(mark, self.at)
        self.at = len(self.data) if found < 0 else found + len(mark)
        return found >= 0

    def skip_line_end(self) -> None:
        """Go behind blanks and line ends."""
        while self.at < len(self.data) and self.data[self.at] in b" \t\r\n":
            self.at += 1

    def text_to(self, mark: bytes) -> bytes:
        """The bytes up to a mark, or all that are left where it is missing."""
        found = self.data.find(mark, self.at)
        start, self.at = self.at, found if found >= 0 else len(self.data)
        return self.data[start : self.at]

    # -- arrays ------------------------------------------------------------------------------------

    def records(self, kind: np.dtype[Any], count: int) -> NDArray[Any]:
        """Binary records."""
        if count * kind.itemsize > self.left():
            raise MeshError(CUT_OFF)
        values = np.frombuffer(self.data, kind, count, self.at)
        self.at += values.nbytes
        return values

    def array(self, code: str, count: int) -> NDArray[np.generic]:
        """Binary numbers, of the file's byte order."""
        return self.records(np.dtype(self.order + code), count)

    def size(self, each: int = 0) -> int:
        """A number of 8 bytes, or a word; a count of things of so many bytes, if they are given."""
        value = int(self.ints("u8", 1)[0])
        return numbers.count_of(str(value), self.left() // each) if each else value

    def ints(self, code: str, count: int) -> Ints:
        """Whole numbers; the code is that of binary ones."""
        if self.binary:
            return self.array(code, count).astype(np.int64)
        return numbers.ints(self.text(count))

    def floats(self, count: int) -> Floats:
        """Numbers of double precision."""
        if self.binary:
            return self.array("f8", count).astype(np.float64)
        return numbers.floats(self.text(count))

    def text(self, count: int) -> bytes:
        """The text of the next so many words, which may stand on several lines."""
        start, missing = self.at, count
        while missing > 0:
            if self.at >= len(self.data) or 2 * missing - 1 > self.left() + 1:
                raise MeshError(CUT_OFF)
            # so many bytes, and the rest of a word that they end in, hold at most `missing` words
            end = min(len(self.data), self.at + 2 * missing - 1)
            if self.data[end - 1] > _BLANK:
                blank = _SPACE.search(self.data, end)
                end = blank.start() if blank else len(self.data)
            solid = np.frombuffer(self.data, np.uint8, end - self.at, self.at) > _BLANK
            missing -= int(solid[0]) + int(np.count_nonzero(solid[1:] & ~solid[:-1]))
            self.at = end
        return self.data[start : self.at]
