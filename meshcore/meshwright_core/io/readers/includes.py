"""Text files that name others whose lines belong in their place, as Abaqus and Nastran decks do."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from meshwright_core.errors import MeshError
from meshwright_core.io.readers import numbers

Included = Callable[[str], tuple[str, str] | None]
"""From a line to what stays of it and the name of the file that follows; None for other lines."""

_MOST_FILES = 200
_LARGEST = 2**32
"""Bytes of all files together."""


class _Expansion:
    def __init__(self, folder: Path, starts: re.Pattern[bytes], included: Included) -> None:
        self.folder, self.starts, self.included = folder, starts, included
        self.files, self.size = 0, 0

    def text(self, path: Path, within: tuple[Path, ...]) -> bytes:
        """The text of a file with the text of others in the place of the lines that name them."""
        if path in within:
            raise MeshError(f"the file {path.name[:60]!r} includes itself")
        self.files += 1
        self.size += path.stat().st_size
        if self.files > _MOST_FILES or self.size > _LARGEST:
            raise MeshError(f"it includes more than {_MOST_FILES} files or {_LARGEST} bytes")
        text = numbers.text_of(path.read_bytes())
        parts: list[bytes] = []
        done = 0
        for found in self.starts.finditer(text):
            start = text.rfind(b"\n", 0, found.start()) + 1
            stop = text.find(b"\n", found.end())
            stop = len(text) if stop < 0 else stop
            kept = self.included(numbers.words_of(text[start:stop]))
            if kept is None or start < done:
                continue
            line, name = kept
            inner = self.text(self.beside(name, path.parent), (*within, path))
            parts += [text[done:start], line.encode(), b"\n" if line else b"", inner.rstrip(b"\n")]
            done = stop
        return b"".join([*parts, text[done:]])

    def beside(self, name: str, near: Path) -> Path:
        """The file of this name, in the folder of the first file or below it."""
        for folder in (near, self.folder):
            try:
                path = (folder / name.replace("\\", "/")).resolve()
                if path.is_relative_to(self.folder) and path.is_file():
                    return path
            except (OSError, ValueError):  # a name that no file can have
                continue
        raise MeshError(f"it includes the file {name[:60]!r}, which is not beside it")


def expanded(path: Path, starts: re.Pattern[bytes], included: Included) -> bytes:
    """The text of a file with the lines of the files that it includes, and that these include.

    starts: finds the beginning of a line that may include a file; only such lines are looked at.

    Raises:
        MeshError: an included file is not in the folder of the first one or below it, includes
            itself, or they are too many.
    """
    path = path.resolve()
    return _Expansion(path.parent, starts, included).text(path, ())
