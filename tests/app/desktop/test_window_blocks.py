"""The Blocks view by real events: chords, numbers of cells, tools, contradictions, the export."""

import numpy as np
import pytest
from block_meshes import annulus, corner_blocks, quarter_ring
from driving import WAIT, pixel, press
from qtpy.QtCore import QPoint, Qt, QTimer
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication

from meshwright.desktop.blocks.export_blocks_dialog import DIVIDE, BlockExport, ExportBlocksDialog
from meshwright.graphics.theme import GRID
from meshwright_core import HalfEdgeMesh
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.core.grid_plan import GridPlan, Wall

CONTROL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


def rows_of_blocks() -> HalfEdgeMesh:
    """Three by two unit squares; vertex i + 4 j at (i, j)."""
    points = np.array([(i, j) for j in range(3) for i in range(4)], float)
    corners = [i + 4 * j for j in range(2) for i in range(3)]
    return HalfEdgeMesh.from_elements(points, [(c, c + 1, c + 5, c + 4) for c in corners])


def five_around_a_vertex() -> HalfEdgeMesh:
    """A pentagon of five blocks around vertex 0, which is not in its middle."""
    turn = np.arange(10) * np.pi / 5
    reach = np.where(np.arange(10) % 2, 1.0, np.cos(np.pi / 5))  # middles of sides, and corners
    ring = reach[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    quads = [(0, 1 + 2 * i, 2 + 2 * i, 1 + (2 * i + 2) % 10) for i in range(5)]
    return HalfEdgeMesh.from_elements(np.vstack([[(0.25, 0.1)], ring]), quads)


@pytest.fixture
def shown(qtbot, open_window):
    """Open a window with the blocks of a mesh shown by the toolbar's button."""

    def show(mesh):
        window = open_window(mesh)
        button = window.toolbar.widgetForAction(window.actions_by_id["blocks.view"])
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
        assert window.blocks.shown
        return window

    return show


def click(qtbot, window, plane) -> None:
    where = pixel(window, plane)
    QTest.mouseMove(window.canvas.plotter, where + QPoint(2, 0))
    QTest.mouseMove(window.canvas.plotter, where)
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.LeftButton, pos=where)


def counts(window) -> dict[tuple[int, int], int]:
    """The number of cells on each block edge, by its ends."""
    planned = window.blocks.planned
    structure = planned.structure
    ends = np.sort(structure.vertices[structure.edges], axis=1)
    return {
        (a, b): int(planned.division.counts[chord])
        for (a, b), chord in zip(ends.tolist(), structure.chord.tolist(), strict=True)
    }


def drawn(window) -> dict[tuple[int, int], int]:
    """The numbers that the canvas shows, by the ends of their edges."""
    layer, structure = window.blocks.layer, window.blocks.planned.structure
    ends = np.sort(structure.vertices[structure.edges], axis=1)
    return {
        tuple(ends[edge].tolist()): int(layer.shown.counts[structure.chord[edge]])
        for edge, _ in layer.cards
    }


def test_a_count_typed_for_a_clicked_chord_holds_on_all_its_edges_in_one_step(qtbot, shown):
    window = shown(rows_of_blocks())
    click(qtbot, window, (0.5, 0.0))
    panel, document = window.blocks.panel, window.document
    assert (
        window.blocks.chord
        == window.blocks.planned.structure.chord[window.blocks.planned.structure.edge_between(0, 1)]
    )
    field = panel.count.lineEdit()
    qtbot.mouseDClick(field, Qt.MouseButton.LeftButton)
    field.selectAll()
    qtbot.keyClicks(field, "17")
    qtbot.keyClick(field, Qt.Key.Key_Return)
    assert len(document.history) == 1
    edges = [(0, 1), (4, 5), (8, 9)]
    assert [counts(window)[edge] for edge in edges] == [17, 17, 17]
    assert [drawn(window)[edge] for edge in edges] == [17, 17, 17]
    assert counts(window)[1, 2] != 17
    assert document.history.last.title.endswith(": 17 cells")
    window.actions_by_id["undo"].trigger()
    assert counts(window)[0, 1] != 17
    window.actions_by_id["redo"].trigger()
    assert counts(window)[8, 9] == 17
    press(qtbot, window, Qt.Key.Key_Up, CONTROL)
    assert counts(window)[4, 5] == 18
    qtbot.mouseClick(panel.free, Qt.MouseButton.LeftButton)
    assert counts(window)[0, 1] == counts(window)[1, 2]
    qtbot.waitUntil(lambda: panel.values["worst"].text == "1.00", timeout=3 * WAIT)
    assert window.blocks.grid.count > 0


