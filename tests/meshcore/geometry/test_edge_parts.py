"""Edges as parts of curves: their points and polylines, in view and out of it."""

from itertools import pairwise

import curved_meshes
import numpy as np
import pytest

from meshwright_core.core.arrays import HALF
from meshwright_core.geometry.edge_curves import curve_halfedges, edge_points
from meshwright_core.geometry.edge_parts import EdgeParts


def rim(mesh):
    halfedges = curve_halfedges(mesh)
    return halfedges, EdgeParts.of(mesh.arrays, halfedges, mesh.k)


@pytest.mark.parametrize("make", [curved_meshes.disc, curved_meshes.plate, curved_meshes.insert])
def test_points_are_those_of_the_edges_of_the_mesh(make):
    mesh = make()
    halfedges, parts = rim(mesh)
    w = np.linspace(0.0, 1.0, 9)
    for row, halfedge in enumerate(halfedges.tolist()):
        there = parts.points(np.full(9, row), w)
        assert np.abs(there - edge_points(mesh, halfedge, w)).max() < 1e-14
        assert (there[[0, -1]] == parts.ends[row]).all()


def test_polylines_of_a_circle_deviate_by_less_than_the_tolerance():
    _, parts = rim(curved_meshes.disc())
    for tolerance in (0.1, 1e-3, 1e-6):
        points, first = parts.polylines(tolerance)
        for begin, end in pairwise(first):
            line = points[begin:end, :2]
            middles = 0.5 * (line[1:] + line[:-1])
            assert np.abs(np.hypot(*line.T) - 1.0).max() < 1e-14
            assert (1.0 - np.hypot(*middles.T)).max() <= tolerance
        assert len(points) < 20.0 / np.sqrt(tolerance)


def test_a_box_limits_the_fine_part_of_a_polyline():
    _, parts = rim(curved_meshes.disc())
    at = np.array([np.sqrt(0.5), np.sqrt(0.5)])
    size = 1e-6
    points, _ = parts.polylines(1e-4 * size, np.stack([at - size, at + size]))
    assert len(points) < 400
    near = points[np.abs(points[:, :2] - at).max(axis=1) < size]
    assert len(near) > 1
    whole, _ = parts.polylines(1e-7)
    assert len(whole) > len(points)


def test_straight_edges_and_kinks_of_a_polyline():
    mesh = curved_meshes.plate()
    halfedges, parts = rim(mesh)
    _, first = parts.polylines(1e-3)
    loop = mesh.boundary_loops()[0]
    straight = mesh.arrays.vertex[loop[2], HALF]  # from the end of a fillet to the next one
    row = int(np.searchsorted(halfedges, straight))
    assert first[row + 1] - first[row] == 2
    none = parts.take(np.zeros(0, int))
    assert len(none.polylines(1e-3)[0]) == 0 and (none.box == 0.0).all()


def test_an_edge_off_its_curve_keeps_its_ends():
    mesh = curved_meshes.disc()
    mesh.move([4], mesh.points[[4]] * 1.1, mesh.parameters()[[4]])
    _, parts = rim(mesh)
    row = int(np.flatnonzero((parts.ends[:, 0] == mesh.points[4]).all(axis=1))[0])
    w = np.linspace(0.0, 1.0, 5)
    line = parts.points(np.full(5, row), w)
    assert (line[0] == mesh.points[4]).all()
    off = mesh.points[4, :2] / 11.0
    on_circle = line[:, :2] - (1.0 - w)[:, None] * off
    assert np.hypot(*on_circle.T) == pytest.approx(np.ones(5), abs=1e-14)
