"""What a person has made is not lost: pins, curves, errors, closed surfaces; by mouse and keys."""

import numpy as np
import pytest
from driving import WAIT, beside, pixel, point_at, press
from qtpy.QtCore import Qt

from meshwright.document.document import Document
from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import gallery, meshing

pytestmark = pytest.mark.needs("window")

CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def grid() -> HalfEdgeMesh:
    """Six by four unit quads; vertex i + 7 j at (i, j)."""
    points = np.array([(i, j) for j in range(5) for i in range(7)], float)
    corners = [i + 7 * j for j in range(4) for i in range(6)]
    return HalfEdgeMesh.from_elements(points, [(c, c + 1, c + 8, c + 7) for c in corners])


def drag(qtbot, window, start, end) -> None:
    plotter = window.canvas.plotter
    first, last = pixel(window, start), pixel(window, end)
    qtbot.mouseMove(plotter, first)
    qtbot.mousePress(plotter, Qt.MouseButton.LeftButton, pos=first)
    for share in (0.3, 0.6, 1.0):
        qtbot.mouseMove(plotter, first + (last - first) * share)
    qtbot.mouseRelease(plotter, Qt.MouseButton.LeftButton, pos=last)


def test_a_dragged_vertex_is_pinned_and_p_frees_it(qtbot, open_window, grid):
    window = open_window(grid)
    drag(qtbot, window, (2, 2), (2.4, 2.3))
    there = grid.points[16].copy()
    assert "pinned" in window.status.message and "P frees it" in window.status.message
    qtbot.waitUntil(lambda: len(window.canvas.markers.pinned_places) == 1, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_M, CONTROL)
    assert np.array_equal(grid.points[16], there)
    point_at(qtbot, window, grid.halfedge(17, 18))
    press(qtbot, window, Qt.Key.Key_F)  # an operation beside it smooths around
    assert np.array_equal(grid.points[16], there)
    qtbot.mouseMove(window.canvas.plotter, pixel(window, there))
    press(qtbot, window, Qt.Key.Key_P)
    assert window.status.message == "Vertex 16 is free to move when the mesh is smoothed."
    press(qtbot, window, Qt.Key.Key_M, CONTROL)
    assert not np.array_equal(grid.points[16], there)
    while window.document.can_undo:
        press(qtbot, window, Qt.Key.Key_Z, CONTROL)
    assert not grid.pinned().any()
    assert grid.points[16].tolist() == [2.0, 2.0, 0.0]


def test_lock_corner_and_desired_degree_have_keys(qtbot, open_window, grid):
    window = open_window(grid)
    press(qtbot, window, Qt.Key.Key_K)
    assert window.status.message.startswith("Point at a vertex first")
    window.canvas.pin(grid.halfedge(16, 17))  # as by keyboard
    press(qtbot, window, Qt.Key.Key_K)
    assert grid.locked()[16] and window.status.message == "Vertex 16 is locked."
    press(qtbot, window, Qt.Key.Key_K)
    assert not grid.locked()[16]
    press(qtbot, window, Qt.Key.Key_5, Qt.KeyboardModifier.AltModifier)
    assert grid.desired()[16] == 5
    window.canvas.pin(grid.halfedge(2, 3))
    press(qtbot, window, Qt.Key.Key_O)
    assert grid.geometric()[2] and window.status.message == "Vertex 2 is a corner."
    window.document.selection.set([8, 9])
    press(qtbot, window, Qt.Key.Key_P)
    assert np.flatnonzero(grid.pinned()).tolist() == [8, 9]
    assert window.status.message == "2 vertices are pinned."


def hole_area(mesh: HalfEdgeMesh) -> float:
    from meshwright_core.geometry.edge_lines import EdgeLines

    lines, areas = EdgeLines(mesh, 1e-6), []
    for rim in lines.rims():
        x, y = lines.chained(rim).T
        areas.append(0.5 * float(x @ np.roll(y, -1) - np.roll(x, -1) @ y))
    return min(areas, key=abs)


def test_clean_all_and_collapses_keep_a_round_hole(qtbot, open_window, tmp_path):
    mesh = meshing.mesh_domain(gallery.shape("filleted-bracket"), "quad")
    window = open_window(mesh)
    before = hole_area(mesh)
    press(qtbot, window, Qt.Key.Key_L, CONTROL)
    rng, done = np.random.default_rng(3), 0
    for _ in range(60):
        if done == 5:
            break
        h = int(rng.choice(mesh.element_ids())) * 4 + int(rng.integers(4))
        if not mesh.check("collapse", h):
            continue
        qtbot.mouseMove(window.canvas.plotter, beside(window, h))
        if window.document.hover == h:
            press(qtbot, window, Qt.Key.Key_C)
            done += 1
    press(qtbot, window, Qt.Key.Key_L, CONTROL)
    assert done == 5
    assert mesh.off_curve().max() < 1e-9
    assert hole_area(mesh) == pytest.approx(before, rel=1e-4)
    window.files._save(str(tmp_path / "kept.meshwright"))
    kept = Document()
    kept.open(tmp_path / "kept.meshwright")
    assert hole_area(kept.mesh) == pytest.approx(before, rel=1e-4)
    window.files._save(str(tmp_path / "straight.vtk"))
    assert "has straight edges" in window.notice.text


def test_errors_reach_the_notice_bar(qtbot, open_window, grid, monkeypatch):
    window = open_window(grid)
    with qtbot.captureExceptions() as caught:
        window.errors.watch()
        monkeypatch.setattr(window.document, "clean_all", lambda: np.zeros(0).max())
        press(qtbot, window, Qt.Key.Key_L, CONTROL)
        window.errors.close()
    assert len(caught) == 1
    assert window.notice.text.startswith("Something went wrong: Zero-size array")
    assert window.notice.text.endswith("The mesh and its history are kept.")


@pytest.mark.parametrize("way", [".meshwright", ".obj"])
def test_a_saved_closed_surface_can_be_edited(qtbot, open_window, tmp_path, way):
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(1)
    Document(HalfEdgeMesh.from_elements(ball.vertices, ball.faces)).save(tmp_path / f"ball{way}")
    window = open_window()
    window.errors.watch()
    window.files.open(tmp_path / f"ball{way}")
    told = window.notice.text  # by the reader of the file; a project has been told before
    assert ("it is a surface that is not plane" in told) == (way == ".obj")
    mesh = window.document.mesh
    for operation, key in (("flip", "F"), ("split", "S"), ("collapse", "C")):
        h = next(h for h in range(3 * mesh.n_elements) if mesh.check(operation, h))
        window.canvas.pin(h)
        press(qtbot, window, getattr(Qt.Key, f"Key_{key}"))
    press(qtbot, window, Qt.Key.Key_M, CONTROL)
    press(qtbot, window, Qt.Key.Key_U, CONTROL)
    upper = mesh.vertices()[np.argmax(mesh.points[mesh.vertices(), 2])]
    drag(qtbot, window, mesh.points[upper, :2], mesh.points[upper, :2] + 0.05)
    assert window.notice.text == told
    assert window.document.history.cursor >= 4
    mesh.validate()
    window.errors.close()
