"""Names in the window: selected sides and regions are named, renamed, shown, and asked about."""

import os

import numpy as np
import pytest
from driving import WAIT
from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QApplication

from meshwright.desktop.editing.names_dialog import NamesDialog
from meshwright.desktop.files.save_question import QuestionDialog
from meshwright_core import HalfEdgeMesh


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
    assert seen == [
        ("inlet", "side, 2 edges"),
        ("", "region 1, 4 quads"),
        ("", "region 2, 4 quads"),
    ]
    assert document.mesh.geometric()[[0, 2]].all()
    assert document.history.last.title == "Name sides inlet"
    qtbot.waitUntil(lambda: window.names.layer.names == ("inlet",), timeout=WAIT)

    def more(dialog):
        dialog.table.item(0, 0).setText("wall; hot")
        dialog.table.item(2, 0).setText("steel")
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
