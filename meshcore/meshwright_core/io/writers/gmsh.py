"""Gmsh files, versions 2.2 and 4.1, as text: names are physical groups of curves and surfaces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.names import groups
from meshwright_core.io.content import Content
from meshwright_core.io.named_groups import group_edges, group_rows, region_groups, tags_of
from meshwright_core.io.writers import lines as form

_CODES = {"line": 1, "triangle": 2, "quad": 3}


def write(content: Content, version: str = "2.2") -> str:
    """Return the content as a Gmsh text file of version 2.2 or 4.1, with its data by node.

    Regions without a name have physical groups without a name, if there are several.
    """
    return _Writer(content).text(version)


class _Writer:
    def __init__(self, content: Content) -> None:
        self.content, self.names = content, form.names(content)
        self.kind, self.elements = form.block(content)
        tags = self.names.tags
        self.surfaces = tags_of(list(group_rows(self.names, self.kind)), 2, tags)
        self.curves = tags_of(list(group_edges(self.names)), 1, tags)
        # one entity for each region: by its number in the mesh and its name
        regions = region_groups(content, self.kind, len(self.elements))
        self.entity, self.alone = regions.place, len(regions.rows) == 1
        self.physical = [self._physical(row) for row in regions.rows]

    def _physical(self, row: int) -> list[int]:
        """The physical groups of a region by the row of its name, -1 for none."""
        if row >= 0:
            return [self.surfaces[group] for group in groups(self.names.regions[row])]
        if self.alone:
            return []
        free = max([0, *self.surfaces.values()]) + 1
        self.surfaces[str(free)] = free
        return [free]

    def text(self, version: str) -> str:
        """The whole file."""
        parts = [["$MeshFormat", f"{version} 0 8", "$EndMeshFormat"], self._physical_names()]
        parts += self._old() if version == "2.2" else self._new()
        for name, values in self.content.data.items():
            rows = [f"{i} {value}" for i, value in form.numbered(values)]
            title = ["$NodeData", "1", f'"{name}"', "1", "0.0", "3", "0", "1", f"{len(values)}"]
            parts.append([*title, *rows, "$EndNodeData"])
        return form.text([line for part in parts for line in part])

    def _physical_names(self) -> list[str]:
        named = [
            (dimension, tag, name.replace('"', "'"))
            for dimension, tags in ((1, self.curves), (2, self.surfaces))
            for name, tag in tags.items()
            if name != str(tag)
        ]
        if not named:
            return []
        rows = [f'{dimension} {tag} "{name}"' for dimension, tag, name in named]
        return ["$PhysicalNames", f"{len(rows)}", *rows, "$EndPhysicalNames"]

    def _old(self) -> list[list[str]]:
        points = [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in form.numbered(self.content.points)]
        nodes = ["$Nodes", f"{len(points)}", *points, "$EndNodes"]
        tables = []
        for side, name in enumerate(self.names.sides):
            ends = self.names.edges[self.names.edge_sides == side]
            for group in groups(name):
                tables.append(
                    _tagged("line", self.curves[group], np.full(len(ends), side + 1), ends)
                )
        first = np.array([some[0] if some else 0 for some in self.physical])[self.entity]
        tables.append(_tagged(self.kind, first, self.entity + 1, self.elements))
        for entity, some in enumerate(self.physical):
            members = np.flatnonzero(self.entity == entity)
            for tag in some[1:]:  # once more for each further group
                there = np.full(len(members), entity + 1)
                tables.append(_tagged(self.kind, tag, there, self.elements[members]))
        rows = [row for table in tables for row in table]
        numbered = [f"{i} {row}" for i, row in enumerate(rows, start=1)]
        return [nodes, ["$Elements", f"{len(rows)}", *numbered, "$EndElements"]]

    def _new(self) -> list[list[str]]:
        points, count = self.content.points, len(self.content.points)
        sides = [
            (side + 1, [self.curves[group] for group in groups(name)],
             self.names.edges[self.names.edge_sides == side])
            for side, name in enumerate(self.names.sides)
        ]  # fmt: skip
        surfaces = [
            (entity + 1, some, self.elements[self.entity == entity])
            for entity, some in enumerate(self.physical)
        ]
        entities = ["$Entities", f"0 {len(sides)} {len(surfaces)} 0"]
        blocks, number = [], 1
        for dimension, kind, those in ((1, "line", sides), (2, self.kind, surfaces)):
            for tag, some, cells in those:
                box = points[cells.ravel()]
                low, high = box.min(axis=0).tolist(), box.max(axis=0).tolist()
                entities.append(" ".join(map(str, [tag, *low, *high, len(some), *some, 0])))
                blocks.append(f"{dimension} {tag} {_CODES[kind]} {len(cells)}")
                rows = enumerate((cells + 1).tolist(), start=number)
                blocks += [f"{i} {' '.join(map(str, row))}" for i, row in rows]
                number += len(cells)
        nodes = ["$Nodes", f"1 {count} 1 {count}", f"2 1 0 {count}"]
        nodes += [str(i) for i in range(1, count + 1)]
        nodes += [f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
        total = number - 1
        elements = ["$Elements", f"{len(sides) + len(surfaces)} {total} 1 {total}", *blocks]
        return [
            [*entities, "$EndEntities"], [*nodes, "$EndNodes"], [*elements, "$EndElements"],
        ]  # fmt: skip


def _tagged(
    kind: str,
    physical: int | NDArray[np.int64],
    entity: NDArray[np.int64],
    cells: NDArray[np.int64],
) -> list[str]:
    """Rows of version 2.2 without their number: type, tags, nodes."""
    tags = np.column_stack([np.broadcast_to(physical, entity.shape), entity, cells + 1])
    return [f"{_CODES[kind]} 2 {' '.join(map(str, row))}" for row in tags.tolist()]
