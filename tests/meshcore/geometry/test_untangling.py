import itertools
import time

import numpy as np
import pytest
from round_meshes import (
    boundary_of,
    curved_mesh,
    dragged_plate,
    fan,
    round_disc,
    round_insert,
    round_ring,
)
from side_checks import assert_on_sides

from meshwright_core import HalfEdgeMesh
from meshwright_core.curves.curve import Curve
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry import foldover_energy, movable_part, quality, untangling
from meshwright_core.geometry.edge_curves import element_areas
from meshwright_core.geometry.unfixable import unfixable, unfixable_corners


def untangled(mesh, vertices=None):
    found = untangling.untangle(mesh, vertices)
    fixed = mesh.geometric()
    before = mesh.points[fixed].copy()
    mesh.move(found.vertices, found.positions, found.parameters)
    assert mesh.points[fixed].tobytes() == before.tobytes()
    assert sorted(quality.inverted(mesh)) == found.inverted.tolist()
    assert_on_sides(mesh)
    return found


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("name", ["star", "disc", "square-with-hole", "airfoil"])
@pytest.mark.parametrize("eps", [1.0, 1e-2])
def test_gradient_against_finite_differences(kind, name, eps):
    mesh = meshing.mesh_domain(gallery.shape(name), kind)
    part = movable_part.whole(mesh)
    rng = np.random.default_rng(0)
    free = np.flatnonzero(part.free)
    part.points[free, :2] += 0.3 * rng.normal(size=(len(free), 2))
    unit = 0.3
    targets = np.full(len(part.elements), unit * unit)
    problem, x = untangling.energy_problem(part, np.zeros(part.elements.shape, bool), unit, targets)
    x = x + 1e-3  # off the bends of polylines, where there is no gradient
    gradient, unused = np.zeros(len(x)), np.zeros(len(x))
    value, _ = foldover_energy.energy(problem, x, gradient, eps, 0.5)
    assert np.isfinite(value)
    for i in rng.choice(len(x), min(len(x), 20), replace=False):
        step = np.zeros(len(x))
        step[i] = 1e-6
        above, _ = foldover_energy.energy(problem, x + step, unused, eps, 0.5)
        below, _ = foldover_energy.energy(problem, x - step, unused, eps, 0.5)
        scale = max(1.0, np.abs(gradient).max())
        assert (above - below) / 2e-6 == pytest.approx(gradient[i], rel=1e-4, abs=1e-5 * scale)


@pytest.mark.parametrize("eps", [1.0, 1e-2])
@pytest.mark.parametrize(
    "mesh",
    [
        pytest.param(round_disc(), id="disc"),
        pytest.param(round_ring(3, rows=2), id="ring"),
        pytest.param(round_ring(9, rows=2), id="fine ring"),
        pytest.param(round_insert(), id="insert"),
        pytest.param(fan(5), id="triangles"),
        pytest.param(dragged_plate(), id="corner off its curve"),
    ],
)
def test_gradient_on_curves_against_finite_differences(mesh, eps):
    part = movable_part.whole(mesh)
    rng = np.random.default_rng(1)
    free = np.flatnonzero(part.free)
    part.points[free, :2] += 0.2 * rng.normal(size=(len(free), 2))
    unit = 0.7
    targets = np.full(len(part.elements), unit * unit)
    dropped = np.zeros(part.elements.shape, bool)
    problem, x = untangling.energy_problem(part, dropped, unit, targets)
    assert len(problem.curved.element)
    gradient, unused = np.zeros(len(x)), np.zeros(len(x))
    foldover_energy.energy(problem, x, gradient, eps, 0.5)
    for i in range(len(x)):
        step = np.zeros(len(x))
        step[i] = 1e-6
        above, _ = foldover_energy.energy(problem, x + step, unused, eps, 0.5)
        below, _ = foldover_energy.energy(problem, x - step, unused, eps, 0.5)
        scale = max(1.0, np.abs(gradient).max())
        assert (above - below) / 2e-6 == pytest.approx(gradient[i], rel=1e-5, abs=1e-6 * scale)


