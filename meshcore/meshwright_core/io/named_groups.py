"""Names between mesh files and meshes: :class:`Names` of a file to regions and sides, and back."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core import names as texts
from meshwright_core.core.construction import twins_of
from meshwright_core.core.side_names import Names as MeshNames
from meshwright_core.io.content import Content, Names
from meshwright_core.mesh import HalfEdgeMesh

UNNAMED = "unnamed"
"""What sides and regions without a name are called in files where all must have one."""

Ints = NDArray[np.int64]


class Named(NamedTuple):
    """The regions and names of a mesh that is to be built."""

    regions: Ints | None
    """(m,) the region of each element, from 0; None if there is one only, without a name."""
    names: MeshNames
    warnings: list[str]
    """What could not be kept, a sentence each."""


def unique_pairs(
    first: NDArray[Any], second: NDArray[np.int64]
) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """The different pairs (n, 2) of two columns (m,), in order, and which of them (m,) each is."""
    ones, one = np.unique(first, return_inverse=True)
    others, other = np.unique(second, return_inverse=True)
    keys, place = np.unique(one * len(others) + other, return_inverse=True)
    at, beside = np.divmod(keys, max(1, len(others)))
    return np.column_stack([ones[at], others[beside]]), place


def renumbered(names: Names | None, number: Ints) -> Names | None:
    """The names with other point indices: `number` (n,) maps the old ones to them, -1 for none."""
    if names is None:
        return None
    edges = number[names.edges]
    kept = (edges >= 0).all(axis=1) & (edges[:, 0] != edges[:, 1])
    points = {name: number[ids] for name, ids in names.points.items()}
    return replace(
        names,
        edges=edges[kept],
        edge_sides=names.edge_sides[kept],
        points={name: np.unique(ids[ids >= 0]) for name, ids in points.items()},
    )


def named(content: Content, kind: str, elements: Ints) -> Named:
    """Regions and names of elements (m, k) of this kind; their points are those of the content.

    An edge that has a name and lies within a region is kept where such edges cut it in parts: the
    parts become regions of the same name.
    """
    names = content.names or Names()
    regions, region_names = _regions(content, names, kind, len(elements))
    try:
        twin = twins_of(elements)
    except ValueError:  # building the mesh says it better
        return Named(regions, MeshNames(region_names), [])
    rows = np.zeros(len(elements), np.int64) if regions is None else regions
    sides = _sides(names, elements, twin, rows)
    rows, region_names, lost = _cut_apart(sides, elements, twin, rows, region_names)
    warnings = []
    for name in dict.fromkeys(lost):
        count = lost.count(name)
        lie = "edge lies" if count == 1 else "edges lie"
        warnings.append(
            f"{count} {lie} within a region and cut nothing off: the name {name!r} is lost there"
        )
    warnings += _lost_points(names, elements, sides)
    several = regions is not None or bool(rows.any()) or any(region_names)
    made = MeshNames(
        region_names if several else (),
        np.array(list(sides), np.int64).reshape(-1, 2),
        list(sides.values()),
        names.tags,
    )
    return Named(rows if several else None, made, warnings)


def _regions(
    content: Content, names: Names, kind: str, count: int
) -> tuple[Ints | None, list[str]]:
    """The region of each element by its number and name in the file, and the names of regions."""
    row = names.elements.get(kind, np.zeros(0, np.int64))
    row = np.where(row < 0, len(names.regions), row) if len(row) == count else np.zeros(count, int)
    spelled = [*names.regions, ""] if len(names.elements.get(kind, ())) == count else [""]
    number = np.asarray((content.regions or {}).get(kind, ()))
    whole = number.shape == (count,) and number.dtype.kind in "biuf"
    if not (whole and np.isfinite(number).all() and (number == np.rint(number)).all()):
        number = np.zeros(count)
    pairs, region = unique_pairs(number, row)
    found = [_bare(spelled[int(one)]) for _, one in pairs]
    if len(found) == 1 and not found[0]:
        return None, [""]
    return region.ravel().astype(np.int64), found


def _bare(name: str) -> str:
    """The name without what stands for none."""
    return texts.joined(group for group in texts.groups(name) if group != UNNAMED)


def _sides(names: Names, elements: Ints, twin: Ints, regions: Ints) -> dict[tuple[int, int], str]:
    """The name of each named edge by its ends, the smaller index first."""
    found: dict[tuple[int, int], list[str]] = {}
    edges = np.sort(names.edges, axis=1)
    for (a, b), side in zip(edges.tolist(), names.edge_sides.tolist(), strict=True):
        found.setdefault((a, b), []).extend(texts.groups(_bare(names.sides[side])))
    listed = {group for name in names.sides for group in texts.groups(name)}
    sets = {name: ids for name, ids in names.points.items() if name not in listed}
    if sets:
        start, end = elements.ravel(), np.roll(elements, -1, axis=1).ravel()
        region = regions.repeat(elements.shape[1])
        side = (twin < 0) | (region != region[np.maximum(twin, 0)])
        start, end = start[side], end[side]
        rim = np.union1d(start, end)
        for name, ids in sets.items():
            both = np.isin(start, ids) & np.isin(end, ids)
            if both.all() or _covers(ids, elements, rim):
                continue  # of all points, or of those of an area: it tells nothing of sides
            for a, b in zip(start[both].tolist(), end[both].tolist(), strict=True):
                there = found.setdefault((min(a, b), max(a, b)), [])
                there.append(name)
    return {ends: texts.joined(groups) for ends, groups in found.items() if groups}


def _covers(ids: Ints, elements: Ints, rim: Ints) -> bool:
    """Whether points are those of whole elements, some of them within: not all on the `rim`."""
    live = ids[np.isin(ids, elements)]
    if not len(np.setdiff1d(live, rim)):
        return False
    whole = np.isin(elements, live).all(axis=1)
    return bool(np.isin(live, elements[whole]).all())


def _cut_apart(
    sides: dict[tuple[int, int], str], elements: Ints, twin: Ints, regions: Ints, names: list[str]
) -> tuple[Ints, list[str], list[str]]:
    """Regions that named edges within them cut in parts, as one region a part.

    Returns the regions, their names, and the name of each edge within a region that cuts nothing.
    """
    if not sides:
        return regions, names, []
    k, m = elements.shape[1], len(elements)
    start, end = elements.ravel(), np.roll(elements, -1, axis=1).ravel()
    count = int(elements.max()) + 1
    ends = np.array(list(sides), np.int64)
    wanted = ends[:, 0] * count + ends[:, 1]
    wanted = np.where(ends[:, 1] < count, wanted, -1)
    key = np.minimum(start, end) * count + np.maximum(start, end)
    region = regions.repeat(k)
    within = (twin > np.arange(len(twin))) & (region == region[np.maximum(twin, 0)])
    marked = within & np.isin(key, wanted)
    if not marked.any():
        return regions, names, []
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    joint = np.flatnonzero(within & ~marked)
    one, other = joint // k, twin[joint] // k
    links = coo_array((np.ones(len(one), np.int8), (one, other)), shape=(m, m))
    part = connected_components(links, directed=False)[1].astype(np.int64)
    h = np.flatnonzero(marked)
    cut = part[h // k] != part[twin[h] // k]
    lost = [
        sides[int(min(a, b)), int(max(a, b))]
        for a, b in zip(start[h[~cut]], end[h[~cut]], strict=True)
    ]
    regions, names = regions.copy(), list(names)
    first: dict[int, int] = {}
    for piece in np.unique(np.concatenate([part[h[cut] // k], part[twin[h[cut]] // k]])).tolist():
        rows = part == piece
        own = int(regions[np.argmax(rows)])
        if first.setdefault(own, piece) != piece:
            regions[rows] = len(names)
            names.append(names[own])
    return regions, names, lost


def _lost_points(names: Names, elements: Ints, sides: dict[tuple[int, int], str]) -> list[str]:
    """A sentence for each set of points that names no side."""
    kept = {group for name in sides.values() for group in texts.groups(name)}
    kept |= {group for name in (*names.sides, *names.regions) for group in texts.groups(name)}
    live = np.unique(elements)
    said = []
    for name, ids in names.points.items():
        inside = np.isin(ids, live)
        if name in kept or not inside.any() or inside.sum() == len(live):
            continue
        count = int(inside.sum())
        points = "point" if count == 1 else "points"
        said.append(f"the set {name!r} of {count} {points} names no side: it is not kept")
    return said


def names_of(mesh: HalfEdgeMesh, number: Ints, kind: str) -> Names:
    """The names of a mesh; `number` (slots,) maps its vertices to the points of a file."""
    spelled = [name for name in dict.fromkeys(mesh.region_names) if name]
    order = {name: row for row, name in enumerate(spelled)}
    of_region = np.array([order.get(name, -1) for name in mesh.region_names], np.int64)
    sides = {name: ends for name, ends in mesh.sides().items() if name}
    edges = np.concatenate([np.zeros((0, 2), np.int64), *sides.values()])
    counts = [len(ends) for ends in sides.values()]
    return Names(
        tuple(order),
        {kind: of_region[mesh.regions()]} if order else {},
        tuple(sides),
        number[edges],
        np.repeat(np.arange(len(counts)), counts).astype(np.int64),
        {},
        dict(mesh.boundary_info.tags),
    )


class RegionGroups(NamedTuple):
    """The regions of a mesh that is written, told apart by their number and their name."""

    rows: list[int]
    """The row of each region's name, -1 for none."""
    keys: list[str]
    """The name of each, or "region=N"."""
    place: Ints
    """(m,) which of them each element is in."""
    tags: dict[str, int]
    """A number for each key, as :func:`tags_of` gives them."""

    def numbers(self) -> Ints:
        """(m,) the number of the region of each element."""
        return np.array([self.tags[key] for key in self.keys], np.int64)[self.place]


