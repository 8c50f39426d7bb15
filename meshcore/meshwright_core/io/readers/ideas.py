"""Universal files of I-DEAS and Salome (.unv): nodes, elements and groups.

After the descriptions of the universal datasets 2411 (nodes), 2412 (elements) and 2467, 2477, 2452
and 2435 (groups) by the SDRC of the University of Cincinnati. Other datasets are left out, and
noted.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.fields import contents_of
from meshwright_core.io.readers.numbers import CUT_OFF, Ints

_KINDS = {
    **dict.fromkeys((41, 51, 61, 71, 74, 81, 91), ("triangle", 1)),
    **dict.fromkeys((42, 52, 62, 72, 82, 92), ("triangle", 2)),
    **dict.fromkeys((44, 54, 64, 84, 94), ("quad", 1)),
    **dict.fromkeys((45, 55, 65, 75, 85, 95), ("quad", 2)),
    **dict.fromkeys((11, 21, 22, 23), ("line", 1)), 24: ("line", 2),
    111: ("tetra", 1), 118: ("tetra", 1), 112: ("wedge", 1), 113: ("wedge", 1), 114: ("pyramid", 1),
    115: ("hexahedron", 1), 116: ("hexahedron", 1),
}  # fmt: skip
"""Kind of an element by its descriptor, and the step between its corners: parabolic ones list nodes
around their rim.
"""
_BEAMS = frozenset({11, 21, 22, 23, 24})
"""Elements with a line on their cross-section before that of their nodes."""
_POINTS = frozenset({121, 122, 136, 137, 138, 139, 141, 151, 152, 161, 171})
"""Springs, masses, constraints: neither sides nor surfaces."""
_GROUPS = frozenset({2429, 2430, 2432, 2435, 2452, 2467, 2477})
_PAIRS = frozenset({2429, 2430, 2432})
"""Datasets of groups with two numbers for each member; in others it has four."""
_SILENT = frozenset({151, 164, 2420})
"""Header, units, coordinate systems."""
_NODES, _ELEMENTS = 2411, 2412
_A_LINE = 8


def read(data: bytes) -> Content:
    """Return the content of a universal file.

    Raises:
        MeshError: nodes and elements of old datasets, other coordinate systems, or damage.
    """
    build = Builder()
    build.part()
    others: set[str] = set()
    tables = _datasets(numbers.text_of(data))
    if not any(number == _NODES for number, _ in tables):
        raise MeshError(f"it has no nodes: no dataset {_NODES}")
    owners: list[tuple[list, Ints]] = []
    grouped = False
    for wanted in (_NODES, _ELEMENTS, 0):
        for number, lines in tables:
            if number == wanted == _NODES:
                _nodes(build, lines)
            elif number == wanted == _ELEMENTS:
                owners += _elements(build, lines)
            elif wanted == 0 and number in _GROUPS:
                grouped |= _groups(build, lines, 2 if number in _PAIRS else 4)
            elif wanted == 0 and number not in _SILENT | {_NODES, _ELEMENTS}:
                others.add(f"dataset {number}")
    if not grouped:
        _name_properties(build, owners)
    if others:
        build.dropped.append(contents_of(others))
    return build.content()


def _datasets(text: bytes) -> list[tuple[int, list[bytes]]]:
    """Number and lines of each dataset; it stands between lines of "-1"."""
    lines = text.split(b"\n")
    marks = [i for i, line in enumerate(lines) if line.strip() == b"-1"]
    if not marks:
        raise MeshError("it is no universal file: no line is -1")
    if len(marks) % 2:
        raise MeshError(f"{CUT_OFF}: its last dataset does not end")
    found = []
    for start, stop in zip(marks[::2], marks[1::2], strict=True):
        if stop < start + 2:
            continue
        word = lines[start + 1].split()[:1] or [b"?"]
        # binary datasets have a "b" behind their number
        found.append((numbers.count_of(word[0].rstrip(b"b"), 10**6), lines[start + 2 : stop]))
    return found


def _nodes(build: Builder, lines: list[bytes]) -> None:
    if len(lines) % 2:
        raise MeshError(f"{CUT_OFF} within its nodes")
    heads = numbers.ints(b"\n".join(lines[::2]))
    flat = numbers.floats(b"\n".join(lines[1::2]))
    count = len(lines) // 2
    if len(heads) != 4 * count or len(flat) != 3 * count:
        raise MeshError("it is damaged: a node is not understood")
    table = heads.reshape(-1, 4)
    build.points(flat.reshape(-1, 3), table[:, 0])


def _elements(build: Builder, lines: list[bytes]) -> list[tuple[list, Ints]]:
    """Add the elements; return where they went, with the number of the property of each."""
    rows: dict[tuple[int, int], list[bytes]] = {}
    at = 0
    while at < len(lines):
        head = lines[at].split()
        try:
            code, count = int(head[1]), int(head[5])
        except (IndexError, ValueError) as error:
            raise MeshError("it is damaged: an element is not understood") from error
        first = at + (2 if code in _BEAMS else 1)
        at = first + -(-count // _A_LINE)
        if not 1 <= count <= 64 or at > len(lines):
            raise MeshError(f"{CUT_OFF} or damaged: an element of {count} nodes")
        row = b" ".join([head[0], head[2], *lines[first:at]])
        rows.setdefault((code, count), []).append(row)
    found = []
    for (code, count), texts in rows.items():
        if code in _POINTS:
            build.dropped.append(f"the elements with the descriptor {code}")
            continue
        if code not in _KINDS:
            build.cells(f"descriptor {code}", np.zeros((len(texts), 1)))
            continue
        flat = numbers.ints(b"\n".join(texts))
        if len(flat) != (count + 2) * len(texts):
            raise MeshError(f"it is damaged: an element has not {count} nodes")
        table = flat.reshape(-1, count + 2)
        kind, step = _KINDS[code]
        nodes = table[:, 2:]
        if step == 2:  # the corners first, as everywhere else
            nodes = np.concatenate([nodes[:, ::2], nodes[:, 1::2]], axis=1)
        found.append((build.cells(kind, nodes, table[:, 0]), table[:, 1]))
    return found


def _groups(build: Builder, lines: list[bytes], width: int) -> bool:
    """Name elements and nodes by the groups of a dataset; whether a group has elements."""
    at, any_elements = 0, False
    while at + 1 < len(lines):
        head = numbers.ints(lines[at])
        if not len(head):
            raise MeshError("it is damaged: a group is not understood")
        count = numbers.count_of(str(int(head[-1])), _A_LINE * len(lines))
        name = numbers.words_of(lines[at + 1]).strip() or f"group {head[0]}"
        stop = at + 2 + -(-count * width // _A_LINE)
        flat = numbers.ints(b"\n".join(lines[at + 2 : stop]))
        if len(flat) != width * count:
            raise MeshError(f"{CUT_OFF} or damaged: the group {name[:40]!r}")
        table = flat.reshape(-1, width)
        elements = table[table[:, 0] == 8, 1]
        if len(elements):
            placed = build.elements(elements)
            any_elements |= any(one.kind in ("triangle", "quad") for one in placed)
            build.group(name, placed)
        nodes = table[table[:, 0] == 7, 1]
        if len(nodes):
            build.node_set(name, nodes)
        at = stop
    return any_elements


def _name_properties(build: Builder, owners: list[tuple[list, Ints]]) -> None:
    """Where no group names elements, their properties are regions, if there are several."""
    surface = [
        (placed, numbers_of)
        for placed, numbers_of in owners
        if any(one.kind in ("triangle", "quad") for one in placed)
    ]
    used = np.unique(np.concatenate([np.zeros(0, np.int64), *(n for _, n in surface)]))
    for number in used.tolist() if len(used) > 1 else ():
        for placed, numbers_of in surface:
            mine = [one._replace(rows=one.rows[numbers_of[one.which] == number]) for one in placed]
            build.group(f"property={number}", mine, number)
