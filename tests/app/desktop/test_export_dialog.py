"""The export dialog of the window: a picture with the half-edge that was pointed at."""

from driving import WAIT, find, point_at, press
from qtpy.QtCore import Qt, QTimer
from qtpy.QtWidgets import QApplication

from meshwright.desktop.history.export_dialog import ExportDialog
from meshwright.graphics.mesh_figure import figure


def in_dialog(open_it, act):
    """Open the dialog and do something in it."""
    met = []

    def look():
        dialog = QApplication.activeModalWidget()
        if isinstance(dialog, ExportDialog):
            timer.stop()
            met.append(dialog)
            try:
                act(dialog)
            finally:
                dialog.reject()

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(20)
    open_it()
    timer.stop()
    assert len(met) == 1


def test_an_image_may_show_the_half_edge_pointed_at(qtbot, open_window, star):
    window = open_window(star)
    export = window.playback.exporting.ask
    orders = []

    def without(dialog):
        dialog.formats[".png"].click()
        assert not dialog.halfedge.isEnabled()

    in_dialog(export, without)

    def within(dialog):
        for ending in (".png", ".gif"):
            dialog.formats[ending].click()
            orders.append(dialog.order)
            assert dialog.halfedge.isEnabled() == (ending == ".png")
            if dialog.halfedge.isEnabled():
                qtbot.mouseClick(dialog.halfedge, Qt.MouseButton.LeftButton)
                orders.append(dialog.order)

    halfedge = find(star, "flip_left")
    point_at(qtbot, window, halfedge)
    press(qtbot, window, Qt.Key.Key_F)
    qtbot.waitUntil(lambda: window.document.hover >= 0, timeout=WAIT)
    pointed_at = window.document.hover
    in_dialog(export, within)
    plain, arrow, film = orders
    assert (plain.halfedge, arrow.halfedge) == (-1, pointed_at)
    assert film.figure_options.halfedge == -1
    assert len(figure(star, arrow.figure_options).shapes) == 2 + len(
        figure(star, plain.figure_options).shapes
    )
