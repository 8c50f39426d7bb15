"""True edges for a view: outlines of elements, loops, interfaces; picking beside a curve."""

import curved_meshes
import numpy as np

from meshwright.graphics.markers import markers
from meshwright.graphics.picking import Picker
from meshwright.graphics.theme import LIGHT, region_fills
from meshwright.graphics.true_edges import TOLERANCE, TrueEdges
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh


def seen(mesh, pixels=100.0, centre=(0.0, 0.0)):
    edges, viewport = TrueEdges(mesh), Viewport(centre, pixels, (800, 600))
    edges.look(viewport)
    return edges, viewport


def test_a_straight_mesh_has_no_curved_edges(star):
    edges, viewport = seen(star)
    assert not edges and len(edges.elements) == 0
    assert not edges.look(viewport.zoomed(1000.0, 0.0, 0.0))
    element = int(star.element_ids()[0])
    assert (edges.outline(element) == star.points[star.corners(np.array([element]))[0], :2]).all()
    assert len(edges.loops()) == 1 and len(edges.loops()[0]) == len(star.boundary_loops()[0]) + 1


def test_a_closed_surface_has_no_loops():
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    edges, _ = seen(HalfEdgeMesh.from_elements(corners, faces))
    assert edges.loops() == [] and edges.interfaces() == []


def test_polylines_are_made_again_when_the_zoom_has_changed_much():
    edges, viewport = seen(curved_meshes.disc())
    before = edges.points
    assert not edges.look(viewport.zoomed(1.5, 400.0, 300.0))
    assert edges.points is not before and len(edges.points) == len(before)
    closer = Viewport((np.sqrt(0.5), np.sqrt(0.5)), 1e6, (800, 600))
    assert edges.look(closer)
    assert not edges.look(closer.panned(300.0, 0.0))
    assert edges.look(closer.panned(3000.0, 0.0))


def test_loops_are_circles_to_a_tenth_of_a_pixel_at_every_zoom():
    for pixels in (10.0, 1e3, 1e6, 1e8):
        edges, viewport = seen(curved_meshes.disc(), pixels, (0.6, 0.8))
        (loop,) = edges.loops()
        at = viewport.to_screen(loop)
        middles = 0.5 * (loop[1:] + loop[:-1])
        inside = (viewport.to_screen(middles) > 0) & (viewport.to_screen(middles) < (800, 600))
        shown = middles[inside.all(axis=1)]
        assert len(at) < 2000
        assert (np.abs(np.hypot(*shown.T) - 1.0) * pixels <= 1.01 * TOLERANCE + 1e-6).all()


def test_interfaces_and_regions():
    mesh = curved_meshes.insert()
    edges, _ = seen(mesh)
    lines = edges.interfaces()
    assert len(lines) == 4
    assert np.abs(np.hypot(*np.concatenate(lines).T) - 1.0).max() < 1e-12
    assert set(edges.elements.tolist()) == set(range(1, 9))
    fills = region_fills(LIGHT, 2)
    assert len(set(fills)) == 2 and region_fills(LIGHT, 1) == [LIGHT.fill]


def test_a_point_between_curve_and_chord_belongs_to_the_element_on_its_side():
    mesh = curved_meshes.insert()
    edges, _ = seen(mesh, 200.0)
    picker = Picker(mesh, edges)
    region = mesh.regions()
    angle = 0.0  # where the curves are farthest from their chords
    for radius, expected in ((0.95, 1), (0.99, 1), (1.01, 0), (1.98, 0)):
        row = picker.element_row(radius * np.cos(angle), radius * np.sin(angle))
        assert row >= 0 and region[row] == expected
    assert picker.element_row(2.02, 0.0) == -1
    halfedge = picker.halfedge(1.97, 0.0)
    assert mesh.twin(halfedge) < 0
    straight = Picker(mesh)
    assert straight.element_row(1.98, 0.0) == -1


def test_anchors_are_marked_apart_from_corners():
    marks = markers(curved_meshes.plate())
    assert len(marks.anchor_places) == 8 and len(marks.corner_places) == 0
