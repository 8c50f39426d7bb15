"""Blocks that bend too far for blockMesh, and names of sides that formats cannot hold."""

import math
import re

import numpy as np
import pytest
from block_meshes import annulus, corner_blocks, quarter_ring, two_regions

from meshwright_core import MeshError, read
from meshwright_core.blocks.grid import BlockGrid, Sizing, WallLayer, block_grid
from meshwright_core.io.grids import cgns, openfoam
from meshwright_core.io.grids.block_files import losses, write_blocks
from meshwright_core.io.grids.block_pieces import BlockPieces, part_counts
from meshwright_core.io.grids.openfoam import Extrusion, block_mesh_dict


def bent(turn: float = 1.5 * math.pi, sizing: Sizing | None = None) -> BlockGrid:
    return block_grid(quarter_ring(turn), sizing or Sizing(divide=7))


def straight_sines(grid: BlockGrid, pieces: BlockPieces) -> np.ndarray:
    corner = grid.points[pieces.corners][..., :2]
    ahead, back = np.roll(corner, -1, axis=1) - corner, np.roll(corner, 1, axis=1) - corner
    cross = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
    return cross / (np.linalg.norm(ahead, axis=2) * np.linalg.norm(back, axis=2))


def fits(pieces: BlockPieces) -> None:
    """Each side of each piece is a line between its corners with its number of cells."""
    for piece, shape in enumerate(pieces.shapes):
        for side, (a, b) in enumerate(((0, 1), (1, 2), (3, 2), (0, 3))):
            line = pieces.lines[pieces.sides[piece, side]]
            along = line.vertices if pieces.forward[piece, side] else line.vertices[::-1]
            assert [along[0], along[-1]] == pieces.corners[piece, [a, b]].tolist()
            assert len(line.vertices) == shape[side % 2] + 1
            assert len(line.sizes) == shape[side % 2]


@pytest.mark.parametrize("make", [annulus, corner_blocks, two_regions, quarter_ring])
def test_blocks_that_are_convex_are_not_cut(make):
    grid = block_grid(make(), Sizing(divide=3))
    pieces = BlockPieces.of(grid)
    assert (part_counts(grid) == 1).all()
    assert (pieces.corners == grid.structure.corners).all()
    assert (pieces.shapes == grid.shapes).all()
    fits(pieces)


@pytest.mark.parametrize("turn", [0.99 * math.pi, math.pi, 1.5 * math.pi, 1.9 * math.pi])
def test_pieces_of_a_bent_block_are_convex_and_have_all_its_cells(turn):
    grid = bent(turn)
    pieces = BlockPieces.of(grid)
    assert len(pieces.corners) > 1
    assert straight_sines(grid, pieces).min() > 0.05
    assert pieces.shapes.prod(axis=1).sum() == grid.cell_count
    fits(pieces)
    kinds = [line.shape.kind for line in pieces.lines]
    assert kinds.count("arc") == 2 * len(pieces.corners)
    sides = {name: len(ends) for name, ends in pieces.faces.items()}
    assert sides["inner"] == sides["outer"] == len(pieces.corners)
    assert sides["start"] == sides["end"] == 1


def test_all_blocks_of_a_chord_are_cut_at_the_same_cells(monkeypatch):
    """Cut by hand: the blocks of a ring share the chord across the ring."""
    grid = block_grid(annulus(), Sizing(divide=7, walls=(WallLayer("wall", 0.02),)))
    structure = grid.structure
    across = np.bincount(structure.crossing.ravel()).argmax()
    parts = np.ones(structure.chord_count, np.int64)
    parts[across] = 2
    monkeypatch.setattr("meshwright_core.io.grids.block_pieces.part_counts", lambda grid: parts)
    pieces = BlockPieces.of(grid)
    assert len(pieces.corners) == 8
    fits(pieces)
    radii = np.linalg.norm(grid.points[np.unique(pieces.corners)], axis=1).round(6)
    assert len(np.unique(radii)) == 3


def test_the_dictionary_of_a_bent_block_says_so():
    grid = bent()
    text = block_mesh_dict(grid)
    assert len(re.findall(r"^    hex ", text, re.M)) == openfoam.piece_count(grid) == 2
    assert len(re.findall(r"^    arc ", text, re.M)) == 8
    (said,) = losses("blockMeshDict", grid)
    assert said.endswith("the file has 2 in place of 1, with the same cells.")
    assert losses("a.geo", grid) == ()


