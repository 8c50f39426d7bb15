"""The VTK scene of a mesh: what is seen from far."""

import numpy as np
import pytest

from meshwright.graphics.markers import markers
from meshwright.graphics.theme import theme
from meshwright.graphics.true_edges import TrueEdges
from meshwright.graphics.viewport import Viewport
from meshwright.graphics.vtk_scene import Scene
from meshwright_core.domains import gallery, meshing

pytestmark = pytest.mark.needs("window")


@pytest.fixture
def scene():
    pyvista = pytest.importorskip("pyvista")
    plotter = pyvista.Plotter(off_screen=True)
    yield Scene(plotter, theme("light"))
    plotter.close()


def sizes(scene: Scene) -> list[float]:
    return [actor.GetProperty().GetPointSize() for actor in scene._discs.values()]


def test_discs_do_not_hide_their_neighbours_from_far(scene):
    mesh = meshing.mesh_domain(gallery.shape("star"), "quad", 0.06)
    scene.show(mesh, TrueEdges(mesh))
    view = Viewport(size=(400, 400)).fitted(mesh.points[:, :2])
    scene.look(view)
    scene.show_crowd(mesh, True)
    near = sizes(scene)
    assert max(near) > 4.0
    view = Viewport(view.centre, view.pixels / 40, view.size)
    scene.look(view)
    spacing = np.sqrt(gallery.shape("star").area / mesh.irregular_count) * view.pixels
    assert max(sizes(scene)) <= max(1.0, 1.3 * spacing) < min(near)
    scene.look(Viewport(view.centre, view.pixels * 40, view.size))
    assert sizes(scene) == near


def test_lines_between_coloured_elements_go_from_far(scene):
    mesh = meshing.mesh_domain(gallery.shape("star"), "quad")
    scene.fills = np.full((mesh.n_elements, 3), 90, np.uint8)
    scene.show(mesh, TrueEdges(mesh))
    view = Viewport(size=(400, 400)).fitted(mesh.points[:, :2])
    scene.look(view)
    assert scene._surface.GetProperty().GetEdgeVisibility()
    scene.look(Viewport(view.centre, view.pixels / 200, view.size))
    assert not scene._surface.GetProperty().GetEdgeVisibility()


def test_lines_are_paler_and_thinner_from_far(scene):
    mesh = meshing.mesh_domain(gallery.shape("plate-with-round-hole"), "quad")
    scene.show(mesh, TrueEdges(mesh))
    view = Viewport(size=(400, 400)).fitted(mesh.points[:, :2])
    inner, curved, outline = scene._surface, scene._curved[1], scene._outline
    scene.look(view)
    dark = sum(inner.GetProperty().GetEdgeColor())
    assert outline.GetProperty().GetLineWidth() == pytest.approx(2.0)
    scene.look(Viewport(view.centre, view.pixels / 100, view.size))
    pale = sum(inner.GetProperty().GetEdgeColor())
    assert dark + 0.3 < pale == pytest.approx(sum(curved.GetProperty().GetColor()))
    assert outline.GetProperty().GetLineWidth() == pytest.approx(1.0)
    scene.look(view)
    assert sum(inner.GetProperty().GetEdgeColor()) == pytest.approx(dark)


def test_sizes_of_discs_are_known_once_they_are_no_crowd(scene):
    mesh = meshing.mesh_domain(gallery.shape("star"), "quad")
    scene.show(mesh, TrueEdges(mesh))
    scene.show_crowd(mesh, True)
    scene.update(mesh, TrueEdges(mesh))
    assert not scene.markers.sized
    scene.show_crowd(mesh, False)
    assert scene.markers.sized
    assert np.array_equal(scene.markers.reach, markers(mesh).reach)
