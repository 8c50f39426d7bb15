"""Abaqus input files: names are element sets, and for sides surfaces and node sets."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from meshwright_core.core.names import groups
from meshwright_core.io.content import Content
from meshwright_core.io.named_groups import group_edges, group_rows
from meshwright_core.io.writers import lines as form

_A_LINE = 16


def spelling(sides: Sequence[str], regions: Sequence[str]) -> dict[str, str]:
    """The label of each group of regions and sides."""
    return form.words(dict.fromkeys(group for name in (*regions, *sides) for group in groups(name)))


def write(content: Content) -> str:
    """Return the content as an Abaqus input file of shell elements, S3 or S4.

    A side is a surface of the edges E1 to E4 of its elements, and a node set of the same name.
    """
    kind, elements = form.block(content)
    names = form.names(content)
    lines = [form.head(content, "**"), "*NODE"]
    lines += [f"{i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in form.numbered(content.points)]
    lines += [f"*ELEMENT, TYPE=S{elements.shape[1]}"]
    lines += [f"{i}, {', '.join(map(str, nodes))}" for i, nodes in form.numbered(elements + 1)]
    rows, sides = group_rows(names, kind), group_edges(names)
    label = form.words(dict.fromkeys([*rows, *sides]))
    for name, members in rows.items():
        lines += [f"*ELSET, ELSET={label[name]}", *_listed(members + 1)]
    for name, edges in sides.items():
        lines += [f"*NSET, NSET={label[name]}", *_listed(np.unique(edges) + 1)]
    start, end = elements, np.roll(elements, -1, axis=1)
    count = len(content.points)
    key = (np.minimum(start, end) * count + np.maximum(start, end)).ravel()
    order = np.argsort(key, kind="stable")
    for name, edges in sides.items():
        wanted = edges.min(axis=1) * count + edges.max(axis=1)
        there = order[np.searchsorted(key[order], wanted)]
        element, place = np.divmod(there, elements.shape[1])
        lines.append(f"*SURFACE, TYPE=ELEMENT, NAME={label[name]}")
        pairs = zip(element.tolist(), place.tolist(), strict=True)
        lines += [f"{one + 1}, E{edge + 1}" for one, edge in pairs]
    return form.text(lines)


def _listed(numbers: np.ndarray) -> list[str]:
    shown = [str(number) for number in numbers.tolist()]
    return [", ".join(shown[i : i + _A_LINE]) for i in range(0, len(shown), _A_LINE)]