def patches_of(text: str) -> list[str]:
    return re.findall(r"^    (\S+)\n    \{", text, re.M)


def test_names_of_sides_become_words_and_none_is_given_twice():
    names = ("front", "back", "1st inlet", "\u53e3")
    grid = block_grid(quarter_ring(names=names), Sizing(divide=2))
    assert [patch.title for patch in grid.structure.patches] == list(names)
    assert patches_of(block_mesh_dict(grid, Extrusion(0.5, 2))) == [
        "front", "back", "side_1st_inlet", "side_4", "front_2", "back_2"
    ]  # fmt: skip
    (said,) = losses("blockMeshDict", grid)
    assert "'1st inlet' becomes 'side_1st_inlet', '\u53e3' becomes 'side_4'" in said
    assert "1st_inlet" in losses("a.xyz", grid)[0]
    assert losses("a.geo", grid) == losses("a.vtm", grid) == ()


def test_an_axis_keeps_its_name_in_a_wedge():
    grid = block_grid(quarter_ring(names=("axis", "out", "in", "body")), Sizing(divide=2))
    names = patches_of(block_mesh_dict(grid, Extrusion(wedge=True)))
    assert names == ["out", "in", "body", "axis", "front", "back"]


def test_layers_and_walls_are_found_by_the_drawn_name_and_by_the_plain_one():
    mesh = quarter_ring(names=("start", "outer", "end", "bolt hole"))
    for name in ("bolt hole", "bolt_hole"):
        grid = block_grid(mesh, Sizing(size=0.2, walls=(WallLayer(name, 0.01),)))
        assert (grid.division.first + grid.division.last).max() == 0.01
        assert re.search(r"bolt_hole\s*\{\s*type wall;", block_mesh_dict(grid, walls=(name,)))


def test_names_that_become_alike_stay_apart():
    names = ("a b", "a_b", "a\u00e4", "aa")
    structure = block_grid(quarter_ring(names=names), Sizing(divide=1)).structure
    assert [patch.name for patch in structure.patches] == ["a_b", "a_b_2", "aa", "aa_2"]


def test_drawn_names_reach_files_that_hold_them(tmp_path):
    names = ("bolt hole 1", 'say "go"', "end", "inner")
    grid = block_grid(quarter_ring(names=names), Sizing(divide=2))
    write_blocks(tmp_path / "a.msh", grid)
    assert set(read(tmp_path / "a.msh").sides()) == {"bolt hole 1", "say 'go'", "end", "inner"}
    write_blocks(tmp_path / "a.geo", grid)
    text = (tmp_path / "a.geo").read_text()
    assert 'Physical Curve("bolt hole 1")' in text
    assert "Physical Curve(\"say 'go'\")" in text
    write_blocks(tmp_path / "a.inp", grid, 2)
    assert "*NSET, NSET=bolt_hole_1" in (tmp_path / "a.inp").read_text()


def test_regions_of_one_name_are_one_group(tmp_path):
    mesh = two_regions()
    mesh.name_regions([0, 1], "soft steel")
    grid = block_grid(mesh, Sizing(divide=2))
    write_blocks(tmp_path / "a.geo", grid)
    write_blocks(tmp_path / "a.msh", grid, 2)
    assert (tmp_path / "a.geo").read_text().count("Physical Surface") == 1
    assert (tmp_path / "a.msh").read_text().count('"soft steel"') == 1
    assert "soft_steel" in openfoam.zone_names(grid)


def test_families_of_cgns_are_short_and_all_different():
    long = "a very long name of a side that no node of CGNS can hold"
    mesh = quarter_ring(names=(f"{long} 1", f"{long} 2", "Block00001", "inner"))
    sides, regions = cgns.families(block_grid(mesh, Sizing(divide=1)))
    assert regions == {}
    assert len(set(sides.values()) - {"Block00001"}) == 4
    assert max(map(len, sides.values())) <= 30


def test_both_files_of_a_grid_are_written_or_none(tmp_path):
    (tmp_path / "ring.xyz").write_text("old")
    (tmp_path / "ring.nmf").mkdir()
    grid = block_grid(annulus(), Sizing(divide=2))
    with pytest.raises(MeshError, match=r"ring\.nmf: this is a folder"):
        write_blocks(tmp_path / "ring.xyz", grid)
    assert (tmp_path / "ring.xyz").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ring.nmf", "ring.xyz"]