@pytest.mark.parametrize("name", ["disc", "ring", "insert", "triangles"])
def test_curved_meshes_are_untangled_from_bad_positions(name):
    mesh = {
        "disc": round_disc(), "ring": round_ring(5, rows=3), "insert": round_insert(),
        "triangles": fan(5),
    }[name]  # fmt: skip
    free = np.flatnonzero(~mesh.geometric())
    areas = np.abs(element_areas(mesh).sum())
    places = mesh.points[free].copy()
    mesh.points[free] = places[0] + 0.3 * (places - places[0]) + [0.1, 0.2, 0.0]
    found = untangled(mesh)
    assert len(found.inverted) == 0
    assert quality.scaled_jacobian(mesh).min() > 0.2
    assert element_areas(mesh).sum() == pytest.approx(areas, rel=1e-12)


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("start", ["point", "outside", "random", "sides"])
@pytest.mark.parametrize("name", ["star", "l-shape", "gear", "plate-with-holes", "disc"])
def test_untangling_from_bad_starting_positions(kind, start, name):
    mesh = meshing.mesh_domain(gallery.shape(name), kind)
    inside = np.flatnonzero(~mesh.boundary())
    rng = np.random.default_rng(5)
    if start == "point":
        mesh.points[inside] = mesh.points.mean(axis=0)
    elif start == "outside":
        mesh.points[inside, :2] += 10.0
    elif start == "random":
        mesh.points[inside, :2] = rng.uniform(-1, 1, (len(inside), 2))
    else:  # all vertices of a side at one point, and not even on the side
        for loop in mesh.boundary_loops():
            ends = np.flatnonzero(mesh.geometric()[loop])
            for a, b in itertools.pairwise(ends.tolist()):
                chain = loop[a : b + 1]
                mesh.points[chain[1:-1]] = mesh.points[chain].mean(axis=0) + [0.1, 0.1, 0]
    found = untangled(mesh)
    assert len(found.inverted) == 0
    assert quality.scaled_jacobian(mesh).min() > 1e-3


def test_the_same_input_gives_the_same_output():
    mesh = meshing.mesh_domain(gallery.shape("gear"), "quad")
    mesh.points[~mesh.boundary(), :2] = 0.1
    first, second = untangling.untangle(mesh), untangling.untangle(mesh)
    assert first.positions.tobytes() == second.positions.tobytes()


def test_untangling_moves_only_what_it_may():
    mesh = meshing.grid("quad", 100)
    middle = np.flatnonzero(~mesh.boundary())
    near = middle[np.linalg.norm(mesh.points[middle] - [0.5, 0.5, 0], axis=1) < 0.25]
    mesh.points[near] = [0.9, 0.5, 0]
    found = untangled(mesh, near)
    assert set(found.vertices) <= set(near)
    assert len(found.inverted) == 0


def test_a_single_quad_at_a_reflex_corner_is_unfixable():
    points = np.array([[0, 0], [2, 0], [0.5, 0.5], [0, 2]])
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 2, 3]])
    found = untangling.untangle(mesh)
    assert found.inverted.tolist() == found.unfixable.tolist() == [0]


