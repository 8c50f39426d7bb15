"""The dialog for new meshes, driven by real mouse and key events."""

import json
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
from driving import WAIT
from qtpy.QtCore import QMimeData, QPoint, QPointF, QProcess, Qt, QTimer, QUrl
from qtpy.QtGui import QDropEvent
from qtpy.QtWidgets import QApplication

from meshwright.desktop.files.new_mesh import NewMeshDialog
from meshwright.desktop.files.new_mesh import dialog as dialog_module
from meshwright.desktop.files.new_mesh.found_regions import NONE_CHOSEN
from meshwright.desktop.files.new_mesh.mesh_process import MeshProcess
from meshwright.graphics.theme import GRID, theme
from meshwright.sources import mesh_worker, new_mesh
from meshwright.sources.new_mesh import Answer, NewMesh
from meshwright_core import read, write
from meshwright_core.domains import gallery, meshing

LEFT, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton
SQUARE = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
REQUEST = {
    "source": {"shape": "star"},
    "kind": "quad",
    "max_edge": None,
    "min_angle": None,
    "quads": None,
}


class KeptProcess(MeshProcess):
    """Leaves its process, if that has nothing to do, to the next one: imports take seconds."""

    idle: ClassVar[list[QProcess]] = []

    def start(self) -> None:
        if self._process is None and self.idle:
            process = self.idle.pop()
            process.setParent(self)
            self._attach(process)
        super().start()

    def close(self) -> None:
        if self._process is not None and self._asked is None:
            process = self._detach()
            process.setParent(None)
            self.idle.append(process)
        super().close()


@pytest.fixture(scope="module")
def _one_process():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dialog_module, "MeshProcess", KeptProcess)
        yield
    while KeptProcess.idle:
        process = KeptProcess.idle.pop()
        process.kill()
        process.waitForFinished()


@pytest.fixture
def dialog(qtbot, _one_process):
    """The dialog, after the first mesh has been made."""
    made = NewMeshDialog("quad", theme("light"))
    qtbot.addWidget(made)
    made.resize(1120, 720)  # Qt's offscreen platform has a screen of 800 by 800 pixels only
    made.show()
    made.activateWindow()
    qtbot.waitUntil(made.isActiveWindow, timeout=WAIT)
    wait_for_mesh(qtbot, made)
    yield made
    made.reject()
    assert made.maker._process is None
    assert not [timer for timer in made.findChildren(QTimer) if timer.isActive()]


def wait_for_mesh(qtbot, dialog) -> NewMesh:
    qtbot.waitUntil(lambda: dialog.made is not None, timeout=WAIT)
    return dialog.made


def wait_for_words(qtbot, dialog, words) -> None:
    qtbot.waitUntil(lambda: words in dialog.status.text(), timeout=WAIT)


class Pen:
    """Draws on the drawing page by mouse events at places of the plane."""

    def __init__(self, qtbot, dialog) -> None:
        self.qtbot, self.area = qtbot, dialog.draw.area
        dialog.tabs.buttons["draw"].click()
        qtbot.waitUntil(lambda: self.area.width() > 300, timeout=WAIT)

    def pixel(self, place) -> QPoint:
        x, y = self.area.view.to_screen(np.array(place)).tolist()
        return QPoint(round(x), round(y))

    def point(self, *place) -> None:
        self.qtbot.mouseMove(self.area, self.pixel(place))

    def click(self, *place, button=LEFT) -> None:
        self.point(*place)
        self.qtbot.mouseClick(self.area, button, pos=self.pixel(place))

    def drag(self, start, end) -> None:
        self.point(*start)
        self.qtbot.mousePress(self.area, LEFT, pos=self.pixel(start))
        middle = np.mean([start, end], axis=0)
        for place in (middle, end):
            self.qtbot.mouseMove(self.area, self.pixel(place))
        self.qtbot.mouseRelease(self.area, LEFT, pos=self.pixel(end))

    def loop(self, places) -> None:
        for place in [*places, places[0]]:
            self.click(*place)


