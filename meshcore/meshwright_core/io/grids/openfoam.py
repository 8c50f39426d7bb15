"""OpenFOAM's `blockMeshDict`: blocks, graded edges, arcs and splines, patches.

The plane grid is one cell thick with an empty front and back, or extruded, or a wedge of five
degrees around the x axis for axially symmetric flows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_core.blocks.grading_sections import sections
from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.errors import MeshError
from meshwright_core.io.grids.block_edges import EdgeShape, edge_shape

_HALF_WEDGE = np.radians(2.5)
_ON_AXIS = 1e-9
_HEADER = """\
FoamFile
{
    version     2.0;
    format      ascii;
    class       dictionary;
    object      blockMeshDict;
}
"""


@dataclass(frozen=True)
class Extrusion:
    """How a plane grid becomes one of volumes."""

    height: float | None = None
    """Thickness; None: a tenth of the size, for a plane flow."""
    layers: int = 1
    wedge: bool = False
    """A wedge of five degrees around the x axis."""


def block_mesh_dict(
    grid: BlockGrid, extrusion: Extrusion | None = None, walls: tuple[str, ...] = ()
) -> str:
    """The text of the file.

    Args:
        grid: in the plane of x and y; for a wedge above the x axis.
        extrusion: by default one cell thick.
        walls: names of the patches of type *wall*; "all" for every one.

    Raises MeshError for a grid out of that plane, or one below the axis of a wedge.
    """
    return _Dictionary(grid, extrusion or Extrusion(), walls).text()


class _Dictionary:
    """Vertices of the front are those of the structure, those of the back follow."""

    def __init__(self, grid: BlockGrid, extrusion: Extrusion, walls: tuple[str, ...]) -> None:
        self.grid, self.extrusion, self.walls = grid, extrusion, walls
        corners = grid.points[: len(grid.structure.points)]
        size = float(np.ptp(corners, axis=0).max())
        if np.ptp(grid.points[:, 2]) > 1e-9 * size:
            raise MeshError("blockMesh takes grids in the plane of x and y.")
        self.height = 0.1 * size if extrusion.height is None else extrusion.height
        self.low = grid.points[0, 2]
        self.axis = np.zeros(len(corners), bool)
        if extrusion.wedge:
            if corners[:, 1].min() < -_ON_AXIS * size:
                raise MeshError("A wedge around the x axis needs a grid above that axis.")
            self.axis = corners[:, 1] <= _ON_AXIS * size
        # the back of a vertex on the axis is the vertex itself
        count = len(corners)
        self.back = np.where(self.axis, np.arange(count), count + np.cumsum(~self.axis) - 1)

    def text(self) -> str:
        structure = self.grid.structure
        corners = self.grid.points[: len(structure.points)]
        vertices = [self._at(corner, 0) for corner in corners]
        vertices += [self._at(corner, 1) for corner in corners[~self.axis]]
        lines = [
            f"// Meshwright: {len(structure.corners)} blocks, {self._cells()} cells", _HEADER,
            "vertices", "(",
            *(f"    {_point(at)}" for at in vertices), ");", "",
            "blocks", "(", *self._blocks(), ");", "", "edges", "(", *self._edges(), ");", "",
            "boundary", "(", *self._patches(), ");", "", "mergePatchPairs", "(", ");",
        ]  # fmt: skip
        return "\n".join(lines) + "\n"

    def _cells(self) -> int:
        return self.grid.cell_count * self._layers

    @property
    def _layers(self) -> int:
        return 1 if self.extrusion.wedge else self.extrusion.layers

    def _at(self, point: np.ndarray, level: int) -> np.ndarray:
        """A point of the plane on the front (0) or on the back (1)."""
        x, y, _ = point
        if self.extrusion.wedge:
            angle = _HALF_WEDGE if level else -_HALF_WEDGE
            return np.array([x, y * np.cos(angle), y * np.sin(angle)])
        return np.array([x, y, self.low + level * self.height])

    def _blocks(self) -> list[str]:
        structure, grid = self.grid.structure, self.grid
        lines = []
        names = structure.region_names
        several = len(names) > 1
        gradings: dict[tuple[int, bool], str] = {}

        def grading(block: int, side: int) -> str:
            edge = int(structure.sides[block, side])
            key = (edge, bool(structure.forward[block, side]))
            if key not in gradings:
                sizes = grid.edge_sizes(edge)
                gradings[key] = _grading(sizes if key[1] else sizes[::-1])
            return gradings[key]

        for block, corner in enumerate(structure.corners):
            front = " ".join(map(str, corner.tolist()))
            back = " ".join(map(str, self.back[corner].tolist()))
            n, m = grid.shapes[block].tolist()
            zone = f" {names[structure.region[block]]}" if several else ""
            first, second = grading(block, 0), grading(block, 2)
            third, fourth = grading(block, 3), grading(block, 1)
            along = " ".join([first, second, second, first, third, fourth, fourth, third])
            lines.append(
                f"    hex ({front} {back}){zone} ({n} {m} {self._layers}) "
                f"edgeGrading ({along} 1 1 1 1)"
            )
        return lines

    def _edges(self) -> list[str]:
        lines = []
        for edge, (start, end) in enumerate(self.grid.structure.edges.tolist()):
            shape = edge_shape(self.grid, edge)
            if shape.kind == "line":
                continue
            for level in (0, 1):
                a, b = (start, end) if level == 0 else (self.back[start], self.back[end])
                if level and a == start and b == end:
                    continue
                lines.append(f"    {self._curve(shape, int(a), int(b), level)}")
        return lines

    def _curve(self, shape: EdgeShape, a: int, b: int, level: int) -> str:
        if shape.kind == "arc":
            return f"arc {a} {b} {_point(self._at(shape.middle, level))}"
        knots = " ".join(_point(self._at(knot, level)) for knot in shape.knots)
        return f"spline {a} {b} ({knots})"

    def _patches(self) -> list[str]:
        structure = self.grid.structure
        lines: list[str] = []
        on_axis: list[str] = []
        for patch in structure.patches:
            faces = []
            for edge in patch.edges.tolist():
                a, b = structure.edges[edge]
                if structure.neighbours[edge, 0] < 0:
                    a, b = b, a
                face = f"({a} {b} {self.back[b]} {self.back[a]})"
                if self.axis[a] and self.axis[b]:
                    on_axis.append(face)
                else:
                    faces.append(face)
            wall = patch.name in self.walls or "all" in self.walls
            if faces:
                lines += _patch(patch.name, "wall" if wall else "patch", faces)
        if on_axis:
            lines += _patch("axis", "empty", on_axis)
        front = [f"({' '.join(map(str, c[::-1].tolist()))})" for c in structure.corners]
        back = [f"({' '.join(map(str, self.back[c].tolist()))})" for c in structure.corners]
        if self.extrusion.wedge:
            return [*lines, *_patch("front", "wedge", front), *_patch("back", "wedge", back)]
        if self._layers > 1 or self.extrusion.height is not None:
            return [*lines, *_patch("front", "patch", front), *_patch("back", "patch", back)]
        return [*lines, *_patch("frontAndBack", "empty", [*front, *back])]


def _patch(name: str, kind: str, faces: list[str]) -> list[str]:
    inside = [f"            {face}" for face in faces]
    return [
        f"    {name}", "    {", f"        type {kind};", "        faces", "        (", *inside,
        "        );", "    }",
    ]  # fmt: skip


def _grading(sizes: np.ndarray) -> str:
    """The expansion ratio, or several sections (share of length, of cells, expansion)."""
    parts = sections(sizes)
    if len(parts) == 1:
        return f"{parts[0].ratio ** (parts[0].cells - 1):.12g}"
    inside = " ".join(
        f"({part.share:.12g} {part.cells} {part.ratio ** (part.cells - 1):.12g})" for part in parts
    )
    return f"({inside})"


def _point(at: np.ndarray) -> str:
    return "(" + " ".join(f"{value:.17g}" for value in at.tolist()) + ")"