def test_a_grading_makes_the_first_cells_thin_and_even_cells_return(qtbot, shown):
    window = shown(rows_of_blocks())
    click(qtbot, window, (0.0, 0.5))
    blocks = window.blocks
    qtbot.waitUntil(lambda: blocks.panel.values["worst"].text == "1.00", timeout=3 * WAIT)
    before = counts(window)[0, 4]
    blocks.panel.first.setValue(0.01)
    assert blocks.planned.division.first[blocks.chord] == 0.01
    assert counts(window)[0, 4] > before
    assert blocks.panel.first.value() == pytest.approx(0.01)
    assert len(window.document.history) == 1
    qtbot.mouseClick(blocks.panel.tools["blocks.even"], Qt.MouseButton.LeftButton)
    assert not blocks.planned.division.first.any()
    assert window.document.mesh.grid_plan.empty


def test_panels_agree_on_the_numbers_of_quads_and_blocks(qtbot, shown):
    window = shown(rows_of_blocks())
    elements, values = window.quality.score.elements, window.blocks.panel.values
    quads = window.document.mesh.n_elements
    qtbot.waitUntil(lambda: elements.text == f"{quads} quads in 1 block", timeout=WAIT)
    assert values["quads"].text.startswith(f"{quads}, 1, ")


def test_blocks_are_selected_and_lead_to_their_chords(qtbot, shown):
    window = shown(rows_of_blocks())
    click(qtbot, window, (1.5, 1.5))
    blocks = window.blocks
    assert blocks.block == 4
    assert blocks.chord == -1
    assert not window.actions_by_id["blocks.collapse"].isEnabled()
    qtbot.mouseClick(blocks.panel.crossing[0], Qt.MouseButton.LeftButton)
    assert blocks.chord == blocks.planned.structure.crossing[4, 0]
    press(qtbot, window, Qt.Key.Key_Escape)
    assert blocks.chord == blocks.block == -1
    press(qtbot, window, Qt.Key.Key_BracketRight, CONTROL)
    assert blocks.chord == 0


def test_tools_insert_collapse_slide_and_straighten(qtbot, shown):
    window = shown(rows_of_blocks())
    document, blocks = window.document, window.blocks
    click(qtbot, window, (0.5, 0.0))
    qtbot.mouseClick(blocks.panel.tools["blocks.collapse"], Qt.MouseButton.LeftButton)
    assert document.mesh.n_elements == 4
    window.actions_by_id["undo"].trigger()
    click(qtbot, window, (1.5, 1.0))
    qtbot.mouseClick(blocks.panel.tools["blocks.insert"], Qt.MouseButton.LeftButton)
    assert document.mesh.n_elements > 6
    assert document.history.last.action == "global_split"
    window.actions_by_id["undo"].trigger()
    click(qtbot, window, (1.5, 1.0))
    qtbot.mouseClick(blocks.panel.tools["blocks.slide_left"], Qt.MouseButton.LeftButton)
    heights = document.mesh.points[4:8, 1]
    assert np.allclose(abs(heights - 1.0), 0.1)
    window.actions_by_id["undo"].trigger()
    assert (document.mesh.points[4:8, 1] == 1.0).all()
    document.move(np.array([5]), np.array([[1.0, 1.3, 0.0]]))
    click(qtbot, window, (1.6, 1.12))
    qtbot.mouseClick(blocks.panel.tools["blocks.straighten"], Qt.MouseButton.LeftButton)
    assert document.mesh.points[5, 1] == pytest.approx(1.0)
    document.mesh.validate()