@pytest.fixture
def pen(qtbot, dialog):
    return Pen(qtbot, dialog)


def enter(qtbot, table, row, column, text) -> None:
    """Type into a cell of the table."""
    table.setFocus()
    table.setCurrentCell(row, column)
    qtbot.keyClicks(table.viewport(), text[0])
    editor = QApplication.focusWidget()
    qtbot.keyClicks(editor, text[1:])
    key(qtbot, editor, Qt.Key.Key_Return)
    qtbot.wait(10)


def key(qtbot, widget, key, modifier=Qt.KeyboardModifier.NoModifier) -> None:
    qtbot.keyClick(widget, key, modifier)


# The gallery, and kind, size and quality


def test_gallery_shows_every_shape_and_previews_the_chosen_one(qtbot, dialog):
    pictures = dialog.gallery.shapes
    assert pictures.count() == len(gallery.names())
    assert dialog.options.numbers == {
        "elements": "24", "vertices": "35", "score": "12", "optimum": "4",
    }  # fmt: skip
    place = pictures.visualItemRect(pictures.item(3)).center()
    qtbot.mouseClick(pictures.viewport(), LEFT, pos=place)
    assert dialog.made is None
    assert dialog.options.numbers["elements"] == "\u2026"
    made = wait_for_mesh(qtbot, dialog)
    assert made.name == "l-shape"
    assert dialog.options.numbers["elements"] == str(len(made.elements))


def test_size_kind_and_quality_change_the_mesh(qtbot, dialog):
    options = dialog.options
    coarse = len(wait_for_mesh(qtbot, dialog).elements)
    options.size_of.tick.click()
    options.size_of.field.setValue(0.2)
    fine = wait_for_mesh(qtbot, dialog)
    assert len(fine.elements) > coarse
    ends = fine.points[fine.edges]
    assert np.hypot(*(ends[:, 0] - ends[:, 1])[:, :2].T).max() <= 0.2
    assert options.rule.isVisible()
    options.rule.buttons["pairing"].click()
    paired = wait_for_mesh(qtbot, dialog)
    assert paired.score < fine.score
    options.kind.buttons["tri"].click()
    assert not options.rule.isVisible()
    triangles = wait_for_mesh(qtbot, dialog)
    assert triangles.kind == "tri" and triangles.elements.shape[1] == 3
    options.quality.tick.click()
    options.quality.field.setValue(0.0)
    assert len(wait_for_mesh(qtbot, dialog).elements) != len(triangles.elements)


def test_slider_and_field_are_synchronised(qtbot, dialog):
    size = dialog.options.size_of
    assert size.value is None and not size.slider.isEnabled()
    size.tick.click()
    size.slider.setValue(0)
    coarsest = size.value
    size.slider.setValue(size.slider.maximum())
    assert size.value == pytest.approx(coarsest / 500, rel=0.05)
    size.field.setValue(coarsest)
    assert size.slider.value() == 0


def test_too_many_elements_are_refused_in_one_sentence(qtbot, dialog):
    size = dialog.options.size_of
    size.tick.click()
    wait_for_mesh(qtbot, dialog)
    size.slider.setValue(size.slider.maximum())
    size.field.setDecimals(5)
    size.field.setValue(2e-4)
    wait_for_words(qtbot, dialog, "the limit is 2,000,000")
    assert "This mesh would need about" in dialog.status.text()
    assert not dialog.make.isEnabled() and not dialog.mark.isHidden()


def test_last_request_wins_and_the_dialog_stays_responsive(qtbot, dialog):
    size = dialog.options.size_of
    size.tick.click()
    size.field.setDecimals(5)
    size.field.setValue(2e-3)  # some seconds of work
    qtbot.waitUntil(lambda: dialog.maker._asked is not None, timeout=WAIT)
    size.field.setValue(0.3)
    made = wait_for_mesh(qtbot, dialog)
    assert len(made.elements) < 1000
    qtbot.wait(50)
    assert dialog.made is made