def region_groups(content: Content, kind: str, count: int) -> RegionGroups:
    """The regions of the `count` elements of this kind."""
    names = content.names or Names()
    number = (content.regions or {}).get(kind)
    number = np.zeros(count, np.int64) if number is None else np.asarray(number)
    row = names.elements.get(kind, np.full(count, -1, np.int64))
    pairs, place = unique_pairs(number, row)
    keys = [names.regions[int(one)] if one >= 0 else f"region={int(n) + 1}" for n, one in pairs]
    tags = tags_of(list(dict.fromkeys(keys)), 2, names.tags)
    return RegionGroups([int(one) for _, one in pairs], keys, place, tags)


def group_rows(names: Names, kind: str) -> dict[str, Ints]:
    """The elements in each group of regions, in the order of the names."""
    row = names.elements.get(kind, np.zeros(0, np.int64))
    return _members(names.regions, row)


def group_edges(names: Names) -> dict[str, Ints]:
    """The edges (n, 2) of each group of sides."""
    return {
        name: names.edges[rows] for name, rows in _members(names.sides, names.edge_sides).items()
    }


def _members(spelled: tuple[str, ...], row: Ints) -> dict[str, Ints]:
    found: dict[str, list[int]] = {}
    for number, name in enumerate(spelled):
        for group in texts.groups(name):
            found.setdefault(group, []).append(number)
    return {group: np.flatnonzero(np.isin(row, numbers)) for group, numbers in found.items()}


def tags_of(groups: list[str], dimension: int, tags: dict[tuple[int, str], int]) -> dict[str, int]:
    """A positive number for each group: the one it had in its file, the number that it is called,
    or the next free one.
    """
    found: dict[str, int] = {}
    taken: set[int] = set()
    for group in groups:
        called = texts.numbered(group)
        text = str(called[1]) if called else group
        spelled = int(text) if text.isascii() and text.isdigit() and len(text) < 10 else 0
        for wanted in (tags.get((dimension, group), 0), spelled):
            if 0 < wanted < 2**31 and wanted not in taken:
                found[group] = wanted
                taken.add(wanted)
                break
    free = 1
    for group in groups:
        if group not in found:
            while free in taken:
                free += 1
            found[group] = free
            taken.add(free)
    return {group: found[group] for group in groups}
