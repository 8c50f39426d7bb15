"""The window by keyboard alone: menus, focus, tour, commands on vertices, and the screen reader."""

import pytest
from driving import WAIT, press
from qtpy.QtCore import QEvent, Qt
from qtpy.QtGui import QAccessible, QKeyEvent
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication, QWidget

from meshwright.desktop.actions import registry
from meshwright.desktop.editing.spoken_halfedge import NOTHING, spoken
from meshwright.desktop.editing.unused_keys import INACTIVE, ON_CANVAS
from meshwright.desktop.help.command_palette import PaletteEntry, rank
from meshwright.desktop.widgets.action_set import with_mnemonics

ALT = Qt.KeyboardModifier.AltModifier


def popup() -> QWidget | None:
    return QApplication.activePopupWidget()


def test_menus_have_different_letters():
    titles = with_mnemonics(registry.MENUS)
    letters = [title[title.index("&") + 1].lower() for title in titles]
    assert len(set(letters)) == len(registry.MENUS)
    assert titles[0] == "&File" and titles[-1] == "Hel&p"
    assert with_mnemonics(["aa", "aa"]) == ["&aa", "aa"]


def test_no_two_actions_share_a_key():
    for kind in ("tri", "quad"):
        keys = [k for a in registry.ACTIONS if a.kind in ("", kind) for k in a.shortcuts]
        assert sorted(keys) == sorted(set(keys))


def test_f10_and_alt_open_menus(qtbot, open_window, star):
    window = open_window(star)
    for key, modifier, title in (
        (Qt.Key.Key_F10, Qt.KeyboardModifier.NoModifier, "&File"),
        (Qt.Key.Key_M, ALT, "&Mesh"),
        (Qt.Key.Key_P, ALT, "Hel&p"),
    ):
        press(qtbot, window, key, modifier)
        qtbot.waitUntil(lambda: popup() is not None, timeout=WAIT)
        assert popup().title() == title
        QTest.keyClick(popup(), Qt.Key.Key_Escape)
        qtbot.waitUntil(lambda: popup() is None, timeout=WAIT)
        window.canvas.focus()


def test_alt_goes_to_the_menu_bar(qtbot, open_window, star):
    window = open_window(star)
    bar = window.menuBar()
    press(qtbot, window, Qt.Key.Key_Alt)
    qtbot.waitUntil(bar.hasFocus, timeout=WAIT)
    assert bar.activeAction().text() == "&File"


def test_down_after_alt_opens_the_menu_and_arrows_walk_through_the_bar(qtbot, open_window, star):
    window = open_window(star)
    bar = window.menuBar()
    press(qtbot, window, Qt.Key.Key_Alt)
    qtbot.waitUntil(bar.hasFocus, timeout=WAIT)
    for key, title in ((None, "&File"), (Qt.Key.Key_Right, "&Edit"), (Qt.Key.Key_Left, "&File")):
        if key is not None:
            QTest.keyClick(bar, key)
        assert bar.activeAction().text() == title
    QTest.keyClick(bar, Qt.Key.Key_Down)
    qtbot.waitUntil(lambda: popup() is not None, timeout=WAIT)
    assert popup().title() == "&File"
    QTest.keyClick(popup(), Qt.Key.Key_Down)
    assert popup().activeAction() is not None
    QTest.keyClick(popup(), Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: popup() is None, timeout=WAIT)


def test_a_menu_runs_an_action_by_keys(qtbot, open_window, star):
    window = open_window(star)
    press(qtbot, window, Qt.Key.Key_E)
    press(qtbot, window, Qt.Key.Key_S, ALT)
    qtbot.waitUntil(lambda: popup() is not None, timeout=WAIT)
    menu = popup()
    while menu.activeAction() is not window.actions_by_id["select.all"]:
        QTest.keyClick(menu, Qt.Key.Key_Down)
    QTest.keyClick(menu, Qt.Key.Key_Return)
    assert len(window.document.selection) == window.document.mesh.n_vertices


def test_tab_leaves_the_canvas_and_comes_back(qtbot, open_window, star):
    window = open_window(star)
    plotter = window.canvas.plotter
    met = []
    qtbot.keyClick(plotter, Qt.Key.Key_Tab)
    while QApplication.focusWidget() is not plotter and len(met) < 60:
        met.append(QApplication.focusWidget())
        qtbot.keyClick(met[-1], Qt.Key.Key_Tab)
    assert QApplication.focusWidget() is plotter
    panel = window.agent_panel
    assert {panel.complete, panel.hint, panel.rollouts_box} <= set(met)
    qtbot.keyClick(plotter, Qt.Key.Key_Backtab, Qt.KeyboardModifier.ShiftModifier)
    assert QApplication.focusWidget() is met[-1]


