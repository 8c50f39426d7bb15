"""Colours of elements by block, chord and quality, their legend, and going to what they show."""

import numpy as np
import pytest
from driving import WAIT, press
from qtpy.QtCore import Qt

from meshwright.document.quality_summary import decimal
from meshwright.graphics.colouring import (
    STOPS,
    block_colours,
    chord_lines,
    measure_colours,
    scale,
)
from meshwright.graphics.theme import THEMES
from meshwright_core.analysis.blocks import block_of
from meshwright_core.core.arrays import TWIN
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry import quality
from meshwright_core.geometry.element_shapes import element_shapes

CONTROL = Qt.KeyboardModifier.ControlModifier


def luminance(colours: np.ndarray) -> np.ndarray:
    return np.asarray(colours, float) @ (0.2126, 0.7152, 0.0722)


def measured(qtbot, window):
    qtbot.waitUntil(lambda: window.quality.monitor.fresh, timeout=WAIT)


@pytest.mark.parametrize("name", ["light", "dark"])
def test_the_scale_changes_in_lightness_in_one_direction(name):
    theme = THEMES[name]
    light = luminance(measure_colours(np.linspace(0.0, 1.0, 41), theme))
    steps = np.diff(light)
    assert (steps > 0).all() if name == "light" else (steps < 0).all()
    assert abs(light[-1] - light[0]) > 120
    assert len(scale(theme)) == len(STOPS)


def test_neighbouring_blocks_have_different_colours(star):
    colours, count = block_colours(star, THEMES["light"])
    block = block_of(star)
    assert count == block.max() + 1
    row = np.full(int(star.element_ids().max()) + 1, -1)
    row[star.element_ids()] = np.arange(star.n_elements)
    halfedges = star.halfedges_of(star.element_ids()).ravel()
    twin = star.arrays.edge[halfedges, TWIN]
    inner = twin >= 0
    one, other = row[halfedges[inner] // 4], row[twin[inner] // 4]
    same = (colours[one] == colours[other]).all(axis=1)
    assert np.array_equal(same, block[one] == block[other])


def test_every_element_lies_on_two_chords(star):
    ends, chord = chord_lines(star)
    assert ends.shape == (2 * star.n_elements, 2, 2)
    assert len(np.unique(chord)) == chord.max() + 1


def test_the_view_shows_colours_and_a_legend(qtbot, open_window, star):
    window = open_window(star)
    measured(qtbot, window)
    before = window.canvas.grab().toImage()
    act = window.actions_by_id
    for by, values in (
        ("shape", element_shapes(star)),
        ("jacobian", quality.scaled_jacobian(star)),
    ):
        act[f"colour.{by}"].trigger()
        fills = window.canvas.view._scene.fills[star.element_ids()]
        assert np.array_equal(fills, measure_colours(values, window.theme))
        legend = window.colours.legend
        assert legend.legend.scaled and legend.legend.note.startswith(
            f"worst {decimal(values.min())}"
        )
    assert legend.legend.bound == window.quality.monitor.summary.bound
    assert act["colour.jacobian"].isChecked() and not act["colour.shape"].isChecked()
    assert window.canvas.grab().toImage() != before
    act["colour.block"].trigger()
    assert legend.legend.note.endswith("blocks") and not legend.legend.scaled
    act["colour.chord"].trigger()
    assert not window.colours.chords.empty and window.canvas.view._scene.fills is None
    act["colour.chord"].trigger()
    assert window.colours.chords.empty and legend.legend is None
    assert window.settings.text("view/colour") == "plain"


def test_the_legend_covers_nothing_of_the_mesh_in_a_small_window(qtbot, open_window):
    window = open_window(meshing.mesh_domain(gallery.shape("square"), "quad"))
    window.resize(900, 600)
    measured(qtbot, window)
    canvas, act = window.canvas, window.actions_by_id

    def lowest():
        points = window.document.mesh.points[window.document.mesh.vertices()]
        return canvas.viewport.to_screen(points).max(axis=0)

    qtbot.waitUntil(lambda: canvas.height() < 450, timeout=WAIT)
    plain = canvas.viewport
    act["colour.jacobian"].trigger()
    card = window.colours.legend.card
    assert card.right() < canvas.width() and card.bottom() < canvas.height()
    assert lowest()[0] > card.left() and lowest()[1] < card.top()
    act["colour.jacobian"].trigger()
    assert canvas.viewport == plain
    act["colour.jacobian"].trigger()
    canvas.see(canvas.viewport.zoomed(2.0, 10.0, 10.0))
    seen = canvas.viewport
    act["colour.jacobian"].trigger()
    assert canvas.viewport == seen  # a view that was chosen stays


def test_colours_follow_an_edit(qtbot, open_window, star):
    window = open_window(star)
    measured(qtbot, window)
    window.actions_by_id["colour.shape"].trigger()
    vertex = np.flatnonzero(~star.boundary())[:1]
    window.document.move(vertex, star.points[vertex] + (0.1, 0.0, 0.0))
    measured(qtbot, window)
    fills = window.canvas.view._scene.fills[star.element_ids()]
    assert np.array_equal(fills, measure_colours(element_shapes(star), window.theme))


def test_keys_go_to_the_worst_element_the_inverted_and_the_selection(qtbot, open_window, star):
    window = open_window(star)
    measured(qtbot, window)
    assert not window.actions_by_id["zoom_inverted"].isEnabled()
    press(qtbot, window, Qt.Key.Key_2, CONTROL)
    worst = window.quality.monitor.summary.jacobian.worst_element
    assert window.status.message.startswith(f"Element {worst}: scaled Jacobian")
    vertex = np.flatnonzero(~star.boundary())[:1]
    window.document.move(vertex, star.points[vertex] + (0.4, 0.0, 0.0))
    measured(qtbot, window)
    press(qtbot, window, Qt.Key.Key_3, CONTROL)
    assert window.status.message == f"Element {quality.inverted(star)[0]}."
    press(qtbot, window, Qt.Key.Key_A, CONTROL)
    press(qtbot, window, Qt.Key.Key_1, CONTROL)
    at = window.canvas.viewport.to_screen(star.points[star.vertices()])
    assert (at > 0).all() and (at < window.canvas.viewport.size).all()
