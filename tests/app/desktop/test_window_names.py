"""Names in the window: selected sides and regions are named, renamed, shown, and asked about."""

import os

import numpy as np
import pytest
from driving import WAIT
from qtpy.QtCore import Qt, QTimer
from qtpy.QtWidgets import QApplication

from meshwright.desktop.editing.names_dialog import NamesDialog
from meshwright.desktop.files.save_question import QuestionDialog
from meshwright.document import named_parts
from meshwright.document.named_parts import unnamed_sides
from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import gallery, meshing


@pytest.fixture
def plate() -> HalfEdgeMesh:
    """Four by two unit quads in two regions; vertex i + 5 j at (i, j)."""
    points = np.array([(i, j) for j in range(3) for i in range(5)], float)
    corners = [i + 5 * j for j in range(2) for i in range(4)]
    quads = [(c, c + 1, c + 6, c + 5) for c in corners]
    return HalfEdgeMesh.from_elements(points, quads, regions=[0, 0, 1, 1] * 2)


def opened(window, act):
    """Open the dialog of names by its action and do something in it."""
    met = []

    def look() -> None:
        dialog = QApplication.activeModalWidget()
        if isinstance(dialog, NamesDialog):
            timer.stop()
            met.append(dialog)
            try:
                act(dialog)
            finally:
                dialog.accept()

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(20)
    window.actions_by_id["names"].trigger()
    timer.stop()
    assert len(met) == 1


def rows(dialog) -> list[tuple[str, str]]:
    table = dialog.table
    return [
        (table.item(row, 0).text(), table.item(row, 1).text()) for row in range(table.rowCount())
    ]


def test_selected_sides_and_regions_are_named_and_renamed(qtbot, open_window, plate):
    window = open_window(plate)
    document = window.document
    document.selection.set(np.array([0, 1, 2]))
    seen = []

    def name_inlet(dialog):
        dialog.name.setText("inlet")
        assert dialog.sides.text() == "Name 2 edges"
        assert not dialog.regions.isEnabled()
        dialog.sides.click()
        seen.extend(rows(dialog))

    opened(window, name_inlet)
    assert seen[0] == ("inlet", "side, 2 edges")
    assert {about for name, about in seen[1:-2] if not name} == {"side, 2 edges"}
    assert seen[-2:] == [("", "region 1, 4 quads"), ("", "region 2, 4 quads")]
    assert document.mesh.geometric()[[0, 2]].all()
    assert document.history.last.title == "Name sides inlet"
    qtbot.waitUntil(lambda: window.names.layer.names == ("inlet",), timeout=WAIT)

    def more(dialog):
        dialog.table.item(0, 0).setText("wall; hot")
        dialog.table.item(dialog.table.rowCount() - 1, 0).setText("steel")
        seen[:] = rows(dialog)

    opened(window, more)
    assert ("wall", "side, 2 edges") in seen
    assert ("hot", "side, 2 edges") in seen
    assert document.mesh.region_names.count("steel") == 1
    assert set(document.mesh.sides()) == {"wall; hot", ""}
    for _ in range(3):
        window.actions_by_id["undo"].trigger()
    assert set(document.mesh.sides()) == {""}
    assert document.mesh.region_names == ("", "")
    qtbot.waitUntil(lambda: window.names.layer.empty, timeout=WAIT)


