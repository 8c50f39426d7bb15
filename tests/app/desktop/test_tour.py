"""The tour: five callouts that confirm the user's actions and leave the focus with the canvas."""

import pytest
from driving import WAIT, beside, point_at, press
from qtpy.QtCore import QMargins, QPoint, QRect, Qt

from meshwright.desktop.help.callout import TIP
from meshwright.desktop.help.help_controller import PASSED_BY
from meshwright.desktop.help.tour import STEPS


def click(qtbot, button):
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def find(window, operation) -> int:
    """A half-edge that the operation may be applied to, and that the tour does not cover."""
    mesh, canvas = window.document.mesh, window.canvas.plotter
    card = window.help.tour.callout.geometry()
    return next(
        h
        for e in mesh.element_ids().tolist()
        for h in range(mesh.k * e, mesh.k * e + mesh.k)
        if mesh.check(operation, h) and not card.contains(canvas.mapTo(window, beside(window, h)))
    )


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


def tour_at(qtbot, window, size):
    """The callout of the tour in a window of that size."""
    window.resize(*size)
    qtbot.waitUntil(lambda: (window.width(), window.height()) == size, timeout=WAIT)
    window.help.show_tour()
    return window.help.tour.callout


@pytest.mark.parametrize("size", [(880, 560), (1280, 800), (1900, 1000)])
def test_each_callout_is_inside_the_window_beside_its_target(qtbot, open_window, star, size):
    window = open_window(star)
    callout = tour_at(qtbot, window, size)
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
    halfedge = find(window, "flip_left")
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


@pytest.mark.parametrize("size", [(960, 620), (1280, 800), (1900, 1000)])
def test_callouts_stand_on_the_canvas_and_cover_no_panel(qtbot, open_window, star, size):
    window = open_window(star)
    callout = tour_at(qtbot, window, size)
    places = window.help.places
    for step in STEPS:
        card = callout.geometry().marginsRemoved(QMargins(TIP, TIP, TIP, TIP))
        assert not any(places.rect(column).intersects(card) for column in places.columns), step
        click(qtbot, callout.next)


def test_tour_ends_when_one_goes_on_without_it(open_window, star):
    window = open_window(star)
    window.help.show_tour()
    window.actions_by_id["blocks.view"].trigger()
    assert window.help.tour is None
    assert window.status.message == PASSED_BY


def test_tour_stays_while_one_does_what_it_is_about(qtbot, open_window, star):
    window = open_window(star)
    window.help.show_tour()
    click(qtbot, window.help.tour.callout.next)
    halfedge = find(window, "flip_left")
    for _ in range(3):
        point_at(qtbot, window, halfedge)
        press(qtbot, window, Qt.Key.Key_F)
        window.actions_by_id["undo"].trigger()
    assert window.help.tour.at == 1
    click(qtbot, window.help.tour.callout.next)
    click(qtbot, window.help.tour.callout.next)
    window.actions_by_id["agent.watch"].trigger()
    assert STEPS[window.help.tour.at].menu == "Agent"
    click(qtbot, window.help.tour.callout.next)
    for action in ("history.first", "history.last", "history.back", "history.forward"):
        window.actions_by_id[action].trigger()
    assert STEPS[window.help.tour.at].menu == "History"


def test_tour_ends_after_some_operations_beside_it(qtbot, open_window, star):
    window = open_window(star)
    window.help.show_tour()
    for _ in range(3):
        assert window.help.tour is not None
        point_at(qtbot, window, find(window, "flip_left"))
        press(qtbot, window, Qt.Key.Key_F)
    assert window.help.tour is None
