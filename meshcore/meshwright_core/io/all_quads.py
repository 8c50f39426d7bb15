"""Makes quads of the triangles of a mesh file: in pairs, and by a split where some are left."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from meshwright_core.domains.elements.quadrangulation import catmull_clark, pair
from meshwright_core.io import cleaning
from meshwright_core.io.content import Content, Names
from meshwright_core.io.plane_frames import best_axes
from meshwright_core.io.surface import Ints, compacted


def converted(content: Content) -> Content:
    """The content as quads only, with a line on how they came about.

    Triangles of the same region are joined in pairs to convex quads. Where some are left, every
    quad and triangle is then cut in four or three by the middles of its sides; named edges are cut
    in two.
    """
    triangles = content.cells.get("triangle", np.zeros((0, 3), np.int64))
    if not len(triangles):
        return content
    quads = content.cells.get("quad", np.zeros((0, 4), np.int64))
    triangles = cleaning.oriented(content.points, triangles)
    labels = _Labels(content)
    pairs, owner, alone = _paired(content.points, triangles, labels.of("triangle"))
    blocks = [np.concatenate([quads, pairs])]
    sources = [np.concatenate([np.arange(len(quads)), len(quads) + owner])]
    if len(alone):
        blocks.append(triangles[alone])
        sources.append(len(quads) + alone)
        used = [block for block in blocks if len(block)]
        count = len(content.points)
        flags = np.zeros(count, bool)
        points, made, _ = catmull_clark(content.points, used, flags)
        split = [
            np.repeat(rows, block.shape[1])
            for rows, block in zip(sources, blocks, strict=True)
            if len(block)
        ]
        content = _divided(content, used, points)
        source = np.concatenate(split)
        how = (
            f"{len(triangles)} triangles: {len(pairs)} pairs are joined, and since "
            f"{len(alone)} stay alone, every element is split"
        )
    else:
        made, source = blocks[0], sources[0]
        noun = "pair" if len(pairs) == 1 else "pairs"
        how = f"{len(triangles)} triangles are joined in {len(pairs)} {noun}"
    said = f"{len(made)} quads are made of {how}" if len(alone) else f"{how} to make quads"
    result = content._replace(
        cells={"quad": made},
        regions=labels.regions(source),
        names=labels.names(content.names, source),
        parts=labels.parts(source),
        data={},
        warnings=(*content.warnings, said),
    )
    return compacted(result)


class _Labels:
    """Region, name and part of every cell, quads first, then triangles."""

    def __init__(self, content: Content) -> None:
        counts = {kind: len(content.cells.get(kind, ())) for kind in ("quad", "triangle")}
        self._counts = counts

        def joined(arrays: dict[str, NDArray[np.generic]], default: int) -> Ints:
            rows = [
                np.asarray(arrays[kind]).astype(np.int64)
                if count and len(arrays.get(kind, ())) == count
                else np.full(count, default)
                for kind, count in counts.items()
            ]
            return np.concatenate(rows)

        self._region = joined(dict(content.regions or {}), 0)
        self._has_regions = bool(content.regions)
        self._name = joined(dict(content.names.elements) if content.names else {}, -1)
        self._part = joined(dict(content.parts), 0)

    def of(self, kind: str) -> Ints:
        """A number for each cell of a kind, by region, name and part."""
        table = np.column_stack([self._region, self._name, self._part])
        number = np.unique(table, axis=0, return_inverse=True)[1].ravel()
        first = self._counts["quad"]
        return np.asarray(number[first:] if kind == "triangle" else number[:first], np.int64)

    def regions(self, source: Ints) -> dict[str, NDArray[np.generic]]:
        return {"quad": self._region[source]} if self._has_regions else {}

    def parts(self, source: Ints) -> dict[str, Ints]:
        return {"quad": self._part[source]}

    def names(self, names: Names | None, source: Ints) -> Names | None:
        return None if names is None else replace(names, elements={"quad": self._name[source]})


def _paired(points: NDArray[np.float64], triangles: Ints, label: Ints) -> tuple[Ints, Ints, Ints]:
    """Quads of pairs within the same label, a triangle of each, and the rows that stay alone."""
    quads, owner, alone = [np.zeros((0, 4), np.int64)], [], []
    for rows in _groups(points, triangles, label):
        corners = triangles[rows]
        local = np.unique(corners)
        flat = (points[local] - points[local].mean(axis=0)) @ best_axes(points, corners).T
        made, left = pair(flat, np.searchsorted(local, corners))
        key = {
            tuple(sorted(corner)): row for corner, row in zip(corners.tolist(), rows, strict=True)
        }
        made = local[made]
        for a, b, c, d in made.tolist():
            found = key.get(tuple(sorted((a, b, c))))
            owner.append(found if found is not None else key[tuple(sorted((b, c, d)))])
        alone += [key[tuple(sorted(corner))] for corner in local[left].tolist()]
        quads.append(made)
    return np.concatenate(quads), np.array(owner, np.int64), np.array(sorted(alone), np.int64)


def _groups(points: NDArray[np.float64], triangles: Ints, label: Ints) -> Iterator[Ints]:
    """Rows of triangles of one label which lie about in one plane."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    facing = np.rint(1.5 * normal).astype(np.int64)  # directions in classes of some 40 degrees
    classes = np.unique(np.column_stack([label, facing]), axis=0, return_inverse=True)[1].ravel()
    for one in range(int(classes.max()) + 1):
        yield np.flatnonzero(classes == one)


def _divided(content: Content, blocks: list[Ints], points: NDArray[np.float64]) -> Content:
    """The content on the points of the split, its named edges cut in two."""
    names = content.names
    if names is None:
        return content._replace(points=points, data={})
    count = len(content.points)
    ends = np.concatenate(
        [np.stack([b, np.roll(b, -1, axis=1)], axis=2).reshape(-1, 2) for b in blocks]
    )
    keys = np.unique(ends.min(axis=1) * count + ends.max(axis=1))
    key = names.edges.min(axis=1) * count + names.edges.max(axis=1)
    at = np.minimum(np.searchsorted(keys, key), len(keys) - 1)
    there = keys[at] == key
    middle = count + at[there]
    old = names.edges[there]
    edges = np.concatenate(
        [np.column_stack([old[:, 0], middle]), np.column_stack([middle, old[:, 1]])]
    )
    sides = np.tile(names.edge_sides[there], 2)
    low, high = keys // count, keys % count
    sets = {}
    for name, ids in names.points.items():
        inside = np.isin(low, ids) & np.isin(high, ids)
        sets[name] = np.concatenate([ids, count + np.flatnonzero(inside)])
    names = replace(names, edges=edges, edge_sides=sides, points=sets)
    return content._replace(points=points, names=names, data={})
