"""``mw.blocks``: arrays, PyVista's MultiBlock, files."""

import numpy as np
import pytest
from block_meshes import annulus, corner_blocks

import meshwright as mw
from meshwright.document import block_edits
from meshwright.document.document import Document
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.errors import GridWarning


def test_a_grid_as_data_as_multiblock_and_as_a_file(tmp_path):
    grid = mw.blocks(annulus(), 0.25, walls=[mw.WallLayer("wall", 0.02, 1.3)])
    assert len(grid) == 4
    assert grid.counts.shape == (grid.structure.chord_count,)
    assert sum(np.prod(np.array(grid[b].shape[:2]) - 1) for b in range(4)) == len(grid.cells)
    assert sorted(grid.patches) == ["far", "wall"]
    assert grid.quality.inverted == 0
    found = grid.multiblock()
    assert found.keys() == [*(f"block_{i}" for i in range(1, 5)), "patches"]
    blocks = [found[i] for i in range(4)]
    assert sum(block.n_cells for block in blocks) == len(grid.cells)
    area = sum(block.compute_cell_sizes()["Area"].sum() for block in blocks)
    assert area == pytest.approx(grid.quality.areas.sum())
    assert found["patches"]["wall"].n_cells == len(grid.patches["wall"])
    assert grid.write(tmp_path / "ring.geo") == [tmp_path / "ring.geo"]


def test_each_quad_is_a_block_and_numbers_may_be_given():
    mesh = mw.mesh("square")
    grid = mw.blocks(mesh, divide=3)
    assert len(grid.cells) == 9 * mesh.n_elements
    with pytest.raises(mw.MeshError, match="not both"):
        mw.blocks(mesh, 0.1, divide=3)


def test_numbers_that_were_set_in_a_document_count_where_none_are_given():
    document = Document(annulus())
    structure = BlockStructure.of(document.mesh)
    chord = int(structure.chord[structure.edge_between(0, 4)])
    block_edits.set_count(document, structure, chord, 17)
    assert mw.blocks(document.mesh).counts[chord] == 17
    assert mw.blocks(document.mesh, size=0.5).counts[chord] == 17
    assert mw.blocks(document.mesh, chord_counts={chord: 9}).counts[chord] == 9


def test_a_layer_without_effect_warns():
    with pytest.warns(GridWarning, match="The layer at outline has no effect"):
        mw.blocks(corner_blocks(), 0.25, walls=[mw.WallLayer("outline", 0.5)])
