"""The division of strips of quads: counts, s, refusals, undo, random operations, face lists."""

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

DIVIDE = "divide_chord"


def counts(mesh: HalfEdgeMesh) -> tuple[int, int, int]:
    """Vertices, edges and elements."""
    return mesh.n_vertices, mesh.n_edges, mesh.n_elements


@pytest.mark.parametrize("ends", [(0, 1), (5, 6), (9, 8)])
def test_a_strip_is_cut_from_boundary_to_boundary(ends: tuple[int, int]):
    mesh = grid(3, 2)  # vertices 0-3, 4-7, 8-11
    first, before = snapshot(mesh), counts(mesh)
    edit = mesh.apply(DIVIDE, mesh.halfedge(*ends))
    mesh.validate()
    assert edit.score_change == 0 == mesh.score
    assert counts(mesh) == (before[0] + 3, before[1] + 5, before[2] + 2)
    new = list(edit.new_vertices)
    x = mesh.points[list(ends), 0].mean()
    assert np.allclose(mesh.points[new, 0], x)
    assert sorted(mesh.degree()[new].tolist()) == [3, 3, 4]
    mesh.undo()
    assert agree(first, snapshot(mesh))


def test_a_strip_that_crosses_itself():
    mesh = mesh_domain(PARTS["plate with three holes"](), "quad")
    halfedges = [h for h in range(4 * mesh.n_elements) if mesh.check(DIVIDE, h)]
    for h in halfedges:
        first, before = snapshot(mesh), (mesh.score, mesh.optimum)
        edit = mesh.apply(DIVIDE, h)
        mesh.validate()
        assert edit.score_change == 0 and (mesh.score, mesh.optimum) == before
        mesh.undo()
        assert agree(first, snapshot(mesh))


def test_a_strip_that_closes_is_refused():
    mesh = curved_meshes.ring()
    closed = [
        h for h in range(4 * mesh.n_elements)
        if mesh.check(DIVIDE, h).code == refusals.NEVER_ENDS
    ]  # fmt: skip
    assert closed
    first = snapshot(mesh)
    with pytest.raises(OperationRefused, match="never reach the boundary"):
        mesh.apply(DIVIDE, closed[0])
    assert agree(first, snapshot(mesh))
    # across them it is cut along its boundary curves
    edit = mesh.apply(DIVIDE, next(h for h in range(4 * mesh.n_elements) if mesh.check(DIVIDE, h)))
    rows = [v for v in edit.new_vertices if mesh.curve_ids()[v] >= 0]
    assert len(rows) == 2 and mesh.off_curve()[rows].max() < 1e-12


def test_collapsing_one_half_gives_back_the_mesh():
    mesh = grid(3, 3)
    mesh.apply(DIVIDE, mesh.halfedge(1, 2))
    mesh.apply("chord_collapse", mesh.halfedge(1, 16))
    mesh.validate()
    assert counts(mesh) == counts(grid(3, 3))


@pytest.mark.parametrize("interfaces", [False, True])
def test_random_operations_agree_with_the_face_list(interfaces: bool):
    found = fuzz("quad", 150, 5, curved=True, interfaces=interfaces)
    assert found["violations"] == 0


def test_regions_keep_their_areas():
    mesh = mesh_domain(PARTS["two layers"](), "quad")
    for h in [h for h in range(4 * mesh.n_elements) if mesh.check(DIVIDE, h)][::5]:
        before = np.bincount(mesh.regions()[mesh.element_ids()])
        mesh.apply(DIVIDE, h)
        mesh.validate()
        assert (np.bincount(mesh.regions()[mesh.element_ids()]) >= before).all()
        mesh.undo()