def test_make_waits_for_the_mesh(qtbot, dialog):
    dialog.gallery.choose("gear")
    assert dialog.made is None
    dialog.make.click()
    assert not dialog.make.isEnabled() and dialog.isVisible()
    qtbot.waitUntil(lambda: not dialog.isVisible(), timeout=WAIT)
    assert dialog.made.name == "gear"
    mesh = dialog.made.mesh()
    mesh.validate()
    same = meshing.mesh_domain(gallery.shape("gear"), "quad")
    assert (mesh.points == same.points).all() and (mesh.elements() == same.elements()).all()
    assert (mesh.desired() == same.desired()).all()


def test_return_accepts_on_a_picture_but_not_in_a_field(qtbot, dialog):
    dialog.options.size_of.tick.click()
    dialog.options.size_of.field.setFocus()
    key(qtbot, dialog.options.size_of.field, Qt.Key.Key_Return)
    wait_for_mesh(qtbot, dialog)
    assert dialog.isVisible()
    dialog.gallery.shapes.setFocus()
    key(qtbot, dialog.gallery.shapes, Qt.Key.Key_Down)
    key(qtbot, dialog.gallery.shapes, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: not dialog.isVisible(), timeout=WAIT)
    assert dialog.made.name == "u-shape"


# Random shapes


def test_random_polygons_by_seed(qtbot, dialog):
    dialog.tabs.buttons["random"].click()
    page = dialog.random
    made = wait_for_mesh(qtbot, dialog)
    assert made.name == "polygon-10"
    page.seed.setValue(7)
    again = wait_for_mesh(qtbot, dialog)
    corners = gallery.random_corners(10, np.random.default_rng(7))
    assert (again.points[:10, :2] == corners).all()
    assert page.pictures.key == 7
    page.sides.setValue(15)
    made = wait_for_mesh(qtbot, dialog)
    assert len(made.corners) + len(made.anchors) == 15
    page.dice.click()
    assert page.seed.value() == page.pictures.key == 20
    page.seed.setValue(123)
    qtbot.waitUntil(lambda: page.pictures.key == 123, timeout=WAIT)
    page.kind.buttons["part"].click()
    part = wait_for_mesh(qtbot, dialog)
    assert part.name == "part-15"
    page.pictures.setCurrentRow(3)
    assert page.seed.value() == page.pictures.key


# Drawing


def test_a_square_with_a_hole_is_drawn_with_the_mouse(qtbot, dialog, pen):
    assert dialog.status.text() == "Click to place the first corner of the outline."
    assert not dialog.make.isEnabled()
    pen.loop(SQUARE)
    assert not dialog.draw.sketch.open
    pen.click(0, 0)
    assert "press Add hole" in dialog.status.text()
    pen.qtbot.mouseClick(dialog.draw.hole, LEFT)
    assert "Click inside the outline" in dialog.status.text()
    pen.loop([(-0.2, -0.2), (0.2, -0.2), (0, 0.2)])
    assert dialog.draw.sketch.complete
    made = wait_for_mesh(qtbot, dialog)
    assert len(made.sizes) == 2
    places = {tuple(p) for p in made.points[made.corners][:, :2].round(9).tolist()}
    assert places == {*SQUARE, (-0.2, -0.2), (0.2, -0.2), (0.0, 0.2)}


