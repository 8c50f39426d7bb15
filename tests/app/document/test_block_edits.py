"""Edits of blocks: numbers, gradings, lines; each one step, refused in words, kept by autosave."""

import numpy as np
import pytest
from block_meshes import annulus, corner_blocks, quarter_ring, two_regions

from meshwright.document import block_edits
from meshwright.document.block_lines import line_through, slid
from meshwright.document.block_preview import MOST_BLOCKS, PlannedBlocks, previews
from meshwright.document.document import Document
from meshwright.document.storage import recovery
from meshwright.document.storage.autosave import Autosave
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.blocks.sizing import GridConflictError
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.core.grid_plan import Grading, GridPlan


def blocks(columns: int, rows: int) -> HalfEdgeMesh:
    """Unit squares; vertex i + (columns + 1) j at (i, j)."""
    wide = columns + 1
    points = np.array([(i, j) for j in range(rows + 1) for i in range(wide)], float)
    first = [i + wide * j for j in range(rows) for i in range(columns)]
    return HalfEdgeMesh.from_elements(points, [(c, c + 1, c + wide + 1, c + wide) for c in first])


def planned(document: Document) -> PlannedBlocks:
    return PlannedBlocks.of(document.mesh)


def chord(structure: BlockStructure, a: int, b: int) -> int:
    return int(structure.chord[structure.edge_between(a, b)])


def test_counts_hold_for_a_chord_and_survive_edits_elsewhere():
    document = Document(blocks(4, 3))
    structure = BlockStructure.of(document.mesh)
    block_edits.set_count(document, structure, chord(structure, 0, 1), 7)
    now = planned(document)
    assert now.division.counts[chord(now.structure, 15, 16)] == 7
    h = document.mesh.halfedge(17, 18)  # in the top row, away from that chord
    strip = next(one for one in (h, document.mesh.halfedge(18, 17)) if one >= 0)
    document.submit("chord_collapse", strip, smooth=False)
    now = planned(document)
    assert now.division.counts[chord(now.structure, 0, 1)] == 7
    document.go_to(0)
    assert document.mesh.grid_plan.empty


def test_wishes_for_edges_that_are_gone_are_dropped_in_the_same_step():
    document = Document(blocks(3, 2))
    structure = BlockStructure.of(document.mesh)
    block_edits.set_count(document, structure, chord(structure, 1, 2), 7)
    document.submit("chord_collapse", document.mesh.halfedge(1, 2), smooth=False)
    assert document.mesh.grid_plan.empty
    assert len(document.history) == 2
    document.undo()
    assert planned(document).division.counts[chord(structure, 1, 2)] == 7


def test_a_grading_has_one_direction_along_its_chord():
    document = Document(annulus())
    structure = BlockStructure.of(document.mesh)
    across = chord(structure, 0, 4)
    block_edits.set_grading(document, structure, across, Grading(0.01, 0.0, 1.2))
    found = planned(document).division
    assert found.first[across] == 0.01
    assert found.last[across] == 0.0
    assert found.ratio[across] == 1.2
    block_edits.set_grading(document, structure, across, Grading(0.0, 0.0, 1.2))
    assert document.mesh.grid_plan.empty


def test_contradictions_name_their_chords_and_change_nothing():
    document = Document(corner_blocks())
    structure = BlockStructure.of(document.mesh)
    one = chord(structure, 0, 1)
    block_edits.set_count(document, structure, one, 6)
    with pytest.raises(GridConflictError, match="must be an even number") as odd:
        block_edits.set_side_count(document, structure, "outline", 31)
    assert set(odd.value.chords) == set(range(structure.chord_count))
    with pytest.raises(GridConflictError, match=r"leave too few .* beside 6 on chord"):
        block_edits.set_side_count(document, structure, "outline", 14)
    block_edits.set_side_count(document, structure, "outline", 20)
    ring = Document(quarter_ring())
    structure = BlockStructure.of(ring.mesh)
    block_edits.set_side_count(ring, structure, "outer", 12)
    arc = int(structure.chord[structure.patch("outer").edges[0]])
    with pytest.raises(GridConflictError, match=r"12 cells on outer and 9 on chord .* make 9"):
        block_edits.set_count(ring, structure, arc, 9)
    assert len(ring.history) == 1
    for count in (0, 10**6):
        with pytest.raises(MeshError, match="must be 1 to"):
            block_edits.set_count(ring, structure, arc, count)


