"""The panels of score and quality, and navigation from their numbers."""

import numpy as np
import pytest
from driving import WAIT, find, point_at, press
from qtpy.QtCore import Qt

from meshwright.desktop.quality.irregularity_chart import short
from meshwright.desktop.quality.quality_panel import ANGLE, JACOBIAN
from meshwright_core import HalfEdgeMesh
from meshwright_core.analysis.blocks import block_count
from meshwright_core.geometry import quality


def measured(qtbot, window):
    qtbot.waitUntil(lambda: window.quality.monitor.fresh, timeout=WAIT)
    return window.quality


def fold_one(window) -> None:
    mesh = window.document.mesh
    vertex = np.flatnonzero(~mesh.boundary())[:1]
    window.document.move(vertex, mesh.points[vertex] + (0.4, 0.0, 0.0))


def test_numbers_are_those_of_the_mesh(qtbot, open_window, star):
    window = open_window(star)
    panel = measured(qtbot, window).score
    assert panel.score.text() == "12"
    assert panel.goal.text() == "Optimum 4"
    assert panel.gap.text() == "8 above it"
    assert panel.irregular.text == f"{star.irregular_count} of {star.n_vertices}"
    assert panel.gained.text == "0.00"
    assert panel.elements.text == f"24 quads in {block_count(star)} blocks"
    assert panel.inverted.text == "0"
    deltas = star.irregularity()
    wanted = {int(d): int((deltas == d).sum()) for d in np.unique(deltas) if d}
    assert panel.tally.counts == wanted
    assert panel.tally.columns == [-2, -1, 1, 2]


def test_operation_updates_score_and_quality(qtbot, open_window, star):
    window = open_window(star)
    measured(qtbot, window)
    halfedge = find(star, "flip_left")
    point_at(qtbot, window, halfedge)
    press(qtbot, window, Qt.Key.Key_F)
    panel = window.quality.score
    assert panel.score.text() == f"{star.score}"
    assert panel.way.text == f"12 \u2192 {window.document.best_score}"
    assert not window.quality.monitor.fresh
    measured(qtbot, window)
    assert panel.elements.text == f"24 quads in {block_count(star)} blocks"
    summary = window.quality.monitor.summary
    assert summary.jacobian.worst == pytest.approx(quality.scaled_jacobian(star).min())


def test_triangles_have_no_blocks(qtbot, open_window, triangles):
    window = open_window(triangles)
    measured(qtbot, window)
    assert window.quality.score.elements.text == f"{triangles.n_elements} triangles"
    assert window.quality.monitor.summary.blocks is None


def test_without_a_mesh_there_are_dashes(qtbot, open_window):
    window = open_window()
    panel = window.quality.score
    assert panel.goal.text() == "No mesh"
    assert panel.elements.text == panel.inverted.text == panel.irregular.text == "\u2013"
    assert panel.tally.counts == {}
    assert window.quality.quality.worst.text == "\u2013"


def test_click_on_inverted_count_goes_to_the_element(qtbot, open_window, star):
    window = open_window(star)
    link = measured(qtbot, window).score.inverted
    assert not link.button.isEnabled()
    fold_one(window)
    measured(qtbot, window)
    inverted = quality.inverted(star)
    assert link.text.endswith(f" {len(inverted)}")
    assert link.text.startswith("\u26a0")
    for element in (*inverted, inverted[0]):
        qtbot.mouseClick(link.button, Qt.MouseButton.LeftButton)
        corners = star.points[star.elements()[star.element_ids() == element][0]]
        assert np.allclose(window.quality.highlight.places, corners[:, :2])
        seen = window.canvas.viewport.to_screen(corners)
        assert (seen > 0).all() and (seen < window.canvas.viewport.size).all()
        assert str(element) in window.status.message


def test_click_on_worst_value_goes_to_the_element(qtbot, open_window, star):
    window = open_window(star)
    panel = measured(qtbot, window).quality
    window.sidebar.reveal(panel)
    assert panel.measure == JACOBIAN
    assert panel.worst.text == f"{quality.scaled_jacobian(star).min():.2f}"
    qtbot.mouseClick(panel.switches[ANGLE], Qt.MouseButton.LeftButton)
    worst = quality.min_angle(star).min()
    assert panel.worst.text == f"{worst:.1f}\u00b0"
    assert window.settings.text("quality/measure") == ANGLE
    qtbot.mouseClick(panel.worst.button, Qt.MouseButton.LeftButton)
    element = int(window.status.message.removeprefix("Element ").removesuffix("."))
    assert quality.min_angle(star)[star.element_ids() == element] == pytest.approx(worst)
    assert panel.histogram.words(panel.histogram.width() - 1.0).startswith("85.5\u00b0 to 90\u00b0")


