"""Rings of quads along closed loops: counts, irregularities, refusals, undo, and random operations
against the face list.
"""

from __future__ import annotations

import numpy as np
import pytest
from tests.helpers import curved_meshes
from tests.helpers.tiny_meshes import grid

from meshwright_core import HalfEdgeMesh, OperationRefused
from meshwright_core.domains.block_parts import PARTS
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.operations import refusals
from meshwright_core.testing.fuzzing import agree, fuzz, snapshot

RING = "insert_ring"


def boundary_halfedges(mesh: HalfEdgeMesh) -> list[int]:
    """The half-edges along the boundary."""
    return [h for h in range(4 * mesh.n_elements) if mesh.live(h) and mesh.twin(h) < 0]


def frame() -> HalfEdgeMesh:
    """A square with a square hole, of eight quads; vertices 0-7 outside, 8-15 at the hole."""
    outside = [(-2, -2), (0, -2), (2, -2), (2, 0), (2, 2), (0, 2), (-2, 2), (-2, 0)]
    points = [(x, y) for x, y in outside] + [(x / 2, y / 2) for x, y in outside]
    quads = [[i, (i + 1) % 8, 8 + (i + 1) % 8, 8 + i] for i in range(8)]
    return HalfEdgeMesh.from_elements(points, quads)


def test_a_ring_around_a_smooth_hole_keeps_s():
    mesh = curved_meshes.ring()
    before = mesh.n_vertices, mesh.n_elements, mesh.n_edges, mesh.score, mesh.optimum
    hole = mesh.boundary_loops()[-1]
    h = next(h for h in boundary_halfedges(mesh) if mesh.origin(h) in hole)
    first = snapshot(mesh)
    edit = mesh.apply(RING, h)
    length = len(hole)
    assert len(edit.new_vertices) == length and edit.score_change == 0
    assert (mesh.n_vertices, mesh.n_elements, mesh.n_edges, mesh.score, mesh.optimum) == (
        before[0] + length, before[1] + length, before[2] + 2 * length, *before[3:],
    )  # fmt: skip
    mesh.validate()
    assert set(mesh.boundary_loops()[-1]) == set(hole)
    assert (mesh.degree()[hole] == 3).all() and (mesh.curve_ids()[edit.new_vertices,] == -1).all()
    mesh.undo()
    assert agree(first, snapshot(mesh))


def test_irregularities_of_a_smooth_loop_move_inside():
    mesh = mesh_domain(PARTS["plate with three holes"](), "quad")
    loops = mesh.boundary_loops()
    hole = min(loops[1:], key=len)
    h = next(h for h in boundary_halfedges(mesh) if mesh.origin(h) in hole)
    delta = mesh.irregularity()
    mesh.apply(RING, h)
    mesh.validate()
    assert (mesh.irregularity()[hole] == 0).all()
    assert mesh.score == np.abs(delta).sum()


def test_corners_of_the_loop_count():
    mesh = frame()
    h = mesh.halfedge(0, 1)
    corners = [0, 2, 4, 6]
    assert mesh.degree()[corners].tolist() == mesh.desired()[corners].tolist() == [3, 3, 3, 3] or (
        mesh.desired()[corners].tolist() == [2, 2, 2, 2]
    )
    edit = mesh.apply(RING, h)
    mesh.validate()
    # four corners of 90 degrees have one edge too many both before and after it
    assert edit.score_change == mesh.score - frame().score
    assert mesh.degree()[corners].tolist() == [3, 3, 3, 3]
    square = grid(2, 2)
    edit = square.apply(RING, boundary_halfedges(square)[0])
    # corners of one quad become corners of two, and leave vertices of three edges behind
    assert (edit.score_change, square.score) == (8, 8)
    square.validate()


def test_the_inner_side_of_a_reentrant_corner():
    mesh = frame()
    h = next(h for h in boundary_halfedges(mesh) if mesh.origin(h) >= 8)
    edit = mesh.apply(RING, h)
    mesh.validate()
    assert len(edit.new_vertices) == 8
    corners = [8, 10, 12, 14]
    assert mesh.desired()[corners].tolist() == [4, 4, 4, 4]
    assert edit.score_change == mesh.score - frame().score