def test_sides_without_a_name_are_listed_shown_and_named_by_keys(qtbot, open_window, square):
    window = open_window(square)
    document, seen = window.document, []

    def act(dialog):
        dialog.activateWindow()  # there is no window manager to do it
        qtbot.waitUntil(dialog.isActiveWindow, timeout=WAIT)
        assert rows(dialog) == [("", "side, 2 edges")] * 4 + [("", "region 1, 4 quads")]
        assert dialog.sides.text() == "Name edges" and not dialog.sides.isEnabled()
        table = dialog.table
        at = table.visualItemRect(table.item(1, 0)).center()
        qtbot.mouseClick(table.viewport(), Qt.MouseButton.LeftButton, pos=at)
        seen.append(document.selection.vertices.tolist())
        assert dialog.sides.text() == "Name 2 edges"
        qtbot.mouseClick(dialog.name, Qt.MouseButton.LeftButton)
        qtbot.keyClicks(dialog.name, "inlet")
        qtbot.keyClick(dialog.name, Qt.Key.Key_Return)
        assert rows(dialog)[0] == ("inlet", "side, 2 edges")
        assert not dialog.name.text()
        assert len(rows(dialog)) == 5
        table.item(4, 0).setText("steel")
        qtbot.keyClicks(dialog.name, "nothing")  # no line, and nothing but the side is selected
        if folder := os.environ.get("MESHWRIGHT_PICTURES"):
            dialog.grab().save(f"{folder}/names-dialog.png")
        qtbot.keyClick(dialog.name, Qt.Key.Key_Return)

    opened(window, act)
    assert len(seen[0]) == 3
    assert document.mesh.region_names == ("steel",)
    assert set(document.mesh.sides()) == {"nothing", ""}  # renamed: it was still selected
    assert len(document.mesh.sides()["nothing"]) == 2


def test_many_sides_without_a_name_are_not_listed(square, monkeypatch):
    assert len(unnamed_sides(square)) == 4
    monkeypatch.setattr(named_parts, "MOST_SIDES", 3)
    assert [part.sides for part in named_parts.named_parts(square)] == [False]


def test_a_curve_without_corners_is_one_side_and_named_edges_cut_it():
    mesh = meshing.mesh_domain(gallery.shape("disc"), "quad", 0.3)
    (side,) = unnamed_sides(mesh)
    assert len(side) == sum(len(loop) for loop in mesh.boundary_loops())
    mesh.name_sides(side[2:5], "wall")
    (rest,) = unnamed_sides(mesh)
    assert set(rest.tolist()) == set(side.tolist()) - set(side[2:5].tolist())
    ends = [mesh.target(h) for h in rest[:-1].tolist()]
    assert ends == [mesh.origin(h) for h in rest[1:].tolist()]


@pytest.fixture
def square() -> HalfEdgeMesh:
    """Two by two unit quads."""
    return meshing.grid("quad", 4)


def test_named_sides_are_drawn_until_they_are_switched_off(qtbot, open_window, plate):
    window = open_window(plate)
    mesh = window.document.mesh
    window.document.name_sides(np.array([mesh.halfedge(i, i + 1) for i in range(4)]), "wall")
    window.document.name_sides(np.array([mesh.halfedge(2, 7), mesh.halfedge(7, 12)]), "joint")
    qtbot.waitUntil(lambda: window.names.layer.names == ("joint", "wall"), timeout=WAIT)
    colour = window.names.colour_of("wall")
    wanted = tuple(int(colour[i : i + 2], 16) for i in (1, 3, 5))
    picture = window.canvas.grab().toImage()
    if folder := os.environ.get("MESHWRIGHT_PICTURES"):
        picture.save(f"{folder}/names.png")
    seen = {
        (one.red(), one.green(), one.blue())
        for x in range(0, picture.width(), 2)
        for y in range(0, picture.height(), 2)
        for one in (picture.pixelColor(x, y),)
    }
    assert min(sum(abs(a - b) for a, b in zip(wanted, one, strict=True)) for one in seen) < 12
    window.actions_by_id["show_names"].trigger()
    assert window.names.layer.empty


def test_saving_where_names_are_lost_asks_once(qtbot, open_window, plate, tmp_path):
    window = open_window(plate)
    mesh = window.document.mesh
    window.document.name_sides(np.array([mesh.halfedge(0, 1)]), "wall")
    path = tmp_path / "plate.obj"
    asked = []

    def answer(wanted: str) -> QTimer:
        def look() -> None:
            dialog = QApplication.activeModalWidget()
            if isinstance(dialog, QuestionDialog):
                timer.stop()
                asked.append(dialog.answer_text)
                dialog.buttons[wanted].click()

        timer = QTimer()
        timer.timeout.connect(look)
        timer.start(20)
        return timer

    timer = answer("")
    assert not window.files._save(str(path))
    assert not path.exists()
    timer = answer("save")
    assert window.files._save(str(path))
    assert len(asked) == 2
    assert "'wall'" in asked[0]
    assert window.files.save()
    assert len(asked) == 2
    timer.stop()
