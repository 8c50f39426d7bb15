"""Minimal meshes on which weaker conditions leave two edges between the same vertices."""

import numpy as np
import pytest
from tiny_meshes import grid, ring, square_of_triangles

from meshwright_core import HalfEdgeMesh
from meshwright_core.operations import refusals


def _apply_allowed(mesh, sequence):
    """Apply the operations that are allowed; the mesh must be valid after each."""
    for operation, h in sequence:
        if mesh.check(operation, h):
            mesh.apply(operation, h)
        mesh.validate()


def test_flips_after_two_splits_of_a_square_of_triangles():
    _apply_allowed(square_of_triangles(), [("split", 2), ("split", 3), ("flip", 3), ("flip", 2)])


@pytest.mark.parametrize(
    "sequence",
    [
        [("flip_left", 12), ("split", 1), ("flip_left", 2), ("flip_left", 12)],
        [("split", 12), ("flip_left", 15), ("split", 18), ("collapse", 21)],
    ],
    ids=["flips", "collapse"],
)
@pytest.mark.parametrize("turn", range(4))
def test_four_operations_on_a_grid_of_four_quads(sequence, turn):
    base = grid(2)
    rolled = np.roll(base.elements(), turn, axis=1)
    _apply_allowed(HalfEdgeMesh.from_elements(base.points, rolled), sequence)


def test_deleting_a_line_of_an_annulus_of_three_quads_is_refused():
    mesh = ring(3, 1)
    assert mesh.check("cleanup", mesh.halfedge(0, 3)).code == refusals.MERGED_EDGES_MEET


def test_collapsing_a_strip_of_an_annulus_of_three_quads_is_refused():
    mesh = ring(3, 1)
    assert mesh.check("chord_collapse", mesh.halfedge(1, 0)).code == refusals.MERGED_EDGES_MEET
