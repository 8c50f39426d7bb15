"""Licences of dependencies, and the dialogs that show them."""

import re

from driving import press
from qtpy.QtCore import Qt

from meshwright.desktop.help.about_dialog import AboutDialog, own_version
from meshwright.desktop.help.licences import UNKNOWN, licences
from meshwright.desktop.help.shortcuts_dialog import MOUSE, key_blocks, spread


def test_every_dependency_is_listed_with_its_licence():
    found = {re.sub("[-_.]+", "-", one.package).lower(): one for one in licences()}
    for name in ("numpy", "numba", "scipy", "torch", "pyvista", "vtk", "triangle", "qtpy"):
        assert found[name].licence not in ("", UNKNOWN)
        assert found[name].version
        assert len(found[name].licence) < 150
    assert "LGPL" in found["pyside6-essentials"].licence
    assert "meshwright" not in found
    assert "pytest" not in found  # an extra


def test_licence_texts_are_the_installed_ones():
    found = {one.package.lower(): one for one in licences()}
    assert "BSD" in found["numpy"].text() or "Redistribution" in found["numpy"].text()


def test_about_dialog_shows_licences_and_copies_versions(qtbot, open_window, star):
    window = open_window(star)
    page = AboutDialog(window)
    qtbot.addWidget(page)
    page.show()
    assert page.table.rowCount() == len(licences())
    names = [page.table.item(row, 0).text() for row in range(page.table.rowCount())]
    page.table.setCurrentCell(names.index("numpy"), 0)
    assert page.text.toPlainText().startswith("numpy ")
    assert f"Meshwright {own_version()}" in page.details()
    assert "numpy " in page.details()


def test_shortcuts_dialog_lists_every_shortcut_and_is_not_modal(qtbot, open_window, star):
    window = open_window(star)
    press(qtbot, window, Qt.Key.Key_F1)
    assert window.help.keys.isVisible()
    window.activateWindow()
    assert window.help.keys.isVisible()
    blocks = key_blocks(window.actions_by_id.menus(window.document.kind))
    listed = {keys for _, lines in blocks for keys, *_ in lines}
    assert {"Ctrl+Z", "F1", "Ctrl+K", "F"} <= listed
    assert len(blocks[-1][1]) == len(MOUSE)
    columns = spread(blocks, 3)
    assert [block for column in columns for block in column] == blocks
    assert len(columns) <= 3
    window.close()
    assert window.help.keys is None
