"""Gmsh's `.geo`: transfinite curves and surfaces with physical groups, for Gmsh to mesh.

A graded edge is cut into curves of constant growth each, which Gmsh's *Progression* describes; so
Gmsh makes exactly the announced cells.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.blocks.grading_sections import sections
from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.io.grids.block_edges import edge_shape


def geo_text(grid: BlockGrid) -> str:
    """The text of the file."""
    writer = _Writer(grid)
    return "\n".join(writer.lines()) + "\n"


def quoted(name: str) -> str:
    """A name as Gmsh takes it between quotation marks."""
    return " ".join(name.replace('"', "'").split())


class _Writer:
    """Numbers points and curves."""

    def __init__(self, grid: BlockGrid) -> None:
        self.grid = grid
        self.points: list[str] = []
        self.curves: list[str] = []
        self.last = 0
        self.of_edge: list[list[int]] = []
        for point in grid.points[: len(grid.structure.points)]:
            self.point(point)

    def point(self, at: np.ndarray) -> int:
        number = len(self.points) + 1
        x, y, z = at.tolist()
        self.points.append(f"Point({number}) = {{{x!r}, {y!r}, {z!r}}};")
        return number

    def curve(self, kind: str, points: list[int], cells: int, ratio: float) -> int:
        self.last += 1
        number = self.last
        listed = ", ".join(map(str, points))
        self.curves.append(f"{kind}({number}) = {{{listed}}};")
        using = "" if ratio == 1.0 else f" Using Progression {ratio!r}"
        self.curves.append(f"Transfinite Curve {{{number}}} = {cells + 1}{using};")
        return number

    def edge(self, edge: int) -> list[int]:
        """The curves of a block edge, in its direction."""
        grid = self.grid
        line = grid.points[grid.edge_vertices(edge)]
        shape = edge_shape(grid, edge)
        ends = [int(v) + 1 for v in grid.structure.edges[edge]]
        centre = self.point(shape.centre) if shape.kind == "arc" else 0
        parts = sections(grid.edge_sizes(edge))
        found, done, first = [], 0, ends[0]
        for number, part in enumerate(parts):
            stop = done + part.cells
            last = ends[1] if number == len(parts) - 1 else self.point(line[stop])
            if shape.kind == "line":
                found.append(self.curve("Line", [first, last], part.cells, part.ratio))
            elif shape.kind == "arc":
                found.append(self.curve("Circle", [first, centre, last], part.cells, part.ratio))
            else:
                inside = line[done + 1 : stop]
                if len(parts) == 1 and len(inside) < len(shape.knots):
                    inside = shape.knots
                knots = [self.point(at) for at in inside]
                found.append(self.curve("Spline", [first, *knots, last], part.cells, part.ratio))
            done, first = stop, last
        return found

    def lines(self) -> list[str]:
        grid, structure = self.grid, self.grid.structure
        for edge in range(len(structure.edges)):
            self.of_edge.append(self.edge(edge))
        surfaces = []
        for block, corners in enumerate(structure.corners.tolist(), start=1):
            loop: list[int] = []
            for side in range(4):
                curves = self.of_edge[structure.sides[block - 1, side]]
                # sides 2 and 3 run against the axes
                ahead = structure.forward[block - 1, side] == (side < 2)
                loop += curves if ahead else [-curve for curve in reversed(curves)]
            listed = ", ".join(map(str, loop))
            named = ", ".join(str(corner + 1) for corner in corners)
            surfaces += [
                f"Curve Loop({block}) = {{{listed}}};",
                f"Plane Surface({block}) = {{{block}}};",
                f"Transfinite Surface {{{block}}} = {{{named}}};",
            ]
        count = len(structure.corners)
        groups = []
        for patch in structure.patches:
            listed = ", ".join(str(c) for edge in patch.edges.tolist() for c in self.of_edge[edge])
            groups.append(f'Physical Curve("{quoted(patch.title)}") = {{{listed}}};')
        names = np.array(structure.region_names)[structure.region]
        for name in dict.fromkeys(names.tolist()):
            listed = ", ".join(map(str, (np.flatnonzero(names == name) + 1).tolist()))
            groups.append(f'Physical Surface("{quoted(name)}") = {{{listed}}};')
        return [
            f"// Meshwright: {count} blocks, {grid.cell_count} cells",
            *self.points, *self.curves, *surfaces,
            f"Recombine Surface {{1:{count}}};",
            *groups,
        ]  # fmt: skip