def test_right_click_and_backspace_undo(qtbot, dialog, pen):
    for place in SQUARE:
        pen.click(*place)
    pen.click(0.9, 0.9, button=RIGHT)
    key(qtbot, dialog.draw.area, Qt.Key.Key_Backspace)
    assert dialog.draw.sketch.loops[0].corners == tuple(SQUARE[:2])
    key(qtbot, dialog.draw.area, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert len(dialog.draw.sketch.loops[0].corners) == 3
    key(qtbot, dialog.draw.area, Qt.Key.Key_Return)
    assert not dialog.draw.sketch.open and dialog.isVisible()


def test_escape_does_not_discard_a_drawing(qtbot, dialog, pen):
    pen.click(0, 0)
    key(qtbot, dialog.draw.area, Qt.Key.Key_Escape)
    assert dialog.isVisible() and "press Cancel" in dialog.status.text()
    dialog.draw.clear.click()
    key(qtbot, dialog.draw.area, Qt.Key.Key_Escape)
    assert not dialog.isVisible()


def test_corner_drag_is_one_edit_and_click_on_edge_inserts_a_corner(qtbot, dialog, pen):
    pen.loop(SQUARE)
    pen.drag((0.5, 0.5), (0.8, 0.7))
    assert dialog.draw.sketch.loops[0].corners[2] == (0.8, 0.7)
    dialog.draw.undo.click()
    assert dialog.draw.sketch.loops[0].corners[2] == (0.5, 0.5)
    pen.drag((0.0, 0.5), (0.0, 0.9))
    corners = dialog.draw.sketch.loops[0].corners
    assert len(corners) == 5 and corners[3] == (0.0, 0.9)
    key(qtbot, dialog.draw.area, Qt.Key.Key_Delete)
    assert dialog.draw.sketch.loops[0].corners == tuple(SQUARE)


def test_crossing_edges_are_reported_before_and_after_the_click(qtbot, dialog, pen):
    for place in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5)]:
        pen.click(*place)
    pen.point(0.1, -0.9)
    assert "crosses or touches itself" in dialog.status.text()
    assert not dialog.mark.isHidden()
    pen.click(0.1, -0.9)
    assert "crosses or touches itself near" in dialog.status.text()
    assert not dialog.make.isEnabled()
    pen.click(0.1, -0.9, button=RIGHT)
    pen.point(-0.5, 0.5)
    assert "close the outline" in dialog.status.text()


def test_snapping_to_right_angles_shows_guides_and_can_be_switched_off(qtbot, dialog, pen):
    draw = dialog.draw
    draw.to_grid.click()
    pen.click(-0.53, -0.41)
    first = draw.sketch.loops[0].corners[0]
    pen.point(0.4, -0.4)
    assert draw.area._snap.guides
    pen.click(0.4, -0.4)
    assert draw.sketch.loops[0].corners[1][1] == first[1]
    draw.to_angles.click()
    pen.click(0.42, 0.33)
    assert draw.sketch.loops[0].corners[2][0] != draw.sketch.loops[0].corners[1][0]


def test_snapping_to_middles_of_edges_and_arcs(qtbot, dialog, pen):
    draw = dialog.draw
    draw.to_grid.click()
    draw.to_angles.click()
    pen.loop([(-0.5, -0.5), (0.63, -0.5), (0.63, 0.71), (-0.5, 0.71)])
    corners = draw.sketch.loops[0].corners
    halfway = tuple(np.mean(corners[1:3], axis=0).tolist())
    # an edge is grabbed in its middle, a few pixels beside it
    pen.drag((halfway[0] + 0.01, halfway[1] + 0.02), (0.9, 0.1))
    draw.undo.click()
    pen.click(halfway[0] + 0.01, halfway[1] + 0.02)
    assert draw.sketch.loops[0].corners[2] == halfway
    draw.undo.click()
    # a hole begins there, and the picture shows a triangle
    draw.hole.click()
    pen.point(halfway[0] - 0.02, halfway[1] + 0.01)
    assert draw.area._snap.met == "middle" and draw.area._snap.place == halfway
    draw.area.grab()
    # a corner goes first, and the tick switches it off
    pen.point(corners[2][0] + 0.01, corners[2][1])
    assert draw.area._snap.met == "point"
    draw.to_middles.click()
    pen.point(halfway[0] - 0.02, halfway[1] + 0.01)
    assert draw.area._snap.met == ""


def test_a_corner_is_dragged_to_the_middle_of_an_edge(qtbot, dialog, pen):
    draw = dialog.draw
    draw.to_grid.click()
    pen.loop(SQUARE)
    draw.hole.click()
    pen.loop([(-0.2, -0.2), (0.13, -0.2), (0.13, 0.17)])
    bottom = tuple(np.mean(draw.sketch.loops[0].corners[:2], axis=0).tolist())
    pen.drag(draw.sketch.loops[1].corners[0], (bottom[0] + 0.02, bottom[1] + 0.01))
    assert draw.sketch.loops[1].corners[0] == bottom


