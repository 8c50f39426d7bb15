"""Parts of a mesh in which things may change while everything outside stays."""

import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh, MeshError, Operation
from meshwright_core.analysis.submesh import enclose, temporarily_locked
from meshwright_core.domains import meshing
from meshwright_core.geometry.smoothing import relax


@pytest.fixture
def grid() -> HalfEdgeMesh:
    """4 x 4 quads, numbered row by row."""
    return meshing.grid("quad", 16)


def corners(mesh, elements):
    return {mesh.origin(4 * e + i) for e in elements for i in range(4)}


def test_rim_and_outside_are_held(grid):
    inside = enclose(grid, np.array([5, 6, 9, 10]))
    assert inside.elements.tolist() == [5, 6, 9, 10]
    assert len(inside.free) == 1
    assert set(inside.free) | set(inside.held) == set(grid.vertices().tolist())
    assert set(grid.neighbours(int(inside.free[0]))) <= corners(grid, [5, 6, 9, 10])


def test_vertices_of_the_boundary_are_free_where_all_their_elements_are_inside(grid):
    inside = enclose(grid, np.array([0, 1, 4, 5]))
    assert len(inside.free) == 4  # the corner, one on either side, the one in the middle


def test_the_whole_mesh_holds_nothing(grid):
    inside = enclose(grid, grid.element_ids())
    assert len(inside.held) == 0 and len(inside.free) == grid.n_vertices


@pytest.mark.parametrize("extra", [[3], [15], [3, 15], [12]])
def test_elements_that_touch_in_a_vertex_alone_are_left_out(grid, extra):
    block = [5, 6, 9, 10]
    assert enclose(grid, np.array(block + extra)).elements.tolist() == block


def test_parts_that_do_not_touch_are_all_kept():
    grid = meshing.grid("quad", 100)
    parts = [0, 1, 10, 11, 88, 89, 98, 99]
    assert enclose(grid, np.array(parts)).elements.tolist() == parts


@pytest.mark.parametrize("elements", [[], [5], [5, 6], [5, 10]])
def test_a_region_without_a_free_vertex_is_refused(grid, elements):
    with pytest.raises(MeshError, match="No vertex lies inside"):
        enclose(grid, np.array(elements, np.int64))


def test_locked_vertices_stay_and_no_lock_is_left(grid):
    inside = enclose(grid, np.array([5, 6, 9, 10]))
    kept = int(inside.held[0])
    grid.set_locked(kept)
    places = grid.points.copy()
    with temporarily_locked(grid, inside.held):
        edit = grid.apply(Operation.SPLIT, grid.outgoing(int(inside.free[0]))[0])
        relax(grid, around=edit.touched)
    assert np.array_equal(grid.points[inside.held], places[inside.held])
    assert np.flatnonzero(grid.locked()).tolist() == [kept]
    while grid.steps > 1:
        grid.undo()
    assert np.flatnonzero(grid.locked()).tolist() == [kept]
    grid.validate()


def test_locks_are_removed_after_an_exception(grid):
    held = enclose(grid, np.array([5, 6, 9, 10])).held

    def broken():
        with temporarily_locked(grid, held):
            assert grid.locked().sum() == len(held)
            grid.reserve(1000, 1000)  # other arrays
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        broken()
    assert not grid.locked().any()