def test_an_edge_that_is_dragged_slides_its_line(qtbot, shown):
    window = shown(rows_of_blocks())
    plotter, mesh = window.canvas.plotter, window.document.mesh
    QTest.mouseMove(plotter, pixel(window, (1.3, 1.0)))
    qtbot.mousePress(plotter, Qt.MouseButton.LeftButton, pos=pixel(window, (1.3, 1.0)))
    for y in (1.1, 1.25, 1.4):
        QTest.mouseMove(plotter, pixel(window, (1.3, y)))
    qtbot.mouseRelease(plotter, Qt.MouseButton.LeftButton, pos=pixel(window, (1.3, 1.4)))
    assert np.allclose(mesh.points[4:8, 1], 1.4, atol=0.02)
    assert len(window.document.history) == 1
    assert window.document.history.last.title == "Slide line"


def test_contradictions_are_said_with_their_chord_and_change_nothing(qtbot, shown):
    window = shown(corner_blocks())
    document, blocks = window.document, window.blocks
    click(qtbot, window, (0.5, 0.0))
    press(qtbot, window, Qt.Key.Key_T, CONTROL | SHIFT)
    assert window.notice.text == "This line is the boundary, and keeps its shape."
    assert blocks.layer.shown.wrong == {blocks.chord}
    met = []

    def look() -> None:
        dialog = QApplication.activeModalWidget()
        if isinstance(dialog, ExportBlocksDialog):
            timer.stop()
            dialog.sides["outline"].count.setValue(31)
            met.extend((dialog.note.text(), dialog.export.isEnabled()))
            qtbot.mouseClick(dialog.cancel, Qt.MouseButton.LeftButton)

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(20)
    press(qtbot, window, Qt.Key.Key_E, CONTROL | SHIFT)
    timer.stop()
    assert met == [
        "31 cells on outline cannot be: each chord that ends there does so 2 times, so it must be "
        "an even number.",
        False,
    ]
    assert len(document.history) == 0


def test_chords_that_an_edit_joins_with_two_numbers_are_shown(qtbot, shown):
    window = shown(rows_of_blocks())
    document, blocks = window.document, window.blocks
    structure = blocks.planned.structure
    mesh = document.mesh
    for edge, count in (((0, 4), 5), ((4, 8), 9)):
        blocks.select_edge(structure.edge_between(*edge))
        blocks.tools.set_count(count)
    for h in [h for e in mesh.element_ids().tolist() for h in range(4 * e, 4 * e + 4)]:
        if mesh.check("flip_left", h):
            document.submit("flip_left", h)
            if "set its number of cells again" in window.notice.text:
                break
            document.undo()
    assert "has both" in window.notice.text
    assert len(blocks.layer.shown.wrong) == 1
    document.undo()
    assert window.notice.text == ""
    assert counts(window)[0, 4] == 5


def test_the_dialog_exports_in_the_background_and_says_the_result(
    qtbot, shown, tmp_path, monkeypatch
):
    window = shown(annulus())
    path = tmp_path / "ring.geo"
    monkeypatch.setattr(
        "meshwright.desktop.exporting.export_task.QFileDialog.getSaveFileName",
        lambda *words: (str(path), ""),
    )

    def fill() -> None:
        dialog = QApplication.activeModalWidget()
        if isinstance(dialog, ExportBlocksDialog):
            timer.stop()
            dialog.format_box.setCurrentIndex(dialog.format_box.findData(".geo"))
            qtbot.mouseClick(dialog.modes[DIVIDE], Qt.MouseButton.LeftButton)
            dialog.divide.setValue(6)
            dialog.sides["wall"].height.setValue(0.02)
            qtbot.mouseClick(dialog.export, Qt.MouseButton.LeftButton)

    timer = QTimer()
    timer.timeout.connect(fill)
    timer.start(20)
    qtbot.mouseClick(window.blocks.panel.export, Qt.MouseButton.LeftButton)
    timer.stop()
    assert window.block_export.running
    assert window.block_export.bar.isVisible()
    qtbot.waitUntil(lambda: not window.block_export.running, timeout=6 * WAIT)
    assert path.exists()
    assert "Transfinite Curve" in path.read_text()
    assert "Written: ring.geo (4 blocks," in window.status.message
    assert not window.block_export.bar.isVisible()
    plan = window.document.mesh.grid_plan
    assert plan.divide == 6
    assert plan.walls == (("wall", 0.02, 1.2),)
    window.document.undo()
    assert window.document.mesh.grid_plan.empty


