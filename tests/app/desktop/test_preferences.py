"""Settings: persistence, invalid values, and their effect on the window."""

import pytest
from driving import find, point_at, press
from qtpy.QtCore import QSettings, Qt
from qtpy.QtGui import QGuiApplication

from meshwright.desktop.application import preferences_controller
from meshwright.desktop.application.preferences_controller import system_theme
from meshwright.desktop.application.preferences_dialog import PreferencesDialog
from meshwright.desktop.application.settings import RECENT, Settings
from meshwright.graphics.theme import COLOURS, theme


@pytest.fixture
def store(tmp_path):
    return str(tmp_path / "settings.ini")


@pytest.fixture
def dialog(qtbot, open_window, star):
    window = open_window(star)
    made = PreferencesDialog(window.settings, window)
    qtbot.addWidget(made)
    made.show()
    return window, made


def test_settings_persist(store):
    first = Settings(store)
    first.theme, first.colours, first.auto_smooth = "dark", "gold", False
    first.recent = ["a.vtk", "b.vtk", "a.vtk"]
    second = Settings(store)
    assert (second.theme, second.colours, second.auto_smooth) == ("dark", "gold", False)
    assert second.recent == ["a.vtk", "b.vtk"]
    second.clear()
    third = Settings(store)
    assert (third.theme, third.colours, third.auto_smooth) == ("system", "vermilion", True)
    assert third.recent == []


def test_invalid_stored_values_read_as_defaults(store):
    raw = QSettings(store, QSettings.Format.IniFormat)
    for key in ("look/theme", "look/colours", "look/numbers", "editing/auto_smooth"):
        raw.setValue(key, "mauve")
    raw.setValue("window/geometry", 7)
    raw.setValue("speed", "fast")
    raw.sync()
    settings = Settings(store)
    assert (settings.theme, settings.colours) == ("system", "vermilion")
    assert settings.numbers and settings.auto_smooth
    assert settings.geometry.isEmpty()
    assert settings.number("speed", 4.0) == 4.0


def test_a_change_is_emitted_once(store):
    settings = Settings(store)
    received = []
    settings.changed.connect(received.append)
    settings.theme = "dark"
    settings.theme = "dark"
    settings.clear("look")
    assert received == ["look/theme", "look/theme"]


def test_recent_files_are_limited(store):
    settings = Settings(store)
    settings.recent = [f"{number}.vtk" for number in range(30)]
    assert settings.recent == [f"{number}.vtk" for number in range(RECENT)]


def test_theme_is_applied_and_stored_at_once(qtbot, dialog):
    window, page = dialog
    assert page.themes["system"].isChecked()
    assert window.theme.name == system_theme()
    for name in ("dark", "light"):
        qtbot.mouseClick(page.themes[name], Qt.MouseButton.LeftButton)
        assert window.theme == theme(name)
        assert Settings().theme == name


def test_the_theme_follows_the_desktop_until_one_is_chosen(open_window, star, monkeypatch):
    window = open_window(star)
    desktop = QGuiApplication.styleHints()

    def turn(name: str, scheme: Qt.ColorScheme) -> None:  # this platform reports no colour scheme
        monkeypatch.setattr(preferences_controller, "system_theme", lambda: name)
        desktop.colorSchemeChanged.emit(scheme)

    turn("dark", Qt.ColorScheme.Dark)
    assert window.theme.name == "dark"
    turn("light", Qt.ColorScheme.Light)
    assert window.theme.name == "light"
    window.settings.theme = "light"
    turn("dark", Qt.ColorScheme.Dark)
    assert window.theme.name == "light"


def test_toggle_and_dialog_share_the_setting(qtbot, open_window, star):
    window = open_window(star)
    press(qtbot, window, Qt.Key.Key_T, Qt.KeyboardModifier.ControlModifier)
    assert window.theme.name == window.settings.theme == "dark"


def test_colours_and_numbers_reach_the_canvas(qtbot, dialog):
    window, page = dialog
    page.colours.setCurrentIndex(1)
    page.colours.activated.emit(1)
    name = list(COLOURS)[1]
    assert window.settings.colours == name
    assert (window.theme.plus, window.theme.minus) == COLOURS[name][1:]
    assert window.canvas.overlay.markers.theme.plus == COLOURS[name][1]
    assert window.quality.score.tally._theme.plus == COLOURS[name][1]
    assert window.canvas.overlay.markers.numbers
    page.switches["numbers"].click()
    assert not window.canvas.overlay.markers.numbers


def test_operation_moves_no_vertices_without_auto_smooth(qtbot, open_window, star):
    window = open_window(star)
    window.actions_by_id["auto_smooth"].trigger()
    assert not window.settings.auto_smooth
    assert not window.document.auto_smooth
    assert not window.actions_by_id["auto_smooth"].isChecked()
    before = star.points.copy()
    point_at(qtbot, window, find(star, "flip_left"))
    press(qtbot, window, Qt.Key.Key_F)
    assert (star.points == before).all()


def test_defaults_button_resets_all_settings(qtbot, dialog):
    window, page = dialog
    page.themes["dark"].click()
    page.switches["auto_smooth"].click()
    page.switches["autosave"].click()
    assert not window.settings.autosave
    page._reset()
    assert page.themes["system"].isChecked()
    assert page.switches["auto_smooth"].isChecked()
    assert window.document.auto_smooth
    assert window.settings.autosave


def test_window_position_is_restored(open_window, star):
    window = open_window(star)
    window.resize(930, 640)
    window.close()
    again = open_window(star.copy())
    again.settings.geometry = window.settings.geometry
    again.preferences.restore_place()
    assert (again.width(), again.height()) == (930, 640)
