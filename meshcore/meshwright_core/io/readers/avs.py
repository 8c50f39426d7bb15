"""AVS UCD files (.avs), text: points, cells with their material, and data."""

from __future__ import annotations

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.fields import OURS
from meshwright_core.io.readers.numbers import CUT_OFF

_KINDS = {"pt": ("vertex", 1), "line": ("line", 2), "tri": ("triangle", 3), "quad": ("quad", 4),
          "tet": ("tetra", 4), "pyr": ("pyramid", 5), "prism": ("wedge", 6),
          "hex": ("hexahedron", 8)}  # fmt: skip


def read(data: bytes) -> Content:
    """Return the content of an AVS UCD file; the material of a cell is its region."""
    lines = [line for line in numbers.text_of(data).split(b"\n") if line.strip()]
    at = 0
    while at < len(lines) and lines[at].lstrip().startswith(b"#"):
        at += 1
    head = lines[at].split() if at < len(lines) else []
    if len(head) < 3:
        raise MeshError("its first line is not that of an AVS UCD file")
    count, cells = (numbers.count_of(word, len(lines) - at - 1) for word in head[:2])
    width = numbers.count_of(head[2], 2**31)
    at += 1
    if count + cells > len(lines) - at:
        raise MeshError(f"{CUT_OFF}: {count} points and {cells} cells are announced")
    build = Builder()
    build.part()
    flat = numbers.floats(b"\n".join(lines[at : at + count]))
    if len(flat) != 4 * count:
        raise MeshError(f"{CUT_OFF} or damaged: {count} points are announced")
    table = flat.reshape(-1, 4)
    ids = numbers.whole(table[:, 0])
    build.points(table[:, 1:], ids)
    _cells(build, lines[at + count : at + count + cells])
    at += count + cells
    if width:
        _data(build, lines[at:], ids)
    if len(head) > 3 and head[3] != b"0":
        build.dropped.append("cell data")
    return build.content()


def _cells(build: Builder, lines: list[bytes]) -> None:
    rows: dict[str, list[bytes]] = {}
    for line in lines:
        words = line.split(None, 3)
        if len(words) < 4:
            raise MeshError(f"{CUT_OFF} within its cells")
        rows.setdefault(words[2].decode("latin-1").lower(), []).append(words[1] + b" " + words[3])
    found = []
    for name, texts in rows.items():
        kind, nodes = _KINDS.get(name, (f"type {name[:10]}", 0))
        if nodes == 0:
            build.cells(kind, np.zeros((len(texts), 1)))
            continue
        flat = numbers.ints(b"\n".join(texts))
        if len(flat) != (nodes + 1) * len(texts):
            raise MeshError(f"it is damaged: a cell {name!r} has not {nodes} points")
        table = flat.reshape(-1, nodes + 1)
        found.append((build.cells(kind, table[:, 1:]), table[:, 0], kind))
    surface = [m for _, m, kind in found if kind in ("triangle", "quad")]
    several = len(surface) > 0 and len(np.unique(np.concatenate(surface))) > 1
    for placed, materials, kind in found:
        for value in np.unique(materials).tolist():
            if (kind == "line" and value) or (several and kind != "line"):
                keep = [
                    one._replace(rows=one.rows[materials[one.which] == value]) for one in placed
                ]
                build.group(f"material={value}", keep, value)


def _data(build: Builder, lines: list[bytes], ids: np.ndarray) -> None:
    """Our own data by point; the names of others are noted. The file ends within them or not."""
    if not lines:
        raise MeshError(f"{CUT_OFF}: its data by point are missing")
    head = numbers.ints(lines[0]).tolist()
    count = head[0] if head else 0
    if count < 0 or len(head) != count + 1 or len(lines) < 1 + count + len(ids):
        raise MeshError(f"{CUT_OFF}: its data by point are missing")
    names = [numbers.words_of(line).partition(",")[0].strip() for line in lines[1 : 1 + count]]
    wanted = [name for name in names if name in OURS]
    build.dropped += [f"point data {name!r}" for name in names if name not in OURS]
    if not wanted or any(size != 1 for size in head[1:]):
        return
    flat = numbers.floats(b"\n".join(lines[1 + count : 1 + count + len(ids)]))
    if len(flat) != (count + 1) * len(ids):
        raise MeshError(f"{CUT_OFF}: its data by point are missing")
    table = flat.reshape(-1, count + 1)
    place = build.index(numbers.whole(table[:, 0]))
    if (np.sort(place) != np.arange(len(ids))).any():
        return
    for i, name in enumerate(names):
        if name in OURS:
            build.data[name] = np.empty(len(ids))
            build.data[name][place] = table[:, 1 + i]