def test_coordinates_are_typed_in_the_table(qtbot, dialog, pen):
    table, sketch = dialog.draw.table, dialog.draw.sketch

    for row, (x, y) in enumerate([("0", "0"), ("1,5", "0"), ("1.5", "2")]):
        enter(qtbot, table, row, 1, x)
        enter(qtbot, table, row, 2, y)
    assert sketch.loops[0].corners == ((0, 0), (1.5, 0), (1.5, 2))
    assert dialog.isVisible()
    enter(qtbot, table, 2, 2, "-1")
    assert sketch.loops[0].corners[2] == (1.5, -1)
    assert table.item(2, 2).text() == "\u22121"
    enter(qtbot, table, 0, 1, "two")
    assert "'two' is not a number" in dialog.status.text()
    assert sketch.loops[0].corners[0] == (0, 0)
    pen.click(*sketch.loops[0].corners[1])
    assert table.currentRow() == 1


def test_a_plate_with_three_holes_is_drawn_by_tools_and_numbers(qtbot, dialog, pen):
    draw = dialog.draw
    key(qtbot, draw.area, Qt.Key.Key_R)
    assert draw.tools.key == "rectangle" and "width height" in draw.hint.text()
    assert "Click to place" not in dialog.status.text()
    pen.click(-0.8, -0.4)
    pen.point(0.1, 0.1)
    qtbot.keyClicks(draw.area, "1.65 0.8")
    assert draw.area.typed == "1.65 0.8"
    draw.area.grab()  # paints it
    key(qtbot, draw.area, Qt.Key.Key_Backspace)
    qtbot.keyClicks(draw.area, "75")
    key(qtbot, draw.area, Qt.Key.Key_Return)
    assert draw.sketch.loops[0].corners == ((-0.8, -0.4), (0.85, -0.4), (0.85, 0.35), (-0.8, 0.35))
    qtbot.mouseClick(draw.tools.buttons["circle"], LEFT)
    assert draw.area.hasFocus()
    for x in (-0.5, 0.0, 0.5):
        pen.click(x, 0.0)
        qtbot.keyClicks(draw.area, "0,125")
        key(qtbot, draw.area, Qt.Key.Key_Return)
    pen.click(0.7, -0.3)
    key(qtbot, draw.area, Qt.Key.Key_Escape)  # forgets the centre, and nothing else
    assert dialog.isVisible() and not draw.area.pencil.begun
    made = wait_for_mesh(qtbot, dialog)
    assert len(made.sizes) == 4 and len(made.corners) == 4
    mesh = made.mesh()
    mesh.validate()
    assert mesh.off_curve().max() < 1e-12
    key(qtbot, draw.area, Qt.Key.Key_L)
    pen.drag((0.625, 0.0), (0.6, 0.0))  # a corner of the last circle
    assert draw.sketch.loops[3].corners[1] == (0.6, 0.0)
    draw.undo.click()
    table = draw.table
    rows = [table.item(row, 0).text() for row in range(table.rowCount())]
    row = rows.index("Hole 1.1")
    assert [table.item(row, c).text() for c in (1, 2, 3)] == ["\u22120.625", "0", "0.125"]
    enter(qtbot, table, row, 3, "0.1")
    assert np.allclose(draw.sketch.loops[1].corners, [(-0.6, 0.0), (-0.4, 0.0)])
    enter(qtbot, table, 0, 3, "1")
    assert "only arcs have a radius" in dialog.status.text().lower()


