"""The command palette: matching, keys, and reasons of disabled actions."""

from driving import WAIT, find, point_at, press
from qtpy.QtCore import Qt
from qtpy.QtWidgets import QApplication

from meshwright.desktop.actions import registry
from meshwright.desktop.actions.action import Action
from meshwright.desktop.help.command_palette import PaletteEntry, rank

CONTROL = Qt.KeyboardModifier.ControlModifier


def open_palette(qtbot, window):
    press(qtbot, window, Qt.Key.Key_K, CONTROL)
    qtbot.waitUntil(lambda: window.help.palette is not None, timeout=WAIT)
    palette = window.help.palette
    qtbot.waitUntil(palette.field.hasFocus, timeout=WAIT)
    return palette


def test_palette_lists_all_menu_actions_with_their_shortcuts(qtbot, open_window, star):
    window = open_window(star)
    palette = open_palette(qtbot, window)
    listed = [a for _, members in window.actions_by_id.menus(window.document.kind) for a in members]
    assert [entry.id for entry in palette.shown] == [action.id for action in listed]
    keys = {entry.id: entry.key for entry in palette.shown}
    assert keys["undo"] == "Ctrl+Z"
    assert keys["about"] == ""
    assert not any(entry.id.startswith("tri.") for entry in palette.shown)


def test_typed_letters_and_return_run_an_action(qtbot, open_window, star):
    window = open_window(star)
    palette = open_palette(qtbot, window)
    qtbot.keyClicks(palette.field, "dark")
    assert palette.shown[0].id == "theme"
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert window.theme.name == "dark"
    assert window.help.palette is None
    assert window.canvas.plotter.hasFocus()


def test_operation_from_palette_applies_to_previously_hovered_half_edge(qtbot, open_window, star):
    window = open_window(star)
    halfedge = find(star, "flip_left")
    point_at(qtbot, window, halfedge)
    palette = open_palette(qtbot, window)
    qtbot.keyClicks(palette.field, "flip l")
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert window.document.history.last.action == "flip_left"
    assert window.document.history.last.halfedge == halfedge


def test_disabled_action_shows_its_reason_and_keeps_palette_open(qtbot, open_window, star):
    window = open_window(star)
    palette = open_palette(qtbot, window)
    qtbot.keyClicks(palette.field, "undo")
    assert palette.shown[0].reason == "There is nothing to undo."
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert palette.isVisible()


def test_arrows_wrap_around_and_escape_restores_the_focus(qtbot, open_window, star):
    window = open_window(star)
    palette = open_palette(qtbot, window)
    qtbot.keyClick(palette.field, Qt.Key.Key_Up)
    assert palette.list.currentRow() == palette.list.count() - 1
    qtbot.keyClick(palette.field, Qt.Key.Key_Down)
    assert palette.list.currentRow() == 0
    qtbot.keyClick(palette.field, Qt.Key.Key_PageDown)
    assert palette.list.currentRow() == 9
    qtbot.keyClick(palette.field, Qt.Key.Key_Escape)
    assert window.help.palette is None
    assert QApplication.focusWidget() is window.canvas.plotter


def test_typing_in_the_palette_does_not_edit_the_mesh(qtbot, open_window, star):
    window = open_window(star)
    point_at(qtbot, window, find(star, "flip_left"))
    palette = open_palette(qtbot, window)
    qtbot.keyClicks(palette.field, "fcs .x")
    assert palette.field.text() == "fcs .x"
    assert window.document.history.cursor == 0
    assert palette.nothing.isVisible()


def test_click_runs_a_row_and_click_elsewhere_closes_the_palette(qtbot, open_window, star):
    window = open_window(star)
    palette = open_palette(qtbot, window)
    qtbot.keyClicks(palette.field, "tour")
    box = palette.list.visualItemRect(palette.list.item(0))
    qtbot.mouseClick(palette.list.viewport(), Qt.MouseButton.LeftButton, pos=box.center())
    assert window.help.tour is not None
    window.help.end_tour()
    open_palette(qtbot, window)
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.RightButton)
    qtbot.waitUntil(lambda: window.help.palette is None, timeout=WAIT)


def test_shortcut_and_closing_the_window_close_the_palette(qtbot, open_window, star):
    window = open_window(star)
    palette = open_palette(qtbot, window)
    qtbot.keyClick(palette.field, Qt.Key.Key_K, CONTROL)
    assert window.help.palette is None
    open_palette(qtbot, window)
    window.close()
    assert window.help.palette is None


def test_every_action_that_can_be_disabled_has_a_reason():
    always = Action.__dataclass_fields__["enabled"].default
    silent = [
        action.id
        for action in registry.ACTIONS
        if action.enabled is not always
        and not action.id.startswith(("tri.", "quad."))  # listed for their kind of mesh only
        and action.requirement == "Not possible now."
    ]
    assert silent == []
    assert all(action.requirement.endswith(".") for action in registry.ACTIONS)


def test_title_matches_rank_first_and_enabled_before_disabled():
    entries = [
        PaletteEntry("a", "Fit", "View"),
        PaletteEntry("b", "First step", "History", reason="No."),
        PaletteEntry("c", "Find", "File"),
        PaletteEntry("d", "Other", "Field", tooltip="It finds things"),
    ]
    assert [entry.id for entry, _ in rank("fi", entries)] == ["a", "c", "b", "d"]
    assert [entry.id for entry, _ in rank("", entries)] == ["a", "b", "c", "d"]
    assert [entry.id for entry, _ in rank("things", entries)] == ["d"]