def test_a_flat_boundary_vertex_is_unfixable_and_the_rest_is_untangled():
    mesh = meshing.grid("quad", 64)
    slides = np.flatnonzero((mesh.points[:, 1] == 0) & ~mesh.geometric())
    vertex = int(slides[len(slides) // 2])
    # a flip takes the only edge inwards from a boundary vertex: three corners on one line
    done = False
    for h in mesh.outgoing(vertex):
        for name in ("flip_left", "flip_right"):
            if not done and mesh.check(name, h):
                mesh.apply(name, h)
                done = len(mesh.neighbours(vertex)) == 2
                if not done:
                    mesh.undo()
    assert done
    inside = ~mesh.boundary()
    mesh.points[inside, :2] = np.random.default_rng(0).random((inside.sum(), 2))
    found = untangled(mesh)
    flat = mesh.element_of(mesh.outgoing(vertex)[0])
    assert found.inverted.tolist() == found.unfixable.tolist() == [flat]
    assert unfixable(mesh).tolist() == [flat]


def test_a_doublet_is_unfixable():
    points = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [1.5, 0.5]])
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 2, 4], [0, 4, 2, 3]])
    found = untangling.untangle(mesh)
    assert set(found.inverted) <= {0, 1}
    assert found.unfixable.tolist() == found.inverted.tolist()


@pytest.mark.parametrize("pieces", [9, 32, 100])
@pytest.mark.parametrize("turn", [0.0, 0.013])
def test_boundary_vertices_of_one_quad_find_the_bends_of_a_circle(pieces, turn):
    # 2 x 2 quads whose outline is a polygon of so many pieces, none of its points geometric
    angle = 2 * np.pi * np.arange(pieces) / pieces
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    boundary_vertices = [0, 1, 2, 5, 8, 7, 6, 3]
    quads = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]]
    angle = 2 * np.pi * np.arange(8) / 8 + turn
    points = np.zeros((9, 2))
    points[boundary_vertices] = 0.9 * np.column_stack([np.cos(angle), np.sin(angle)])
    boundary = boundary_of([[Curve.polyline(np.vstack([circle, circle[:1]]))]])
    mesh = curved_mesh(points, quads, boundary, [boundary_vertices], [])
    assert len(untangled(mesh).inverted) == 0


def test_a_circle_seen_from_outside_is_unfixable_for_a_single_quad():
    mesh = meshing.mesh_domain(gallery.shape("annulus"), "tri")
    inner = min(mesh.boundary_loops(), key=len)
    assert not unfixable_corners(movable_part.whole(mesh)).any()
    h = next(
        h
        for a, b in zip(inner, np.roll(inner, -1), strict=True)
        for h in [mesh.next(mesh.halfedge(int(a), int(b)))]
        if mesh.check("flip", h)
    )
    mesh.apply("flip", h)
    assert len(unfixable(mesh)) == len(untangling.untangle(mesh).inverted)


def test_locked_vertices_stay():
    mesh = meshing.mesh_domain(gallery.shape("star"), "quad")
    inside = int(np.flatnonzero(~mesh.boundary())[0])
    mesh.set_locked(inside)
    before = mesh.points[inside].copy()
    others = np.flatnonzero(~mesh.boundary())[1:]
    mesh.points[others] = before
    found = untangled(mesh)
    assert inside not in found.vertices
    assert len(found.inverted) == 0


def test_a_tilted_plane_is_untangled_in_its_plane():
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    flat = meshing.mesh_domain(gallery.shape("l-shape"), "quad")
    mesh = HalfEdgeMesh.from_elements(flat.points @ turn.T + 3.0, flat.elements(), flat.geometric())
    mesh.points[~mesh.boundary()] = mesh.points[0]
    assert len(untangled(mesh).inverted) == 0
    assert np.abs(((mesh.points - 3.0) @ turn)[:, 2]).max() < 1e-9


def test_a_curved_surface_is_not_changed():
    mesh = meshing.grid("quad", 16)
    mesh.points[:, 2] = mesh.points[:, 0] ** 2
    found = untangling.untangle(mesh)
    assert len(found.vertices) == 0
    assert found.starts == 0


def test_ten_thousand_elements_in_seconds():
    mesh = meshing.grid("quad", 10_000)
    inside = ~mesh.boundary()
    mesh.points[inside, :2] = np.random.default_rng(0).random((inside.sum(), 2))
    begin = time.perf_counter()
    found = untangling.untangle(mesh)
    assert len(found.inverted) == 0
    assert time.perf_counter() - begin < 10.0
