"""What writers of text formats share."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from meshwright_core.io.content import Content, Names

_ODD = re.compile(r"[^\w.+\-=&:@]+")


def block(content: Content) -> tuple[str, NDArray[np.int64]]:
    """The only kind of cells, and these cells."""
    ((kind, elements),) = content.cells.items()
    return kind, elements


def names(content: Content) -> Names:
    """The names, none if there are none."""
    return content.names or Names()


def numbered(array: NDArray[np.generic]) -> enumerate[list[float]]:
    """The rows with their numbers from 1."""
    return enumerate(array.tolist(), start=1)


def head(content: Content, comment: str) -> str:
    """The line from which a reader knows how many points and elements there are to be."""
    elements = block(content)[1]
    return f"{comment} Meshwright: {len(content.points)} points, {len(elements)} elements"


def word(name: str) -> str:
    """A name as one word, for formats where blanks end it: other signs become underscores."""
    return _ODD.sub("_", name).strip("_") or "_"


def cut(name: str, bytes_of_it: int) -> bytes:
    """The first bytes of a name, whole letters only."""
    return name.encode()[:bytes_of_it].decode(errors="ignore").encode()


def words(all_names: Iterable[str]) -> dict[str, str]:
    """A different word for each name."""
    found: dict[str, str] = {}
    taken: set[str] = set()
    for name in all_names:
        plain = text = word(name)
        number = 1
        while text.upper() in taken:
            number += 1
            text = f"{plain}_{number}"
        taken.add(text.upper())
        found[name] = text
    return found


def rim(elements: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n, 2) the boundary edges, the elements on their left."""
    ends = np.stack([elements, np.roll(elements, -1, axis=1)], axis=2).reshape(-1, 2)
    _, where, times = np.unique(
        np.sort(ends, axis=1), axis=0, return_index=True, return_counts=True
    )
    return ends[np.sort(where[times == 1])]


def text(lines: list[str]) -> str:
    """The lines as the text of a file."""
    return "\n".join(lines) + "\n"
