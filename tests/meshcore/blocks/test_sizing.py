"""Numbers of cells: sizes, layers, given numbers, and what they say when they contradict."""

import numpy as np
import pytest
from block_meshes import annulus, corner_blocks, quarter_ring

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.blocks.grading_sections import sections
from meshwright_core.blocks.sizing import Sizing, WallLayer, division, flat_layers, layer_cells
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.core.grid_plan import Grading


def counts(mesh, **wanted) -> list[int]:
    structure = BlockStructure.of(mesh)
    found = division(structure, Sizing(**wanted))
    return found.counts[structure.crossing].tolist()


def test_a_size_and_a_division_give_numbers():
    assert counts(corner_blocks(), size=0.25) == [[4, 4]] * 3
    assert counts(corner_blocks(), divide=7) == [[7, 7]] * 3
    ((first, second),) = counts(quarter_ring(), size=0.1)
    assert first == 10
    assert 15 <= second <= 32  # the arcs are 15.7 and 31.4 long


def test_a_size_on_a_side_counts_there():
    finer = counts(quarter_ring(), size=0.1, side_sizes={"start": 0.05, "end": 0.05})
    assert finer[0][0] == 20


def test_without_a_size_the_geometry_decides():
    ((first, second),) = counts(quarter_ring())
    assert first >= 3
    assert second >= 6  # 90 degrees in steps of 15


def test_layers_take_the_cells_that_their_growth_needs():
    assert layer_cells(1.0, 0.1, 0.0, 0.0, 1.2) == pytest.approx(10.0)
    one = layer_cells(1.0, 0.1, 1e-3, 0.0, 1.2)
    both = layer_cells(0.6, 0.1, 1e-3, 1e-3, 1.2)
    steps = np.log(100.0) / np.log(1.2)
    covered = 1e-3 * (1.2**steps - 1.0) / 0.2
    assert one == pytest.approx(steps + (1.0 - covered) / 0.1)
    # two layers that meet before they reach the size
    assert 2.0 * steps > both > steps
    assert layer_cells(0.1, 0.1, 1e-3, 0.0, 1.2) < steps


def test_walls_set_heights_along_their_chords_at_the_right_end():
    structure = BlockStructure.of(annulus())
    found = division(structure, Sizing(size=0.1, walls=(WallLayer("wall", 0.01, 1.3),)))
    heights = np.stack([found.first, found.last])
    graded = np.flatnonzero(heights.max(axis=0) > 0.0)
    assert len(graded) == 1
    end = int(heights[:, graded[0]].argmax())
    assert heights[end, graded[0]] == 0.01
    assert heights[1 - end, graded[0]] == 0.0
    for edge in np.flatnonzero(structure.chord == graded[0]):
        near = structure.points[structure.edges[edge][end]]
        assert np.linalg.norm(near) == pytest.approx(1.0)
    assert found.ratio[graded[0]] == 1.3


def test_given_numbers_hold_and_contradictions_are_named():
    mesh = corner_blocks()
    assert counts(mesh, size=0.25, edge_counts={(0, 1): 6})[0][0] == 6
    with pytest.raises(MeshError, match=r"edge 0-1 and edge 7-4 are on chord \d+, .* 6 and 5"):
        counts(mesh, edge_counts={(0, 1): 6, (7, 4): 5})
    with pytest.raises(MeshError, match="no block edge between vertices 0 and 3"):
        counts(mesh, edge_counts={(0, 3): 6})
    assert counts(quarter_ring(), size=0.1, side_counts={"outer": 12})[0][1] == 12
    with pytest.raises(MeshError, match=r"12 cells on outer.*13 cells on inner.*share chords"):
        counts(quarter_ring(), size=0.1, side_counts={"outer": 12, "inner": 13})
    with pytest.raises(MeshError, match="consists of 8 block edges"):
        counts(mesh, side_counts={"outline": 3})


@pytest.mark.parametrize(
    "wanted",
    [
        {"size": -1.0},
        {"size": 0.1, "divide": 3},
        {"divide": 0},
        {"chord_counts": {99: 3}},
        {"size": 1e-6},
    ],
)
def test_sizings_that_do_not_fit_are_refused(wanted):
    with pytest.raises(MeshError):
        counts(corner_blocks(), **wanted)


@pytest.mark.parametrize(("height", "ratio"), [(0.0, 1.2), (0.1, 0.5), (float("nan"), 1.2)])
def test_layers_that_do_not_fit_are_refused(height, ratio):
    with pytest.raises(MeshError):
        WallLayer("wall", height, ratio)


def test_sections_describe_a_graded_line():
    sizes = np.array([1.0, 2.0, 4.0, 5.0, 5.0, 5.0])
    found = sections(sizes)
    rebuilt = []
    for part in found:
        line = part.ratio ** np.arange(part.cells)
        rebuilt.append(part.share * line / line.sum())
    assert np.concatenate(rebuilt) == pytest.approx(sizes / sizes.sum())
    assert [(part.cells, part.ratio) for part in found] == [(3, 2.0), (3, 1.0)]
    assert sections(np.ones(5)) == [(1.0, 5, 1.0)]


def test_layers_higher_than_the_cells_are_said():
    structure = BlockStructure.of(annulus())

    def said(*walls: WallLayer, **more) -> tuple[str, ...]:
        sizing = Sizing(size=0.1, walls=walls, **more)
        return flat_layers(structure, sizing, division(structure, sizing))

    assert said(WallLayer("wall", 0.01)) == ()
    assert said(WallLayer("wall", 0.5)) == (
        "The layer at wall has no effect: its first cell of 0.5 would be higher than the cells "
        "there, 0.1.",
    )
    # the thinner of two wishes for a side holds, and is no surprise
    assert said(WallLayer("wall", 0.5), WallLayer("wall", 0.01)) == ()
    assert len(said(WallLayer("far", 0.01), WallLayer("wall", 0.5))) == 1
    a, b = structure.vertices[structure.edges[0]].tolist()
    (grading,) = said(edge_gradings={(a, b): Grading(2.0, 0.0, 1.2)})
    assert "The grading of chord" in grading


def test_a_layer_that_is_too_high_along_a_part_of_its_side_is_said():
    points = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 0.1), (2, 0.1)]
    mesh = HalfEdgeMesh.from_elements(np.array(points, float), [[0, 1, 4, 3], [1, 2, 5, 4]])
    structure = BlockStructure.of(mesh)
    sizing = Sizing(divide=5, walls=(WallLayer("outline", 0.05),))
    (said,) = flat_layers(structure, sizing, division(structure, sizing))
    assert "no effect along 2 of its 6 block edges" in said