def test_clicks_on_a_column_cycle_through_its_vertices(qtbot, open_window, star):
    window = open_window(star)
    tally = window.quality.score.tally
    vertices = np.flatnonzero(star.irregularity() == -1)
    where = tally.column(-1).center().toPoint()
    for vertex in (*vertices, vertices[0]):
        qtbot.mouseClick(tally, Qt.MouseButton.LeftButton, pos=where)
        assert window.status.message.startswith(f"Vertex {vertex}:")
        middle = np.array(window.canvas.viewport.size) / 2.0
        assert np.allclose(window.canvas.viewport.to_screen(star.points[vertex]), middle, atol=1)
    empty = tally.column(-2).center().toPoint()
    output = window.status.message
    qtbot.mouseClick(tally, Qt.MouseButton.LeftButton, pos=empty)
    assert window.status.message == output


def test_outermost_columns_include_larger_irregularities(qtbot, open_window, star):
    window = open_window(star)
    tally = window.quality.score.tally
    tally.show_deltas(np.array([0, 9, 4, -7, 1, 1]))
    assert tally.columns == [-4, -3, -2, -1, 1, 2, 3, 4]
    assert tally.counts == {-4: 1, 1: 2, 4: 2}
    assert "\u2265+4: 2" in tally.accessibleDescription()


def test_optimum_badge_is_shown_at_the_optimum(qtbot, open_window, strip):
    window = open_window(strip)
    assert strip.score == strip.optimum
    assert window.quality.score.optimal.isVisible()
    assert not window.quality.score.bar.isVisible()


def test_quick_edits_are_measured_once_and_the_thread_ends_with_the_window(qtbot, open_window):
    x, y = np.meshgrid(np.arange(151.0), np.arange(151.0))
    corner = (np.arange(150)[:, None] * 151 + np.arange(150)).ravel()
    quads = np.column_stack((corner, corner + 1, corner + 152, corner + 151))
    mesh = HalfEdgeMesh.from_elements(np.column_stack((x.ravel(), y.ravel())), quads)
    window = open_window(mesh)
    monitor = measured(qtbot, window).monitor
    seen = []
    monitor.measured.connect(lambda: seen.append(monitor.summary.jacobian.worst))
    inside = int(np.flatnonzero(~mesh.boundary())[0])
    for _ in range(10):
        window.document.move(np.array([inside]), mesh.points[[inside]] + (0.02, 0.0, 0.0))
    measured(qtbot, window)
    assert seen == [pytest.approx(quality.scaled_jacobian(mesh).min())]
    window.document.undo()
    qtbot.waitUntil(lambda: monitor._thread is not None, timeout=WAIT)
    window.close()
    assert monitor._thread is None


def test_folded_sections_are_remembered(qtbot, open_window, star):
    window = open_window(star)
    section = window.sidebar.sections[window.agent_panel]
    assert window.agent_panel.isVisible()
    qtbot.mouseClick(section.heading, Qt.MouseButton.LeftButton)
    assert not window.agent_panel.isVisible()
    assert not window.settings.flag("sidebar/agent", True)
    window.sidebar.reveal(window.agent_panel)
    assert window.agent_panel.isVisible()


@pytest.mark.parametrize(
    ("number", "text"),
    [(0, "0"), (9876, "9.9k"), (9960, "10k"), (12_345, "12k"), (3_400_000, "3.4M")],
)
def test_large_counts_are_short(number, text):
    assert short(number) == text


def test_tooltips_describe_the_column_under_the_mouse(qtbot, open_window, star):
    window = open_window(star)
    histogram = measured(qtbot, window).quality.histogram
    assert histogram.words(2.0) == "0 inverted elements"
    total = 0
    for number in range(20):
        width = (histogram.width() - 22) / 20
        words = histogram.words(22 + (number + 0.5) * width)
        total += int(words.rpartition(": ")[2].split()[0])
    assert total == star.n_elements