def test_the_tour_is_advanced_by_keys(qtbot, open_window, star):
    window = open_window(star)
    window.help.show_tour()
    callout = window.help.tour.callout
    for expected in (1, 2, 1):
        key = Qt.Key.Key_N if expected > window.help.tour.at else Qt.Key.Key_K
        press(qtbot, window, key, ALT)
        qtbot.waitUntil(lambda at=expected: window.help.tour.at == at, timeout=WAIT)
    qtbot.wait(300)  # a pressed button is shown for a moment
    assert window.canvas.plotter.hasFocus()
    qtbot.keyClick(window.canvas.plotter, Qt.Key.Key_Tab)
    assert callout.next.hasFocus()
    qtbot.keyClick(callout.next, Qt.Key.Key_Space)
    assert window.help.tour.at == 2
    for expected in (3, 4, None):
        press(qtbot, window, Qt.Key.Key_N, ALT)
        qtbot.waitUntil(
            lambda at=expected: (window.help.tour and window.help.tour.at) == at, timeout=WAIT
        )
        qtbot.wait(150)
    window.help.show_tour()
    press(qtbot, window, Qt.Key.Key_I, ALT)
    qtbot.waitUntil(lambda: window.help.tour is None, timeout=WAIT)


@pytest.mark.parametrize(
    ("typed", "action"),
    [
        ("lock", "vertex.lock"),
        ("pin", "vertex.pin"),
        ("corner", "vertex.corner"),
        ("desired degree 5", "vertex.desired_5"),
        ("name", "names"),
    ],
)
def test_commands_on_vertices_are_found_and_have_keys(typed, action):
    entries = [
        PaletteEntry(a.id, a.title.rstrip("\u2026"), a.menu, tooltip=a.tooltip)
        for a in registry.ACTIONS
    ]
    assert rank(typed, entries)[0][0].id == action
    assert next(a for a in registry.ACTIONS if a.id == action).shortcuts


def test_the_view_moves_to_an_irregular_vertex_only_if_it_must(qtbot, open_window, star):
    window = open_window(star)
    canvas = window.canvas
    fitted = canvas.viewport
    press(qtbot, window, Qt.Key.Key_N)
    assert window.document.hover >= 0 and canvas.viewport == fitted
    canvas.see(fitted.panned(3.0 * canvas.width(), 0.0))
    press(qtbot, window, Qt.Key.Key_N)
    place = star.points[star.origin(window.document.hover)]
    at = canvas.viewport.to_screen(place)
    assert (at > 0.0).all() and (at < canvas.viewport.size).all()
    canvas.see(fitted.zoomed(0.02, 100.0, 100.0))
    press(qtbot, window, Qt.Key.Key_N)
    assert canvas.viewport.pixels > 0.1 * fitted.pixels


def test_vertices_are_changed_by_keys_alone(qtbot, open_window, star):
    window = open_window(star)
    press(qtbot, window, Qt.Key.Key_N)
    mesh = window.document.mesh
    vertex = mesh.origin(window.document.hover)
    for key, read in (
        (Qt.Key.Key_K, mesh.locked),
        (Qt.Key.Key_P, mesh.pinned),
        (Qt.Key.Key_O, mesh.geometric),
    ):
        before = bool(read()[vertex])
        press(qtbot, window, key)
        assert bool(read()[vertex]) != before
    press(qtbot, window, Qt.Key.Key_5, ALT)
    assert mesh.desired()[vertex] == 5


def test_the_canvas_tells_what_the_keyboard_points_at(qtbot, open_window, star):
    window = open_window(star)
    QAccessible.setActive(True)
    seen = QAccessible.queryAccessibleInterface(window.canvas.plotter)
    assert seen.text(QAccessible.Text.Name) == "Mesh"
    said = []
    for key in (Qt.Key.Key_N, Qt.Key.Key_D, Qt.Key.Key_E, Qt.Key.Key_T):
        press(qtbot, window, key)
        halfedge = window.document.hover
        said.append(seen.text(QAccessible.Text.Description))
        assert said[-1] == spoken(window.document.mesh, halfedge, window.hover.current)
    assert len(set(said)) == 4
    assert f"vertex {star.origin(halfedge)}: degree" in said[-1]
    assert window.hover.current.info.title in said[-1]
    press(qtbot, window, Qt.Key.Key_Escape)
    assert seen.text(QAccessible.Text.Description) == NOTHING


@pytest.mark.parametrize(
    ("key", "modifier", "why"),
    [
        (Qt.Key.Key_O, Qt.KeyboardModifier.ControlModifier, "Open " + INACTIVE),
        (
            Qt.Key.Key_Return,
            Qt.KeyboardModifier.NoModifier,
            "Apply previewed operation " + ON_CANVAS,
        ),
    ],
)
def test_a_key_that_reaches_no_action_says_what_it_needs(open_window, star, key, modifier, why):
    """As in a window without the focus, whose shortcuts Qt does not look for."""
    window = open_window(star)
    window.unused_keys.explain(QKeyEvent(QEvent.Type.KeyPress, key, modifier))
    assert window.status.message == why
