"""Accessible names, tooltips and keyboard focus of all controls; help at the first start."""

import pytest
from driving import WAIT
from qtpy.QtCore import QObject, Qt
from qtpy.QtWidgets import (
    QAbstractButton,
    QAbstractSlider,
    QAbstractSpinBox,
    QComboBox,
    QLineEdit,
    QScrollBar,
    QWidget,
)

from meshwright.desktop.actions import registry
from meshwright.desktop.application.preferences_dialog import PreferencesDialog
from meshwright.desktop.help.about_dialog import AboutDialog
from meshwright.desktop.main_window.startup import open_window as open_a_window
from meshwright.document.document import Document
from meshwright_core.io import mesh_files

CONTROLS = (QAbstractButton, QAbstractSlider, QAbstractSpinBox, QComboBox, QLineEdit)


def controls(parent: QObject) -> list[QWidget]:
    """The controls of a widget, without Qt's internal ones."""
    return [
        found
        for kind in CONTROLS
        for found in parent.findChildren(kind)
        if found.isVisibleTo(parent)
        and not isinstance(found, QScrollBar)
        and not found.objectName().startswith("qt_")
        and not isinstance(found.parent(), QAbstractSpinBox | QComboBox)
        and type(found).__name__ not in ("QTableCornerButton",)
    ]


def name_of(control: QWidget) -> str:
    text = control.text() if isinstance(control, QAbstractButton) else ""
    return control.accessibleName() or text.strip(" .\u2026\u00b7")


def where(control: QWidget) -> str:
    names = []
    part: QObject | None = control
    while part is not None:
        names.append(type(part).__name__ + (f"#{part.objectName()}" if part.objectName() else ""))
        part = part.parent()
    return " < ".join(names[:4])


@pytest.mark.parametrize("kind", ["quad", "tri", "none"])
def test_every_control_of_the_window_has_a_name_and_a_tooltip(open_window, star, triangles, kind):
    window = open_window({"quad": star, "tri": triangles, "none": None}[kind])
    found = controls(window)
    assert len(found) > 20
    nameless = [where(control) for control in found if not name_of(control)]
    assert not nameless, "\n".join(nameless)
    without = [
        f"{name_of(control)}: {where(control)}" for control in found if not control.toolTip()
    ]
    assert not without, "\n".join(without)


@pytest.mark.parametrize("page", [PreferencesDialog, AboutDialog])
def test_every_control_of_the_dialogs_has_a_name_and_a_tooltip(qtbot, open_window, star, page):
    window = open_window(star)
    dialog = page(window.settings, window) if page is PreferencesDialog else page(window)
    qtbot.addWidget(dialog)
    found = controls(dialog)
    assert [where(control) for control in found if not name_of(control)] == []
    assert [name_of(control) for control in found if not control.toolTip()] == []


def test_every_action_has_a_tooltip():
    for action in registry.ACTIONS:
        assert action.title and action.tooltip and action.menu, action.id
        assert not action.tooltip.endswith("."), action.id
        assert action.tooltip[0].isupper(), action.id
        assert len(action.tooltip) < 100, action.id


def test_every_control_can_be_focused_with_tab(open_window, star):
    window = open_window(star)
    for button in controls(window.sidebar):
        assert button.focusPolicy() & Qt.FocusPolicy.TabFocus, where(button)


def test_guided_window_shows_the_tour_once(qtbot, open_window, star, tmp_path, monkeypatch):
    monkeypatch.setenv("MESHWRIGHT_STATE_DIR", str(tmp_path))
    open_window(star).settings.clear()  # tests use separate settings
    for expected in (True, False):
        window = open_a_window(Document(star.copy(), "star"), guided=True)
        qtbot.addWidget(window)
        qtbot.waitUntil(lambda window=window: window.canvas.built, timeout=WAIT)
        assert (window.help.tour is not None) == expected
        window.close()


def test_empty_page_lists_recent_files(qtbot, open_window, star, tmp_path):
    path = tmp_path / "part.vtk"
    mesh_files.write(path, star)
    window = open_window()
    window.settings.recent = [str(path), str(tmp_path / "gone.vtk")]
    assert [button.text() for button in window.empty.recent] == ["part.vtk"]
    qtbot.mouseClick(window.empty.recent[0], Qt.MouseButton.LeftButton)
    assert window.document.mesh.n_elements == star.n_elements
    assert window.pages.currentWidget() is window.canvas
