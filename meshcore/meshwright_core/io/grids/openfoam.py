"""OpenFOAM's `blockMeshDict`: blocks, graded edges, arcs and splines, patches.

The plane grid is one cell thick with an empty front and back, or extruded, or a wedge of five
degrees around the x axis for axially symmetric flows. Blocks that bend too far for blockMesh are
cut (:mod:`.block_pieces`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_core.blocks.grading_sections import sections
from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.blocks.patches import plain_name, unlike
from meshwright_core.blocks.sizing import EVERY_SIDE
from meshwright_core.errors import MeshError
from meshwright_core.io.grids.block_edges import EdgeShape
from meshwright_core.io.grids.block_pieces import BlockPieces, part_counts

MOST_CELLS = 2**31 - 1
"""What OpenFOAM's labels count where they have 32 bits, as they have by default."""
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
    """Vertices of the front are the corners of the pieces of blocks, those of the back follow."""

    def __init__(self, grid: BlockGrid, extrusion: Extrusion, walls: tuple[str, ...]) -> None:
        self.grid, self.extrusion = grid, extrusion
        cells = grid.cell_count * self._layers
        if cells > MOST_CELLS:
            raise MeshError(
                f"That makes {cells:,} cells; OpenFOAM counts up to {MOST_CELLS:,} by default."
            )
        self.walls = {
            patch.name
            for patch in grid.structure.patches
            if not {patch.name, patch.title, EVERY_SIDE}.isdisjoint(walls)
        }
        size = float(np.ptp(grid.points[: len(grid.structure.points)], axis=0).max())
        if np.ptp(grid.points[:, 2]) > 1e-9 * size:
            raise MeshError("blockMesh takes grids in the plane of x and y.")
        self.pieces = BlockPieces.of(grid)
        used = np.unique(self.pieces.corners)
        self.number = {vertex: i for i, vertex in enumerate(used.tolist())}
        self.corners = grid.points[used]
        self.height = 0.1 * size if extrusion.height is None else extrusion.height
        self.low = grid.points[0, 2]
        self.axis = np.zeros(len(used), bool)
        if extrusion.wedge:
            if self.corners[:, 1].min() < -_ON_AXIS * size:
                raise MeshError("A wedge around the x axis needs a grid above that axis.")
            self.axis = self.corners[:, 1] <= _ON_AXIS * size
        # the back of a vertex on the axis is the vertex itself
        count = len(used)
        self.back = np.where(self.axis, np.arange(count), count + np.cumsum(~self.axis) - 1)

    def text(self) -> str:
        vertices = [self._at(corner, 0) for corner in self.corners]
        vertices += [self._at(corner, 1) for corner in self.corners[~self.axis]]
        cells = self.grid.cell_count * self._layers
        lines = [
            f"// Meshwright: {len(self.pieces.corners)} blocks, {cells} cells", _HEADER,
            "vertices", "(",
            *(f"    {_point(at)}" for at in vertices), ");", "",
            "blocks", "(", *self._blocks(), ");", "", "edges", "(", *self._edges(), ");", "",
            "boundary", "(", *self._patches(), ");", "", "mergePatchPairs", "(", ");",
        ]  # fmt: skip
        return "\n".join(lines) + "\n"

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

    def _rows(self) -> list[list[int]]:
        """The corners of each piece on the front."""
        return [[self.number[v] for v in corner] for corner in self.pieces.corners.tolist()]

    def _blocks(self) -> list[str]:
        pieces, lines = self.pieces, []
        names = zone_names(self.grid)
        several = len(names) > 1
        gradings: dict[tuple[int, bool], str] = {}

        def grading(piece: int, side: int) -> str:
            line = int(pieces.sides[piece, side])
            key = (line, bool(pieces.forward[piece, side]))
            if key not in gradings:
                sizes = pieces.lines[line].sizes
                gradings[key] = _grading(sizes if key[1] else sizes[::-1])
            return gradings[key]

        for piece, corner in enumerate(self._rows()):
            front = " ".join(map(str, corner))
            back = " ".join(map(str, self.back[corner].tolist()))
            n, m = pieces.shapes[piece].tolist()
            zone = f" {names[pieces.region[piece]]}" if several else ""
            first, second = grading(piece, 0), grading(piece, 2)
            third, fourth = grading(piece, 3), grading(piece, 1)
            along = " ".join([first, second, second, first, third, fourth, fourth, third])
            lines.append(
                f"    hex ({front} {back}){zone} ({n} {m} {self._layers}) "
                f"edgeGrading ({along} 1 1 1 1)"
            )
        return lines

    def _edges(self) -> list[str]:
        found = []
        for line in self.pieces.lines:
            if line.shape.kind == "line":
                continue
            start, end = self.number[int(line.vertices[0])], self.number[int(line.vertices[-1])]
            for level in (0, 1):
                a, b = (start, end) if level == 0 else (self.back[start], self.back[end])
                if level and a == start and b == end:
                    continue
                found.append(f"    {self._curve(line.shape, int(a), int(b), level)}")
        return found

    def _curve(self, shape: EdgeShape, a: int, b: int, level: int) -> str:
        if shape.kind == "arc":
            return f"arc {a} {b} {_point(self._at(shape.middle, level))}"
        knots = " ".join(_point(self._at(knot, level)) for knot in shape.knots)
        return f"spline {a} {b} ({knots})"

    def _patches(self) -> list[str]:
        lines: list[str] = []
        on_axis: list[str] = []
        names = side_names(self.grid)
        for patch, ends in self.pieces.faces.items():
            faces = []
            for one, other in ends:
                a, b = self.number[one], self.number[other]
                face = f"({a} {b} {self.back[b]} {self.back[a]})"
                if self.axis[a] and self.axis[b]:
                    on_axis.append(face)
                else:
                    faces.append(face)
            if faces:
                kind = "wall" if patch in self.walls else "patch"
                lines += _patch(names[patch], kind, faces)
            else:
                names[patch] = ""  # it is the axis, and its name is free
        taken = set(names.values())

        def made(name: str, kind: str, faces: list[str]) -> list[str]:
            return _patch(unlike(name, taken), kind, faces)

        if on_axis:
            lines += made("axis", "empty", on_axis)
        rows = self._rows()
        front = [f"({' '.join(map(str, c[::-1]))})" for c in rows]
        back = [f"({' '.join(map(str, self.back[c].tolist()))})" for c in rows]
        if self.extrusion.wedge:
            return [*lines, *made("front", "wedge", front), *made("back", "wedge", back)]
        if self._layers > 1 or self.extrusion.height is not None:
            return [*lines, *made("front", "patch", front), *made("back", "patch", back)]
        return [*lines, *made("frontAndBack", "empty", [*front, *back])]


def side_names(grid: BlockGrid) -> dict[str, str]:
    """How a blockMeshDict spells the names of patches: words that begin with no digit."""
    found: dict[str, str] = {}
    for patch in grid.structure.patches:
        found[patch.name] = unlike(_word(patch.name, "side"), set(found.values()))
    return found


def zone_names(grid: BlockGrid) -> list[str]:
    """How it spells the names of regions, each another one."""
    found: list[str] = []
    for number, name in enumerate(grid.structure.region_names, start=1):
        found.append(unlike(_word(plain_name(name) or str(number), "region"), set(found)))
    return found


def _word(name: str, kind: str) -> str:
    return name if name[0].isalpha() or name[0] == "_" else f"{kind}_{name}"


def piece_count(grid: BlockGrid) -> int:
    """How many blocks a blockMeshDict of the grid has."""
    return int(part_counts(grid)[grid.structure.crossing].prod(axis=1).sum())


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
