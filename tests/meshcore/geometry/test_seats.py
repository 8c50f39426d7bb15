"""Vertices on curves: where they slide, what bounds them, and sides whose ends were dragged."""

import numpy as np
import pytest
from round_meshes import dragged_plate, round_disc, round_insert, round_ring
from side_checks import assert_on_sides

from meshwright_core.core.composite_curves import place_all
from meshwright_core.domains import meshing
from meshwright_core.geometry import movable_part, quality, smoothing
from meshwright_core.geometry.edge_curves import edge_points, element_areas


@pytest.mark.parametrize(
    "mesh",
    [
        pytest.param(round_ring(5, rows=2), id="ring"),
        pytest.param(round_disc(), id="disc"),
        pytest.param(round_insert(), id="insert"),
        pytest.param(meshing.grid("quad", 16), id="grid"),
    ],
)
def test_seats_are_bounded_by_the_neighbours(mesh):
    part = movable_part.whole(mesh)
    seats, lengths = part.seats, mesh.boundary_info.lengths()
    slides = np.flatnonzero(part.sliding)
    assert (mesh.curve_ids()[part.vertices[slides]] == seats.curve[slides]).all()
    own = mesh.parameters()[part.vertices[slides]]
    assert np.mod(seats.parameter[slides] - own, lengths[seats.curve[slides]]) == pytest.approx(0)
    for i in slides.tolist():
        before, after = int(seats.before[i]), int(seats.after[i])
        low = seats.low[i] + (seats.parameter[before] if before >= 0 else 0.0)
        high = seats.high[i] + (seats.parameter[after] if after >= 0 else 0.0)
        assert low < seats.parameter[i] < high
        assert seats.reach[i, 0] <= low + 1e-12
        assert seats.reach[i, 1] >= high - 1e-12


def test_some_seats_are_those_of_all():
    mesh = round_ring(6, rows=2)
    everything = movable_part.whole(mesh)
    for v in np.flatnonzero(mesh.boundary()).tolist():
        own = movable_part.around(mesh, np.array([v]))
        (i,) = np.flatnonzero(own.sliding).tolist()
        assert own.vertices[i] == v
        j = int(np.searchsorted(everything.vertices, v))
        assert own.seats.curve[i] == everything.seats.curve[j]
        assert own.seats.before[i] == own.seats.after[i] == -1
        width = np.ptp(own.seats.reach[i])
        assert width == pytest.approx(
            mesh.boundary_info.lengths()[own.seats.curve[i]] / 3, rel=0.01
        )


@pytest.mark.parametrize("whole", [True, False])
def test_relaxing_keeps_vertices_on_curves_and_is_undone_to_the_bit(whole):
    for mesh in (round_ring(7, rows=2), round_disc(), round_insert()):
        rng = np.random.default_rng(0)
        inside = np.flatnonzero(mesh.curve_ids() < 0)
        slides = np.flatnonzero((mesh.curve_ids() >= 0) & ~mesh.geometric())
        mesh.points[inside, :2] += 0.05 * rng.normal(size=(len(inside), 2))
        shaken = 0.05 * rng.normal(size=(len(slides), 3)) * [1, 1, 0]
        mesh.move(slides, mesh.points[slides] + shaken)
        points, parameters = mesh.points.copy(), mesh.parameters()
        area = 16.0 if len(mesh.region_names) > 1 else None
        assert len(smoothing.relax(mesh, None if whole else slides[:2])) == 0
        if whole:
            assert_on_sides(mesh)
        if area:
            assert element_areas(mesh).sum() == pytest.approx(area, rel=1e-12)
        assert mesh.undo()
        assert mesh.points.tobytes() == points.tobytes()
        assert mesh.parameters().tobytes() == parameters.tobytes()


def test_relaxing_makes_corners_at_circles_square():
    ring = round_ring(6, rows=2)
    slides = np.flatnonzero(ring.boundary())
    turned = np.random.default_rng(3).uniform(-0.2, 0.2, len(slides))
    at = ring.points[slides].copy()
    at[:, 0] += turned * at[:, 1]
    at[:, 1] -= turned * at[:, 0]
    ring.move(slides, at)
    smoothing.relax(ring)
    assert np.abs(quality.angles(ring) - 90.0).max() < 3.0
    disc = round_disc()
    smoothing.relax(disc)
    corner = quality.angles(disc)[1:]
    assert np.abs(corner[:, 1:3] - 90.0).max() < 5.0


def test_interface_vertices_slide_and_both_areas_stay():
    mesh = round_insert()
    slides = np.flatnonzero((mesh.curve_ids() >= 0) & ~mesh.geometric())
    turn = np.array([[np.cos(0.4), np.sin(0.4), 0], [-np.sin(0.4), np.cos(0.4), 0], [0, 0, 1]])
    mesh.move(slides, mesh.points[slides] @ turn)
    before = mesh.parameters()[slides]
    assert len(smoothing.relax(mesh)) == 0
    assert (mesh.parameters()[slides] != before).all()
    assert_on_sides(mesh)
    inside = element_areas(mesh)[mesh.regions() == 1].sum()
    assert inside == pytest.approx(np.pi, rel=1e-13)


def test_a_corner_dragged_by_hand_takes_its_straight_sides_along():
    mesh = meshing.grid("quad", 16)
    corner = int(np.flatnonzero((mesh.points == [1, 1, 0]).all(axis=1))[0])
    mesh.move([corner], [[1.5, 1.7, 0.0]])
    smoothing.relax(mesh)
    # all vertices of both sides lie on the segments to the new corner
    for at, end in (([0.0, 1.0], 1), ([1.0, 0.0], 0)):
        along = np.array([1.5, 1.7]) - at
        side = [v for v in np.flatnonzero(mesh.boundary()).tolist() if mesh.points[v, end] > 0.99]
        for v in side:
            away = mesh.points[v, :2] - at
            if away @ along > 0.3:
                assert abs(along[0] * away[1] - along[1] * away[0]) < 1e-12 * (away @ away + 1)
    assert len(quality.inverted(mesh)) == 0


def test_a_corner_dragged_by_hand_takes_its_curved_side_along():
    mesh = dragged_plate()
    top = np.flatnonzero(mesh.boundary() & ~mesh.geometric() & (mesh.points[:, 1] > 2.5))
    assert len(smoothing.relax(mesh)) == 0
    curves, t = mesh.boundary_info.curves, mesh.parameters()
    corners = np.flatnonzero(mesh.geometric())
    start = corners[np.argmax(mesh.points[corners, :2].sum(axis=1))]
    end = corners[np.argmin(mesh.points[corners, 0] - mesh.points[corners, 1])]
    for v in top.tolist():
        share = (t[v] - t[start]) / (t[end] - t[start])
        drawn = place_all(curves, np.array([0]), t[[v]])[0]
        expected = drawn + (1 - share) * np.array([0.7, 0.4, 0.0])
        assert mesh.points[v] == pytest.approx(expected, abs=1e-12)
    for h in mesh.element_ids() * 4:
        for i in range(4):
            assert np.isfinite(edge_points(mesh, int(h) + i, [0.5])).all()