def test_along_either_side_of_a_closed_interface():
    mesh = mesh_domain(PARTS["inlay"](), "quad")
    h = next(
        h for h in range(4 * mesh.n_elements)
        if mesh.twin(h) >= 0 and mesh.check(RING, h)
    )  # fmt: skip
    areas, names = mesh.n_elements, mesh.region_names
    for side in (h, mesh.twin(h)):
        part = int(mesh.regions()[side // 4])
        first, before = snapshot(mesh), mesh.score
        edit = mesh.apply(RING, side)
        mesh.validate()
        assert (edit.score_change, mesh.score, mesh.optimum) == (0, before, 8)
        new = mesh.regions()[areas:]
        assert (new == part).all() and len(new) == len(edit.new_vertices)
        mesh.undo()
        assert agree(first, snapshot(mesh))
    assert mesh.region_names == names


def test_an_interface_that_ends_at_the_loop_goes_through_the_ring():
    mesh = mesh_domain(PARTS["two layers"](), "quad")
    [interface] = mesh.interfaces
    edit = mesh.apply(RING, boundary_halfedges(mesh)[0])
    mesh.validate()
    on_it = [v for v in edit.new_vertices if mesh.curve_ids()[v] == interface.curve]
    assert len(on_it) == 2 and mesh.off_curve().max() < 1e-12
    mesh.undo()
    mesh.redo()
    mesh.validate()


@pytest.mark.parametrize("middle", [1, 2])
def test_an_interface_of_one_edge_across_the_domain(middle):
    mesh = grid(2, 1)
    points, elements = mesh.points.copy(), mesh.elements()
    parted = HalfEdgeMesh.from_elements(points, elements, regions=[0, 1])
    edit = parted.apply(RING, boundary_halfedges(parted)[middle])
    parted.validate()
    curve = parted.interfaces[0].curve
    on_it = [v for v in edit.new_vertices if parted.curve_ids()[v] == curve]
    assert np.allclose(np.sort(parted.points[on_it, 1]), [1 / 3, 2 / 3])


def test_refusals():
    mesh = frame()
    inner = next(h for h in range(32) if mesh.twin(h) >= 0)
    assert mesh.check(RING, inner).code == refusals.NO_LOOP
    with pytest.raises(OperationRefused, match="lies within a region"):
        mesh.apply(RING, inner)
    layers = mesh_domain(PARTS["two layers"](), "quad")
    regions = layers.regions()
    across = next(
        h for h in range(4 * layers.n_elements)
        if layers.twin(h) >= 0 and regions[h // 4] != regions[layers.twin(h) // 4]
    )  # fmt: skip
    assert layers.check(RING, across).code == refusals.LOOP_NOT_CLOSED
    mesh.degree_cap = 3
    assert mesh.check(RING, boundary_halfedges(mesh)[0]).code == refusals.DEGREE_CAP


def test_two_interfaces_at_a_vertex_of_the_loop():
    points = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1), (0.5, 1.5), (1.5, 1.5)]
    # three quads around vertex 1 of the lower side
    quads = [[0, 1, 4, 5], [1, 2, 3, 4]]
    two = HalfEdgeMesh.from_elements(points[:6], quads, regions=[0, 1])
    assert two.check(RING, two.halfedge(0, 1))
    fan = [(0, 0), (1, 0), (2, 0), (2, 1), (1.5, 2), (1, 1.2), (0.5, 2), (0, 1)]
    quads = [[0, 1, 6, 7], [1, 4, 5, 6], [1, 2, 3, 4]]
    three = HalfEdgeMesh.from_elements(fan, quads, regions=[0, 1, 2])
    assert three.check(RING, three.halfedge(0, 1)).code == refusals.INTERFACES_AT_LOOP


@pytest.mark.parametrize("interfaces", [False, True])
def test_random_operations_with_rings(interfaces):
    found = fuzz("quad", 250, seed=5, curved=True, interfaces=interfaces)
    assert found["violations"] == 0
