"""SU2 files: names of sides are markers."""

from __future__ import annotations

from collections.abc import Sequence

from meshwright_core.core.names import SEPARATOR
from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.named_groups import UNNAMED
from meshwright_core.io.writers import lines as form


def spelling(sides: Sequence[str], regions: Sequence[str]) -> dict[str, str]:
    """The marker of each name of sides; regions have none."""
    joined = {name: name.replace(SEPARATOR + " ", "&") for name in sides}
    marker = form.words(dict.fromkeys(joined.values()))
    return {name: marker[one] for name, one in joined.items()}


def write(content: Content) -> str:
    """Return a mesh in the plane z = 0 as an SU2 file.

    Every edge of the boundary is in one marker: "unnamed" where it has no name. Several names of
    an edge make one marker, joined by "&".
    """
    if content.points[:, 2].any():
        raise MeshError("an SU2 file holds no surface out of the plane z = 0")
    kind, elements = form.block(content)
    code = {"triangle": 5, "quad": 9}[kind]
    names = form.names(content)
    marker = spelling(names.sides, ())
    spelled = [marker[name] for name in names.sides]
    key = {tuple(sorted(ends)): spelled[side] for ends, side in zip(
        names.edges.tolist(), names.edge_sides.tolist(), strict=True
    )}  # fmt: skip
    markers: dict[str, list[list[int]]] = {name: [] for name in spelled}
    for ends in form.rim(elements).tolist():
        markers.setdefault(key.pop(tuple(sorted(ends)), UNNAMED), []).append(ends)
    for ends, name in key.items():  # of interfaces
        markers[name].append(list(ends))
    lines = [form.head(content, "%"), "NDIME= 2", f"NELEM= {len(elements)}"]
    lines += [
        f"{code} {' '.join(map(str, nodes))} {i}" for i, nodes in enumerate(elements.tolist())
    ]
    lines += [f"NPOIN= {len(content.points)}"]
    lines += [f"{x!r} {y!r} {i}" for i, (x, y, _) in enumerate(content.points.tolist())]
    lines += [f"NMARK= {len(markers)}"]
    for name, edges in markers.items():
        lines += [f"MARKER_TAG= {name}", f"MARKER_ELEMS= {len(edges)}"]
        lines += [f"3 {a} {b}" for a, b in edges]
    return form.text(lines)
