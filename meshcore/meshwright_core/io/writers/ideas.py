"""Universal files of I-DEAS: nodes, thin shells, beams on named sides, and groups of both."""

from __future__ import annotations

import numpy as np

from meshwright_core.core.names import numbered
from meshwright_core.io.content import Content
from meshwright_core.io.named_groups import group_edges, group_rows, region_groups
from meshwright_core.io.writers import lines as form

_SHELL = {"triangle": 91, "quad": 94}
_BEAM = 21
_NODE, _PLACE = "%10d         1         1        11", "%25.16E%25.16E%25.16E"
_ELEMENT = 8
"""The code of elements in groups."""


def write(content: Content) -> str:
    """Return the content as a universal file of the datasets 2411, 2412 and 2467."""
    kind, elements = form.block(content)
    names = form.names(content)
    lines = ["    -1", "  2411"]
    for i, point in form.numbered(content.points):
        lines += [_NODE % i, (_PLACE % tuple(point)).replace("E", "D")]
    lines += ["    -1", "    -1", "  2412"]
    edges, place = np.unique(np.sort(names.edges, axis=1), axis=0, return_inverse=True)
    if len(edges):
        edges = names.edges[np.unique(place.ravel(), return_index=True)[1]]
    owner = region_groups(content, kind, len(elements)).numbers()
    for i, nodes in enumerate((edges + 1).tolist(), start=1):
        lines += [_row(i, _BEAM, 1, 1, 7, 2), _row(0, 0, 0), _row(*nodes)]
    first = len(edges) + 1
    shell = f"%10d{_row(_SHELL[kind])}%10d{_row(1, 7, elements.shape[1])}"
    corners = "%10d" * elements.shape[1]
    for i, (nodes, own) in enumerate(
        zip((elements + 1).tolist(), owner.tolist(), strict=True), start=first
    ):
        lines += [shell % (i, own), corners % tuple(nodes)]
    lines.append("    -1")
    row = {tuple(pair): i for i, pair in enumerate(np.sort(edges, axis=1).tolist())}
    members = {
        name: np.array([row[a, b] for a, b in np.sort(ends, axis=1).tolist()]) + 1
        for name, ends in group_edges(names).items()
    }
    for name, rows in group_rows(names, kind).items():
        called = numbered(name)
        if called is None or called[0] != "property":
            members[name] = np.concatenate([members.get(name, rows[:0]), rows + first])
    if members:
        lines += ["    -1", "  2467", *_groups(members), "    -1"]
    return form.text(lines)


def _groups(members: dict[str, np.ndarray]) -> list[str]:
    lines = []
    for number, (name, ids) in enumerate(members.items(), start=1):
        lines += [_row(number, 0, 0, 0, 0, 0, 0, len(ids)), " ".join(name.split())]
        shown = [f"{_row(_ELEMENT, one, 0, 0)}" for one in ids.tolist()]
        lines += ["".join(shown[i : i + 2]) for i in range(0, len(shown), 2)]
    return lines


def _row(*values: int) -> str:
    return "".join(f"{value:10d}" for value in values)
