"""The tour: five callouts that confirm the user's actions and leave the focus with the canvas."""

import pytest
from driving import WAIT, find, point_at, press
from qtpy.QtCore import QPoint, QRect, Qt

from meshwright.desktop.help.tour import STEPS


def click(qtbot, button):
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def test_unguided_window_shows_no_tour(open_window, star):
    assert open_window(star).help.tour is None


def test_tour_is_shown_once_and_on_request(qtbot, open_window, star):
    window = open_window(star)
    window.help.welcome()
    callout = window.help.tour.callout
    assert callout.isVisible()
    assert callout.heading.text() == STEPS[0].heading
    click(qtbot, callout.skip)
    assert window.help.tour is None
    window.help.welcome()
    assert window.help.tour is None
    window.actions_by_id["tour"].trigger()
    assert window.help.tour.at == 0


def test_tour_waits_for_a_mesh(qtbot, open_window, star):
    window = open_window()
    window.help.welcome()
    assert window.help.tour is None
    window.document.replace(star, "star")
    assert window.help.tour.callout.isVisible()


@pytest.mark.parametrize("size", [(880, 560), (1280, 800), (1900, 1000)])
def test_each_callout_is_inside_the_window_beside_its_target(qtbot, open_window, star, size):
    window = open_window(star)
    window.resize(*size)
    qtbot.waitUntil(lambda: (window.width(), window.height()) == size, timeout=WAIT)
    window.help.show_tour()
    callout = window.help.tour.callout
    for number, step in enumerate(STEPS, start=1):
        assert callout.count.text() == f"{number} of 5"
        assert callout.heading.text() == step.heading
        assert window.rect().contains(callout.geometry())
        target = step.target(window.help.places)
        assert target is not None
        assert not QRect(target.center() - QPoint(2, 2), target.center()).intersects(
            callout.geometry()
        )
        click(qtbot, callout.next)
    assert window.help.tour is None


def test_tour_confirms_actions_and_leaves_the_focus_with_the_canvas(qtbot, open_window, star):
    window = open_window(star)
    window.help.show_tour()
    callout = window.help.tour.callout
    assert window.canvas.plotter.hasFocus()
    assert not callout.done.isVisible()
    halfedge = find(star, "flip_left")
    point_at(qtbot, window, halfedge)
    assert callout.done.isVisible()
    click(qtbot, callout.next)
    assert not callout.done.isVisible()
    assert window.canvas.plotter.hasFocus()
    press(qtbot, window, Qt.Key.Key_F)
    assert window.document.history.last.action == "flip_left"
    assert callout.done.isVisible()
    click(qtbot, callout.back)
    assert window.help.tour.at == 0
    assert window.canvas.plotter.hasFocus()


def test_tour_unfolds_the_panel_it_points_at(qtbot, open_window, star):
    window = open_window(star)
    window.sidebar.sections[window.agent_panel].heading.setChecked(False)
    window.help.show_tour()
    for _ in range(3):
        click(qtbot, window.help.tour.callout.next)
    assert window.agent_panel.isVisible()


def test_closing_the_window_ends_the_tour(open_window, star):
    window = open_window(star)
    window.help.show_tour()
    window.close()
    assert window.help.tour is None
    assert window.settings.toured


def test_tour_does_not_point_at_hidden_widgets(open_window, star):
    window = open_window(star)
    last = STEPS[-1]
    timeline = last.target(window.help.places)
    for part in (window.playback.timeline, window.playback.panel):
        part.hide()
    button = window.toolbar.widgetForAction(window.actions_by_id["undo"])
    assert last.target(window.help.places) != timeline
    assert last.target(window.help.places).size() == button.size()
