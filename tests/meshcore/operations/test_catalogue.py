"""The columns of the catalogue agree with what the operations do."""

import numpy as np
import pytest
from tiny_meshes import grid

from meshwright_core.domains import gallery, meshing
from meshwright_core.operations import catalogue, refusals


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_growth_and_twin_columns(kind):
    mesh = meshing.mesh_domain(gallery.shape("star"), kind)
    for info in catalogue.of_kind(kind):
        applied = 0
        for h in mesh.halfedges_of(mesh.element_ids()).ravel().tolist():
            on_boundary = mesh.twin(h) < 0
            verdict = mesh.check(info.operation, h)
            if on_boundary and info.needs_twin:
                assert verdict.code == refusals.BOUNDARY_EDGE
            if not verdict or info.growth is None:
                continue
            before = mesh.n_elements
            expected = info.growth[on_boundary]
            assert catalogue.growth(mesh.arrays, info.code, h) == expected
            mesh.apply(info.operation, h)
            assert mesh.n_elements - before == expected
            mesh.undo()
            applied += 1
        assert applied or not info.is_local


def test_apply_once_returns_the_change_and_the_touched_vertices():
    mesh = grid(3)
    h = mesh.halfedge(5, 6)
    done = catalogue.apply_once(mesh.arrays, catalogue.FLIP_LEFT, h, 0)
    assert done.code == refusals.ALLOWED
    assert done.new_count == 0
    assert set(done.touched[: done.touched_count]) == {1, 2, 5, 6, 9, 10}
    refused = catalogue.apply_once(mesh.arrays, catalogue.FLIP_LEFT, mesh.halfedge(0, 1), 0)
    assert refused == (refusals.BOUNDARY_EDGE, 0, 0, 0, (0,) * 6)


def test_kernel_columns_hold_one_row_for_each_code():
    assert [info.code for info in catalogue.CATALOGUE] == list(range(len(catalogue.CATALOGUE)))
    twins = [bool(catalogue.needs_twin(info.code)) for info in catalogue.CATALOGUE]
    assert np.array_equal(twins, [info.needs_twin for info in catalogue.CATALOGUE])
