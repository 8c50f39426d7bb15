"""The parts of a mesh file: those that it names, or else its connected components."""

from __future__ import annotations

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.surface import Ints, compacted, restricted
from meshwright_core.io.welding import components

_LISTED = 6


def part_names(content: Content) -> list[str]:
    """The names of the parts that can be chosen: those of the file, if it has several, else the
    connected components, "part 1" and so on.
    """
    return list(_parts(content))


def _parts(content: Content) -> dict[str, dict[str, Ints]]:
    """The rows of each part by type of cell."""
    used = sorted(
        {int(p) for kind in content.cells for p in np.unique(content.parts.get(kind, ()))}
    )
    found: dict[str, dict[str, Ints]] = {}
    if len(used) > 1:
        for order, part in enumerate(used, start=1):
            name = content.part_names[part] or f"part {order}"
            name = name if name not in found else f"{name} ({order})"
            found[name] = {
                kind: np.flatnonzero(content.parts[kind] == part) for kind in content.cells
            }
        return found
    label = components(content)
    assert label is not None
    rows = {kind: label[block[:, 0]] for kind, block in content.cells.items()}
    several = np.unique(np.concatenate(list(rows.values())))
    for order, part in enumerate(several.tolist(), start=1):
        found[f"part {order}"] = {kind: np.flatnonzero(row == part) for kind, row in rows.items()}
    return found


def one_part(content: Content, wanted: str) -> Content:
    """The content of one part, by its name or its number from 1.

    Raises:
        MeshError: there is none; the message lists those that there are.
    """
    parts = _parts(content)
    names = list(parts)
    found = next((n for n in names if n == wanted), None) or next(
        (n for n in names if n.casefold() == wanted.casefold()), None
    )
    if found is None and wanted.isdigit() and len(wanted) < 9 and 1 <= int(wanted) <= len(names):
        found = names[int(wanted) - 1]
    if found is None:
        raise MeshError(f"there is no part {wanted!r}: there {listed_parts(content)}")
    kept = {kind: rows for kind, rows in parts[found].items() if len(rows)}
    return compacted(restricted(content, kept))


def listed_parts(content: Content) -> str:
    """``are 2 parts: wing (12 quads), flap (8 quads)``."""
    parts = _parts(content)
    words = []
    for name, rows in list(parts.items())[:_LISTED]:
        counts = [
            f"{len(row)} {kind}{'' if len(row) == 1 else 's'}"
            for kind, row in rows.items()
            if len(row)
        ]
        words.append(f"{name} ({', '.join(counts)})")
    more = f" and {len(parts) - _LISTED} more" if len(parts) > _LISTED else ""
    if len(parts) == 1:
        return f"is 1 part: {words[0]}"
    return f"are {len(parts)} parts: {', '.join(words)}{more}"
