"""The block structure: chords with one direction, edges on curves, patches by name."""

import numpy as np
import pytest
from block_meshes import annulus, corner_blocks, quarter_ring, two_regions

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.blocks.structure import SIDE_CORNERS, BlockStructure


@pytest.mark.parametrize("make", [quarter_ring, annulus, corner_blocks, two_regions])
def test_edges_run_one_way_along_a_chord(make):
    structure = BlockStructure.of(make())
    for block, corners in enumerate(structure.corners):
        for side, (a, b) in enumerate(SIDE_CORNERS):
            ends = structure.edges[structure.sides[block, side]]
            expected = corners[[a, b]] if structure.forward[block, side] else corners[[b, a]]
            assert ends.tolist() == expected.tolist()
    assert (structure.forward[:, 0] == structure.forward[:, 2]).all()
    assert (structure.forward[:, 1] == structure.forward[:, 3]).all()
    assert (structure.chord[structure.sides[:, 0]] == structure.chord[structure.sides[:, 2]]).all()


def test_neighbours_lie_left_and_right_of_an_edge():
    structure = BlockStructure.of(corner_blocks())
    for edge, (left, right) in enumerate(structure.neighbours):
        start, end = structure.points[structure.edges[edge]]
        for block, sign in ((left, 1.0), (right, -1.0)):
            if block >= 0:
                middle = structure.points[structure.corners[block]].mean(axis=0)
                assert sign * np.cross(end - start, middle - start)[2] > 0.0


def test_lengths_and_points_are_those_of_the_curves():
    structure = BlockStructure.of(quarter_ring())
    assert sorted(structure.lengths) == pytest.approx([1.0, 1.0, 0.5 * np.pi, np.pi], rel=1e-4)
    outer = int(structure.patch("outer").edges[0])
    at = structure.edge_points(np.full(5, outer), np.linspace(0.0, 1.0, 5))
    assert np.abs(np.linalg.norm(at, axis=1) - 2.0).max() < 1e-12
    angle = np.diff(np.unwrap(np.arctan2(at[:, 1], at[:, 0])))
    assert np.abs(angle) == pytest.approx(np.full(4, np.pi / 8), rel=1e-4)


def test_patches_have_the_names_of_the_drawing_or_of_the_loops():
    names = [patch.name for patch in BlockStructure.of(quarter_ring()).patches]
    assert sorted(names) == ["end", "inner", "outer", "start"]
    assert sorted(p.name for p in BlockStructure.of(annulus()).patches) == ["far", "wall"]
    (only,) = BlockStructure.of(corner_blocks()).patches
    assert (only.name, len(only.edges)) == ("outline", 8)
    with pytest.raises(MeshError, match=r"no side named 'x'; there are outline\."):
        BlockStructure.of(corner_blocks()).patch("x")


def test_holes_without_names_are_numbered():
    points = [(0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2)]
    quads = [[i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4] for i in range(4)]
    patches = BlockStructure.of(HalfEdgeMesh.from_elements(points, quads)).patches
    assert sorted(patch.name for patch in patches) == ["hole_1", "outline"]


def test_triangles_and_empty_meshes_are_refused():
    triangle = HalfEdgeMesh.from_elements([(0, 0), (1, 0), (0, 1)], [[0, 1, 2]])
    with pytest.raises(MeshError, match="Only quad meshes"):
        BlockStructure.of(triangle)
