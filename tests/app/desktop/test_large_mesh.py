"""What one operation costs in a window on 100,000 quads, counted as work done, not as time."""

import numpy as np
import pytest
from driving import WAIT, point_at, press
from qtpy.QtCore import Qt

from meshwright.desktop.canvas import canvas as canvas_module
from meshwright.graphics.viewport import Viewport
from meshwright.graphics.vtk_scene import Scene
from meshwright_core.domains import meshing


@pytest.fixture
def work(monkeypatch):
    """The parts of the work in their order: methods of the scene, and the mouse's search tree."""
    done = []

    def noted(owner, name):
        usual = getattr(owner, name)

        def call(*given, **named):
            done.append(name)
            return usual(*given, **named)

        monkeypatch.setattr(owner, name, call)

    for name in ("show", "update", "update_edges", "refill", "_add"):
        noted(Scene, name)
    noted(canvas_module, "Picker")
    return done


@pytest.mark.slow
def test_an_operation_and_its_undo_take_one_update_and_one_frame_each(qtbot, open_window, work):
    mesh = meshing.grid("quad", 100_000)
    window = open_window(mesh)
    view = window.canvas.viewport
    away = np.linalg.norm(mesh.points[:, :2] - view.centre, axis=1)
    halfedge = 4 * int(np.flatnonzero((mesh.elements() == away.argmin()).any(axis=1))[0])
    # close enough to point at one half-edge
    window.canvas.see(Viewport(view.centre, 40 * view.pixels, view.size))
    point_at(qtbot, window, halfedge)
    qtbot.waitUntil(lambda: window.quality.monitor.fresh, timeout=WAIT)
    window.canvas.plotter.ren_win.AddObserver("EndEvent", lambda *_: work.append("frame"))
    for key, modifier, steps in (
        (Qt.Key.Key_F, Qt.KeyboardModifier.NoModifier, 1),
        (Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier, 0),
    ):
        work.clear()
        press(qtbot, window, key, modifier)
        assert window.document.history.cursor == steps
        qtbot.waitUntil(lambda: "Picker" in work and "frame" in work, timeout=WAIT)
        qtbot.wait(100)
        # the search tree takes longest, and comes after the picture
        assert [part for part in work if part != "_add"] == [
            "update",
            "update_edges",
            "frame",
            "Picker",
        ]
        assert work.count("_add") <= 2  # discs of irregularities that the grid did not have
    assert mesh.score == 0
