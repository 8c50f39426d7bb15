"""The triangles and quads of a mesh file as one content, and what changes it.

Every step takes a :class:`Content` and returns one, so that names, regions and parts go along.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.names import SEPARATOR, joined
from meshwright_core.errors import MeshError
from meshwright_core.io import cleaning, named_groups
from meshwright_core.io.content import Content, Names

Ints = NDArray[np.int64]

KINDS = ("triangle", "quad")


def restricted(content: Content, kept: dict[str, Ints]) -> Content:
    """The content with the cells of these types and rows only."""
    names = content.names
    if names is not None:
        elements = {k: row[kept[k]] for k, row in names.elements.items() if k in kept}
        names = replace(names, elements=elements)
    return content._replace(
        cells={kind: content.cells[kind][rows] for kind, rows in kept.items()},
        regions={
            k: np.asarray(v)[kept[k]] for k, v in (content.regions or {}).items() if k in kept
        },
        parts={k: v[kept[k]] for k, v in content.parts.items() if k in kept},
        names=names,
    )


def renumbered(content: Content, number: Ints, first: Ints) -> Content:
    """The content with other points: `number` (n,) is the new index of each old point, -1 for
    none; `first` (n',) is the old point that each new one is.
    """
    data = {
        name: np.asarray(values)[first]
        for name, values in content.data.items()
        if len(values) == len(number)
    }
    return content._replace(
        points=content.points[first],
        cells={kind: number[block] for kind, block in content.cells.items()},
        data=data,
        names=named_groups.renumbered(content.names, number),
    )


def surface_of(content: Content) -> Content:
    """The triangles and quads of a file, in space, on points that are there.

    Raises:
        MeshError: other cells, or none; an element of a point that is not in the file, or is not
            finite.
    """
    others = sorted(content.cells.keys() - {*KINDS, "vertex", "line"})
    counts = {kind: len(content.cells[kind]) for kind in others}
    if any(counts.values()):
        listed = " and ".join(f"{count} of type {kind}" for kind, count in counts.items() if count)
        raise MeshError(f"only triangles or quads can be edited, but it has cells: {listed}")
    kept = {k: np.arange(len(content.cells[k])) for k in KINDS if len(content.cells.get(k, ()))}
    if not kept:
        raise MeshError("it holds no triangles and no quads")
    content = restricted(content, kept)
    points = np.asarray(content.points, dtype=np.float64)
    if points.shape[1] < 3:
        points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
    for block in content.cells.values():
        cleaning.refuse_strays(points, block)
    return content._replace(points=points)


def compacted(content: Content) -> Content:
    """The content without points of no element; the order of the others stays."""
    used = np.zeros(len(content.points), dtype=bool)
    for block in content.cells.values():
        used[block] = True
    if used.all():
        return content
    number = np.where(used, np.cumsum(used) - 1, -1)
    return renumbered(content, number, np.flatnonzero(used))


def without_repeats(content: Content) -> Content:
    """The content with elements of the same corners once; their names are joined."""
    said = list(content.warnings)
    for kind, block in content.cells.items():
        order = np.sort(block, axis=1)
        _, first, inverse = np.unique(order, axis=0, return_index=True, return_inverse=True)
        if len(first) == len(block):
            continue
        repeated = len(block) - len(first)
        owner = first[inverse.ravel()]
        content = content._replace(names=_joined_names(content.names, kind, owner))
        rows = {k: np.arange(len(b)) for k, b in content.cells.items()}
        content = restricted(content, {**rows, kind: np.sort(first)})
        if not _overlapping(content.names, kind):
            noun, verb = (f"{kind}s", "are") if repeated > 1 else (kind, "is")
            said.append(f"{repeated} {noun} that {verb} there more than once {verb} read once")
    return content._replace(warnings=tuple(said))


def _overlapping(names: Names | None, kind: str) -> bool:
    """Whether cells are in several groups, for which files of Gmsh hold them more than once."""
    if names is None or kind not in names.elements:
        return False
    return any(SEPARATOR in name for name in names.regions)


def _joined_names(names: Names | None, kind: str, owner: Ints) -> Names | None:
    """The names with those of repeated cells (m,) joined at the first of them, `owner` (m,)."""
    if names is None or kind not in names.elements:
        return names
    row = names.elements[kind].copy()
    regions = list(names.regions)
    number = {name: i for i, name in enumerate(regions)}
    pairs = np.unique(np.column_stack([owner, row]), axis=0)
    cells, counts = np.unique(pairs[:, 0], return_counts=True)
    for cell in cells[counts > 1].tolist():
        text = joined(regions[i] for i in pairs[pairs[:, 0] == cell, 1].tolist() if i >= 0)
        if text and text not in number:
            number[text] = len(regions)
            regions.append(text)
        row[cell] = number.get(text, -1)
    return replace(names, regions=tuple(regions), elements={**names.elements, kind: row})