def test_the_drawing_area_stays_where_it_is_while_a_circle_is_drawn(qtbot, dialog, pen):
    draw = dialog.draw
    before = draw.area.geometry()
    for tool in draw.tools.buttons.values():
        tool.click()
        QApplication.processEvents()
        assert draw.area.geometry() == before
    draw.tools.buttons["circle"].click()
    pen.click(0.0, 0.0)
    qtbot.keyClicks(draw.area, "0.5")
    assert draw.area.geometry() == before
    key(qtbot, draw.area, Qt.Key.Key_Return)
    wait_for_mesh(qtbot, dialog)
    assert draw.area.geometry() == before


def test_the_dialog_fits_a_screen_of_900_by_600(qtbot, dialog):
    for page in dialog.tabs.buttons:
        dialog.show_page(page)
        QApplication.processEvents()
        assert dialog.minimumSizeHint().width() <= 900 - GRID
        assert dialog.minimumSizeHint().height() <= 600 - dialog_module.FRAME


def test_an_arc_is_drawn_and_measured(qtbot, dialog, pen):
    draw = dialog.draw
    pen.click(-0.5, 0.0)
    key(qtbot, draw.area, Qt.Key.Key_A)
    pen.click(0.5, 0.0)
    pen.click(0.0, -0.5)
    assert draw.sketch.loops[0].bulges == (pytest.approx(1.0),)
    pen.click(-0.5, 0.0)
    pen.click(0.0, 0.5)
    assert not draw.sketch.open
    key(qtbot, draw.area, Qt.Key.Key_M)
    pen.click(-0.5, 0.0)
    pen.click(0.5, 0.0)
    assert draw.area.pencil.draft((0, 0)).text.startswith("1 < 0\u00b0")
    draw.area.grab()
    key(qtbot, draw.area, Qt.Key.Key_L)
    pen.click(0.0, 0.5)  # inserts a corner on the arc
    assert len(draw.sketch.loops[0].corners) == 3
    key(qtbot, draw.area, Qt.Key.Key_Delete)
    assert draw.sketch.loops[0].bulges == pytest.approx((1.0, 1.0))


def test_typed_dimensions_that_mean_nothing_are_told(qtbot, dialog, pen):
    area = dialog.draw.area
    qtbot.keyClicks(area, "3")
    assert "x y" in dialog.draw.hint.text() and dialog.mark.isHidden()
    key(qtbot, area, Qt.Key.Key_Return)
    assert "is no point" in dialog.status.text() and dialog.isVisible()
    key(qtbot, area, Qt.Key.Key_Escape)
    assert area.typed == "" and dialog.isVisible()


def test_the_dialog_begins_where_it_ended(qtbot, open_window, tmp_path):
    window = open_window()
    seen = []

    def first():
        dialog = QApplication.activeModalWidget()
        pen = Pen(qtbot, dialog)
        key(qtbot, dialog.draw.area, Qt.Key.Key_C)
        pen.click(0, 0)
        pen.click(0.5, 0)
        dialog.options.size_of.tick.click()
        dialog.options.size_of.field.setValue(0.125)
        dialog.options.rule.buttons["pairing"].click()
        seen.append(dialog.state)
        dialog.reject()

    def second():
        dialog = QApplication.activeModalWidget()
        seen.append(dialog.state)
        wait_for_mesh(qtbot, dialog)
        dialog.make.click()

    for act in (first, second):
        QTimer.singleShot(200, act)
        window.actions_by_id["new"].trigger()
    assert seen[0] == seen[1]
    assert seen[1]["page"] == "draw" and seen[1]["options"]["max_edge"] == 0.125
    assert window.document.name == "drawing"


def test_a_damaged_state_is_left_out(qtbot):
    state = {
        "page": "nowhere",
        "options": {"quads": 3},
        "pages": {"draw": {"loops": [3]}, "gallery": {"shape": "gear"}, "file": {"path": "x"}},
    }
    made = NewMeshDialog("quad", theme("light"), state=state)
    qtbot.addWidget(made)
    assert made.tabs.key == "gallery" and made.gallery.source == {"shape": "gear"}
    assert made.draw.sketch.empty
    made.reject()


# Files