def test_the_dialog_lists_sides_by_their_drawn_names_and_finds_what_was_kept_by_plain_ones(qtbot):
    structure = BlockStructure.of(quarter_ring(names=("a", "b", "c", "bolt hole")))
    plan = GridPlan(walls=(Wall("bolt_hole", 0.02, 1.3),), side_counts={"bolt_hole": 9})
    dialog = ExportBlocksDialog(structure, plan, BlockExport(".geo"))
    qtbot.addWidget(dialog)
    assert list(dialog.sides) == [patch.title for patch in structure.patches]
    assert dialog.sides["bolt hole"].height.value() == pytest.approx(0.02)
    dialog.sides["a"].count.setValue(4)
    assert dialog.plan.walls == (("bolt hole", 0.02, 1.3),)
    assert dialog.plan.side_counts == {"bolt hole": 9, "a": 4}
    dialog.show()
    gap = dialog.order_box.x() - dialog.format_box.geometry().right()
    assert gap >= GRID  # they do not touch


def test_a_cancelled_export_writes_nothing(qtbot, shown, tmp_path):
    window = shown(annulus())
    path = tmp_path / "ring.msh"
    window.block_export.start(BlockExport(".msh"), str(path))
    qtbot.mouseClick(window.block_export.bar.cancel, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not window.block_export.running, timeout=6 * WAIT)
    words = window.status.message
    assert words in ("Cancelled: ring.msh was not written.",) or path.exists()
    assert path.exists() == words.startswith("Written")


def test_numbers_and_gradings_are_saved_in_projects(qtbot, shown, tmp_path):
    window = shown(rows_of_blocks())
    click(qtbot, window, (0.5, 0.0))
    window.blocks.tools.set_count(13)
    window.blocks.panel.last.setValue(0.05)
    path = tmp_path / "grid.meshwright"
    window.document.save(path)
    plan = window.document.mesh.grid_plan
    window.document.replace(None)
    assert not window.blocks.shown
    window.document.open(path)
    assert window.document.mesh.grid_plan == plan
    window.actions_by_id["blocks.view"].trigger()
    assert counts(window)[0, 1] == 13
    window.document.undo()
    window.document.undo()
    assert window.document.mesh.grid_plan.empty


def test_meshes_without_blocks_are_refused_in_words(qtbot, open_window):
    points = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    window = open_window(HalfEdgeMesh.from_elements(points, [[0, 1, 2], [0, 2, 3]]))
    assert not window.actions_by_id["blocks.view"].isEnabled()
    assert not window.actions_by_id["blocks.export"].isEnabled()


def test_irregular_vertices_are_marked_where_the_blocks_meet(qtbot, shown):
    """Smoothing moves the corners of blocks inside; their marks move along, and back."""
    window = shown(five_around_a_vertex())
    marks, blocks = window.canvas.overlay.markers, window.blocks
    qtbot.waitUntil(lambda: blocks.layer.shown.bent is not None, timeout=3 * WAIT)
    structure = blocks.planned.structure
    edge = structure.edge_between(0, 1)
    line = blocks.layer.shown.bent[edge]
    corner = line[0] if structure.vertices[structure.edges[edge, 0]] == 0 else line[-1]
    assert np.linalg.norm(corner - window.document.mesh.points[0, :2]) > 0.05
    (disc,) = marks.discs
    assert disc[3] == 1
    # the straight edges of the mesh do not show beside the bent ones
    surface = window.canvas.view._scene._surface.GetProperty()
    assert not surface.GetEdgeVisibility()
    assert disc[:2] == pytest.approx(window.canvas.viewport.to_screen(corner[None])[0], abs=0.1)
    blocks.show(False)
    assert surface.GetEdgeVisibility()
    (disc,) = marks.discs
    place = window.document.mesh.points[:1, :2]
    assert disc[:2] == pytest.approx(window.canvas.viewport.to_screen(place)[0], abs=0.1)


def test_a_layer_without_effect_is_said_while_blocks_are_shown(qtbot, shown):
    window = shown(rows_of_blocks())
    plan = GridPlan(size=0.1, walls=(Wall("outline", 0.5),))
    window.document.plan_grid(plan, "Sizes")
    assert "no effect" in window.notice.text
    window.document.plan_grid(GridPlan(size=0.1), "Sizes")
    assert window.notice.text == ""
