"""Previews of operations, and their changes of s."""

import subprocess
import sys

import curved_meshes
import numpy as np
import pytest

from meshwright.document.operation_preview import best, choices, following, ghost
from meshwright_core import OperationRefused


@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_the_numbers_are_those_of_the_operations(kind, star, triangles):
    mesh = star if kind == "quad" else triangles
    mesh.apply(*next((c.operation, h) for h in range(12) for c in choices(mesh, h) if c.allowed))
    for e in mesh.element_ids()[::3].tolist():
        for halfedge in range(mesh.k * e, mesh.k * e + mesh.k):
            offered = choices(mesh, halfedge)
            for choice in offered:
                assert choice.allowed == (choice.change is not None)
                if choice.allowed:
                    seen = ghost(mesh, choice.operation, halfedge)
                    edit = mesh.apply(choice.operation, halfedge)
                    mesh.undo()
                    assert choice.change == seen.change == edit.score_change
            open_to = [c for c in offered if c.allowed]
            local = [c for c in open_to if c.info.is_local] or open_to
            chosen = best(offered)
            assert chosen is None or chosen.change == min(c.change for c in local)


def test_a_ghost_of_a_split_shows_the_new_vertices_on_their_curves():
    seen = ghost(curved_meshes.ring(), "global_split", 0)  # along the spoke at 45 degrees
    assert np.abs(np.hypot(*seen.fresh.T) - 2.0).max() < 1e-14
    assert np.sort(np.arctan2(seen.fresh[:, 1], seen.fresh[:, 0])) == pytest.approx(
        [0.0, np.pi / 2], abs=1e-12
    )
    assert (len(seen.added), len(seen.removed)) == (2, 1)  # halves of arcs are neither


def test_the_bounds_of_a_ghost_hold_its_curved_edges():
    mesh = curved_meshes.disc()
    halfedge = next(
        h
        for h in range(4 * mesh.n_elements)
        if mesh.check("collapse", h) and len(ghost(mesh, "collapse", h).removed)
    )
    seen = ghost(mesh, "collapse", halfedge)
    bent = np.concatenate(
        [part.polylines(0.01)[0] for part in (seen.added_edges, seen.removed_edges)]
    )
    low, high = np.array(seen.bounds[:2]) - 0.02, np.array(seen.bounds[2:]) + 0.02
    assert (bent[:, :2] >= low).all() and (bent[:, :2] <= high).all()


def test_a_ghost_lies_in_the_plane_and_within_its_bounds(star):
    halfedge = next(h for h in range(40) if star.check("global_split", h))
    seen = ghost(star, "global_split", halfedge)
    assert seen.added.shape[1:] == (2, 2)
    low, high = np.array(seen.bounds[:2]), np.array(seen.bounds[2:])
    assert (seen.added.reshape(-1, 2) >= low).all() and (seen.places <= high).all()
    assert len(seen.places) == len(seen.delta) > 0


def test_cycling_through_allowed_operations(star):
    halfedge = next(h for h in range(40) if sum(c.allowed for c in choices(star, h)) > 2)
    offered = choices(star, halfedge)
    allowed = [choice.operation for choice in offered if choice.allowed]
    at, met = None, []
    for _ in allowed:
        at = following(offered, at, 1).operation
        met.append(at)
    assert met == allowed
    assert following(offered, at, 1).operation == allowed[0]
    assert following(offered, allowed[0], -1).operation == allowed[-1]
    assert following((), None, 1) is None


def test_refused_operations_have_no_preview(star):
    boundary = next(h for h in range(40) if star.twin(h) < 0)
    with pytest.raises(OperationRefused):
        ghost(star, "flip_left", boundary)


@pytest.mark.parametrize(
    "module",
    [
        "meshwright.document.operation_preview",
        "meshwright.document.selection",
        "meshwright.document.vertex_drag",
    ],
)
def test_import_brings_neither_qt_nor_torch(module):
    code = (
        f"import sys, {module}; "
        "sys.exit(any(m.split('.')[0] in ('torch', 'qtpy', 'PySide6', 'meshwright_agent') "
        "for m in sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0