def test_autosave_recovers_wishes(tmp_path):
    document = Document(blocks(2, 2), "grid")
    autosave = Autosave(document, tmp_path)
    structure = BlockStructure.of(document.mesh)
    for count in (5, 8):
        block_edits.set_count(document, structure, chord(structure, 0, 1), count)
    document.undo()
    document.redo()
    autosave.leave()
    (lost,) = recovery.lost(tmp_path)
    state = lost.read()
    lost.release()
    assert state.mesh.grid_plan == document.mesh.grid_plan
    assert set(state.mesh.grid_plan.counts.values()) == {8}
    state.mesh.undo()
    assert set(state.mesh.grid_plan.counts.values()) == {5}


def test_lines_go_straight_on_from_end_to_end():
    mesh = blocks(3, 2)
    line = line_through(mesh, mesh.halfedge(5, 6))
    assert [mesh.origin(h) for h in line.halfedges] == [4, 5, 6]
    assert not line.closed
    assert line_through(mesh, mesh.halfedge(0, 1)).halfedges == [mesh.halfedge(0, 1)]


@pytest.mark.parametrize("share", [0.4, -0.4])
def test_a_line_slides_to_either_side_and_not_over_the_next(share):
    document = Document(blocks(3, 2))
    mesh = document.mesh
    h = mesh.halfedge(5, 6)
    block_edits.slide(document, h, share)
    assert np.allclose(mesh.points[4:8, 1], 1.0 + share)
    assert np.allclose(mesh.points[4:8, 0], range(4))
    assert len(document.history) == 1
    mesh.validate()
    moved = slid(mesh, h, 5.0)
    assert (moved.positions[:, 1] < 2.0).all()
    with pytest.raises(MeshError, match="is the boundary"):
        slid(mesh, mesh.halfedge(0, 1), 0.2)


def test_lines_end_on_curves_and_interfaces_stay():
    document = Document(two_regions())
    mesh = document.mesh
    with pytest.raises(MeshError, match="none of its vertices can move"):
        slid(mesh, mesh.halfedge(1, 4), 0.2)
    ring = Document(annulus())
    mesh = ring.mesh
    h = mesh.halfedge(0, 4) if mesh.halfedge(0, 4) >= 0 else mesh.halfedge(4, 0)
    block_edits.slide(ring, h, 0.25)
    assert np.hypot(*mesh.points[[0, 4], :2].T) == pytest.approx([1.0, 2.0])
    assert mesh.points[0, 1] != 0.0
    assert mesh.off_curve().max() < 1e-12


def test_a_line_becomes_straight_between_its_ends_and_blocks_stay_valid():
    document = Document(blocks(4, 2))
    mesh = document.mesh
    document.move(np.array([6, 7]), np.array([[1.0, 1.3, 0.0], [2.0, 0.8, 0.0]]))
    block_edits.straighten(document, mesh.halfedge(6, 7))
    assert np.allclose(mesh.points[5:10, 1], 1.0)
    with pytest.raises(MeshError, match="straight already"):
        block_edits.straighten(document, mesh.halfedge(6, 7))
    assert len(document.history) == 2
    document.set_locked(7, True)
    document.move(np.array([6]), np.array([[1.0, 1.2, 0.0]]))
    block_edits.straighten(document, mesh.halfedge(6, 7))
    assert mesh.points[6, 1] == pytest.approx(1.0)


def test_previews_come_rough_and_then_smooth_and_can_be_stopped():
    document = Document(annulus())
    document.plan_grid(GridPlan(divide=5), "Divide")
    shown = []
    previews(planned(document), shown.append, lambda: False)
    assert [one.final for one in shown] == [False, True]
    assert len(shown[1].lines) == 4 * 8
    assert shown[1].quality.inverted == 0
    shown.clear()
    previews(planned(document), shown.append, lambda: bool(shown))
    assert [one.final for one in shown] == [False]


def test_a_mesh_of_many_quads_is_no_block_structure():
    with pytest.raises(MeshError, match="shown at most"):
        PlannedBlocks.of(blocks(MOST_BLOCKS // 50 + 1, 50))