def test_a_drawing_is_chosen_and_meshed(qtbot, dialog, tmp_path):
    path = tmp_path / "plate.svg"
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg"><rect width="40" height="20"/></svg>')
    dialog.tabs.buttons["file"].click()
    assert dialog.status.text() == "Choose a file, or drop one here."
    qtbot.keyClicks(dialog.file.path, str(path))
    key(qtbot, dialog.file.path, Qt.Key.Key_Return)
    made = wait_for_mesh(qtbot, dialog)
    assert dialog.isVisible()
    assert (made.name, made.path, made.kind) == ("plate", "", "quad")
    dialog.options.size_of.tick.click()
    assert dialog.options.size_of.value > 1
    dialog.file.take(str(tmp_path / "missing.svg"))
    wait_for_words(qtbot, dialog, "there is no such file")
    dialog.file.take(str(tmp_path / "work.meshwright"))
    wait_for_words(qtbot, dialog, "a project is opened by Open")
    assert not dialog.make.isEnabled()


TWO_SHAPES = """<svg xmlns="http://www.w3.org/2000/svg">
<rect width="40" height="20"/><circle cx="20" cy="10" r="5" fill="none" stroke="black"/>
<circle cx="70" cy="10" r="10"/><text x="3" y="40">plate</text></svg>"""


def test_regions_of_a_drawing_are_listed_and_chosen(qtbot, dialog, tmp_path):
    path = tmp_path / "parts.svg"
    path.write_text(TWO_SHAPES)
    dialog.show_page("file")
    assert not dialog.file.found.isVisible()
    dialog.file.take(str(path))
    made = wait_for_mesh(qtbot, dialog)
    found = dialog.file.found
    rows = found.table.rowCount()
    assert found.isVisible() and rows > 1
    assert f"{rows} regions in the drawing" in found.title.text()
    qtbot.wait(300)
    assert dialog.made is made  # showing them asks for no other mesh
    areas = [float(found.table.item(row, 1).text().replace(",", "")) for row in range(rows)]
    assert areas == sorted(areas, reverse=True)
    first = found.choice

    def middle() -> QPoint:
        return found.table.visualItemRect(found.table.item(rows - 1, 0)).center()

    qtbot.mouseClick(found.table.viewport(), LEFT, pos=middle())
    key(qtbot, found.table, Qt.Key.Key_Space)
    assert found.choice == f"{first},{rows}"
    assert dialog.made is None
    both = wait_for_mesh(qtbot, dialog)
    assert len(both.elements) > len(made.elements)
    qtbot.mouseDClick(found.table.viewport(), LEFT, pos=middle())
    assert found.choice == str(rows)
    alone = wait_for_mesh(qtbot, dialog)
    assert len(alone.elements) < len(both.elements)
    mesh = alone.mesh()
    mesh.validate()
    assert mesh.off_curve().max() < 1e-12
    key(qtbot, found.table, Qt.Key.Key_Space)
    assert found.choice == ""
    assert dialog.status.text() == NONE_CHOSEN
    assert not dialog.make.isEnabled()
    found.all.click()
    wait_for_mesh(qtbot, dialog)
    assert found.choice == ",".join(str(row + 1) for row in range(rows))


def test_repairs_and_what_is_left_out_are_told_in_sentences(qtbot, dialog, tmp_path):
    path = tmp_path / "gap.dxf"
    path.write_text(gap_dxf())
    dialog.show_page("file")
    dialog.file.take(str(path))
    wait_for_mesh(qtbot, dialog)
    words = " ".join(dialog.file.found.sentences)
    assert "gap" in words and "encloses nothing" in words
    assert all(words.endswith(".") for words in dialog.file.found.sentences)


def gap_dxf() -> str:
    """A square with one small gap, and a stray line."""
    ends = [(0, 0, 10, 0), (10, 0, 10, 10), (10, 10, 0, 10), (0, 10, 0, 0.005), (20, 0, 30, 0)]
    lines = [f"0\nLINE\n8\n0\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n" for a, b, c, d in ends]
    return "0\nSECTION\n2\nENTITIES\n" + "".join(lines) + "0\nENDSEC\n0\nEOF\n"


