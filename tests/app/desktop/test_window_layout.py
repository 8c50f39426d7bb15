"""The window in several sizes: toolbar, history and score panel show all of their content."""

import pytest
from driving import WAIT
from qtpy.QtWidgets import QScrollArea

from meshwright.desktop.actions import registry
from meshwright.desktop.blocks.blocks_panel import BUTTON
from meshwright.desktop.history.history_panel import ROW
from meshwright.desktop.main_window.left_column import LEAST


@pytest.mark.parametrize("size", [(880, 560), (1280, 800)])
def test_the_toolbar_shows_every_button(qtbot, open_window, star, size):
    window = open_window(star)
    window.resize(*size)
    qtbot.waitUntil(lambda: (window.width(), window.height()) == size, timeout=WAIT)
    bar = window.toolbar
    for action_id in (name for group in registry.TOOLBAR for name in group):
        button = bar.widgetForAction(window.actions_by_id[action_id])
        assert button.isVisible(), action_id
        assert bar.rect().contains(button.geometry()), action_id


def test_the_history_shows_whole_lines_only(qtbot, open_window, star):
    window = open_window(star)
    for _ in range(30):
        mesh = window.document.mesh
        halfedge = next(h for h in range(4 * mesh.n_elements) if mesh.check("flip_left", h))
        window.document.submit("flip_left", halfedge)
    panel = window.playback.panel
    for height in (560, 613, 700):
        window.resize(1000, height)
        qtbot.waitUntil(lambda high=height: window.height() == high, timeout=WAIT)
        shown = panel.list
        assert shown.viewport().height() % ROW == 0
        assert shown.rowViewportPosition(shown.rowAt(0)) == 0
        assert shown.visualRect(panel.model.index(30)).bottom() < shown.viewport().height()


@pytest.mark.parametrize("size", [(900, 600), (1280, 800)])
def test_the_tools_of_a_chord_keep_their_size_and_scroll_in_a_low_window(
    qtbot, open_window, star, size
):
    window = open_window(star)
    window.resize(*size)
    qtbot.waitUntil(lambda: (window.width(), window.height()) == size, timeout=WAIT)
    panel = window.blocks.panel
    window.actions_by_id["blocks.view"].trigger()
    window.actions_by_id["blocks.next"].trigger()
    qtbot.waitUntil(panel.count.isVisible, timeout=WAIT)
    area = window.left.area
    qtbot.waitUntil(lambda: panel.count.height() >= panel.count.minimumSizeHint().height())
    for tool in panel.tools.values():
        assert tool.height() >= BUTTON
    assert panel.export.mapTo(area.widget(), panel.export.rect().topRight()).x() < area.width()
    bar = area.verticalScrollBar()
    qtbot.waitUntil(lambda: (bar.maximum() > 0) == (size[1] < 700), timeout=WAIT)
    bar.setValue(bar.maximum())
    shown = panel.export.mapTo(area, panel.export.rect().bottomLeft()).y()
    assert 0 < shown < area.height()
    assert window.playback.panel.height() >= LEAST


def test_large_numbers_fit_the_score_panel(qtbot, open_window, star, monkeypatch):
    window = open_window(star)
    panel = window.quality.score
    area = window.sidebar.findChild(QScrollArea)
    for numbers in ("12", "65,980", "1,234,567"):
        monkeypatch.setattr(type(star), "score", int(numbers.replace(",", "")))
        window.document.score_changed.emit()
        qtbot.wait(20)
        assert panel.score.text() == numbers
        assert area.widget().minimumSizeHint().width() <= area.viewport().width()
    monkeypatch.undo()


@pytest.mark.parametrize("size", [(880, 560), (1280, 800)])
def test_the_page_of_keys_is_as_wide_as_its_columns(qtbot, open_window, star, size):
    window = open_window(star)
    window.resize(*size)
    qtbot.waitUntil(lambda: (window.width(), window.height()) == size, timeout=WAIT)
    window.actions_by_id["help"].trigger()
    page = window.help.keys
    qtbot.waitUntil(page.isVisible, timeout=WAIT)
    area = page.findChild(QScrollArea)
    assert area.widget().minimumSizeHint().width() <= area.viewport().width()
    assert page.width() <= window.width()
    page.accept()