def test_interfaces_stay_in_the_mesh_of_a_drawing(qtbot, dialog, tmp_path):
    path = tmp_path / "two.wkt"
    path.write_text(
        "GEOMETRYCOLLECTION(POLYGON((0 0,1 0,1 1,0 1,0 0)),POLYGON((1 0,2 0,2 1,1 1,1 0)))"
    )
    dialog.show_page("file")
    dialog.file.take(str(path))
    made = wait_for_mesh(qtbot, dialog)
    assert dialog.file.found.choice == "1,2"
    assert sorted(made.owners.tolist()) == [0, 1]
    mesh = made.mesh()
    mesh.validate()
    assert len(mesh.interfaces) == 1 and set(mesh.regions().tolist()) == {0, 1}
    dialog.grab()  # paints the preview


def test_mesh_file_is_opened_unchanged(qtbot, dialog, tmp_path, star):
    write(tmp_path / "star.vtk", star)
    dialog.show_page("file")
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(tmp_path / "star.vtk"))])
    event = QDropEvent(
        QPointF(9, 9), Qt.DropAction.CopyAction, data, LEFT, Qt.KeyboardModifier.NoModifier
    )
    dialog.file.dropEvent(event)
    made = wait_for_mesh(qtbot, dialog)
    assert not dialog.options.settings.isEnabled()
    assert dialog.make.text() == "Open mesh"
    assert Path(made.path) == tmp_path / "star.vtk"
    assert (made.mesh().elements() == read(tmp_path / "star.vtk").elements()).all()


# The window, the process


def test_accepted_dialog_replaces_the_mesh_of_the_window(qtbot, open_window):
    window = open_window()

    def draw():
        dialog = QApplication.activeModalWidget()
        Pen(qtbot, dialog).loop(SQUARE)
        dialog.make.click()

    QTimer.singleShot(200, draw)
    window.actions_by_id["new"].trigger()
    assert window.document.name == "drawing"
    assert window.document.mesh.geometric().sum() == 4
    assert window.pages.currentWidget() is window.canvas


def test_dead_process_is_reported_and_replaced(qtbot):
    maker = MeshProcess()
    maker.start()
    maker.ask({**REQUEST, "max_edge": 1.5e-3}, at_once=True)
    qtbot.waitUntil(lambda: maker._asked is not None, timeout=WAIT)
    with qtbot.waitSignal(maker.failed, timeout=WAIT) as received:
        maker._process.kill()
    assert "process ended unexpectedly" in received.args[0]
    with qtbot.waitSignal(maker.made, timeout=WAIT) as made:
        maker.ask(REQUEST, at_once=True)
    assert made.args[0].score == 12
    process = maker._process
    maker.close()
    assert process.state() == QProcess.ProcessState.NotRunning


def test_message_frames_round_trip():
    made = mesh_worker.make(REQUEST).mesh
    content = new_mesh.frame(Answer(made))
    assert new_mesh.length(content[:8]) == len(content)
    again = new_mesh.unframed(content).mesh
    assert json.dumps([again.name, again.kind, again.score]) == '["star", "quad", 12]'
    same = ("points", "elements", "delta", "edges", "rim_ends", "corners")
    assert all((getattr(again, f) == getattr(made, f)).all() for f in same)
    mesh = again.mesh()
    mesh.validate()
    assert mesh.score == 12
    refused = new_mesh.unframed(new_mesh.frame(Answer(None, "No.")))
    assert refused == Answer(None, "No.")


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"source": {"shape": "sta"}}, "did you mean"),
        ({"source": {"domain": {"outline": [[0, 0], [1, 1]]}}}, "at least 3"),
        ({"max_edge": 1e-4}, "the limit is 2,000,000"),
        ({"min_angle": 60}, "34"),
    ],
)
def test_invalid_requests_are_reported_in_one_sentence(change, expected):
    answer = mesh_worker.make({**REQUEST, **change})
    assert answer.mesh is None
    assert expected in answer.refusal
