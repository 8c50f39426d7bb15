import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry.outline import Outline
from meshwright_core.geometry.sides import Sides, in_order


def grid(n=4):
    return meshing.grid("quad", n * n)


def disc():
    return meshing.mesh_domain(gallery.shape("disc"), "quad")


def test_a_square_has_four_straight_sides():
    mesh = grid()
    sides = Sides(mesh)
    assert [len(chain) for chain in sides.chains] == [5] * 4
    assert np.diff(sides.polylines.first).tolist() == [2] * 4
    assert not sides.polylines.closed.any()
    for number in range(4):
        assert sides.length(number) == pytest.approx(1.0)
        assert sides.parameters(number) == pytest.approx([0, 0.25, 0.5, 0.75, 1])


def test_projection_to_the_own_side():
    mesh = grid()
    sides = Sides(mesh)
    vertex = int(np.flatnonzero((mesh.points[:, 1] == 0) & (mesh.points[:, 0] == 0.5))[0])
    point, t = sides.project(vertex, np.array([0.3, 0.9, 0.0]))
    assert point.tolist() == [0.3, 0.0, 0.0]
    number, place = sides.seat(vertex)
    assert sides.chains[number][place] == vertex
    assert t == pytest.approx(0.3)


def test_only_sliding_boundary_vertices_have_a_seat():
    mesh = grid()
    sides = Sides(mesh)
    inside = int(np.flatnonzero(~mesh.boundary())[0])
    corner = int(np.flatnonzero(mesh.geometric())[0])
    assert inside not in sides
    assert corner not in sides
    with pytest.raises(MeshError, match="slides on none"):
        sides.seat(inside)


def test_some_sides_are_those_of_all():
    mesh = meshing.mesh_domain(gallery.shape("plate-with-holes"), "quad")
    everything = Sides(mesh)
    for vertex in np.flatnonzero(mesh.boundary() & ~mesh.geometric()).tolist():
        own = Sides(mesh, [vertex])
        point = mesh.points[vertex] + 0.01
        there, _ = everything.project(vertex, point)
        assert own.project(vertex, point)[0] == pytest.approx(there, abs=1e-12)
        chain = everything.chains[everything.seat(vertex)[0]].tolist()
        assert sorted(own.chains[0].tolist()) == sorted(chain)


def test_a_loop_without_corners_is_one_closed_side():
    mesh = disc()
    sides = Sides(mesh)
    assert len(sides.chains) == 1
    assert sides.polylines.closed.tolist() == [True]
    t = sides.parameters(0)
    assert (np.diff(t) > 0).all()
    assert t[-1] - t[0] < sides.length(0)


def test_vertices_that_came_by_editing_are_on_the_side():
    mesh = grid()
    h = next(h for h in range(64) if mesh.check("global_split", h))
    new = [v for v in mesh.apply("global_split", h).new_vertices if mesh.is_boundary(v)]
    assert len(new) == 2
    sides = Sides(mesh)
    assert sum(len(chain) - 1 for chain in sides.chains) == len(mesh.boundary_loops()[0])
    for v in new:
        point, _ = sides.project(v, mesh.points[v])
        assert point == pytest.approx(mesh.points[v], abs=1e-12)


def test_a_vertex_made_geometric_divides_its_side():
    mesh = grid()
    vertex = int(np.flatnonzero((mesh.points[:, 1] == 0) & (mesh.points[:, 0] == 0.5))[0])
    mesh.set_geometric(vertex)
    sides = Sides(mesh)
    assert sorted(round(sides.length(i), 12) for i in range(5)) == [0.5, 0.5, 1, 1, 1]
    # on a curve both parts follow it
    mesh = disc()
    loop = mesh.boundary_loops()[0]
    whole = Sides(mesh).length(0)
    for vertex in (loop[0], loop[5]):
        mesh.set_geometric(int(vertex))
    sides = Sides(mesh)
    assert len(sides.chains) == 2
    assert sides.length(0) + sides.length(1) == pytest.approx(whole)


def test_one_corner_makes_one_open_side_around_the_loop():
    mesh = disc()
    loop = mesh.boundary_loops()[0]
    mesh.set_geometric(int(loop[3]))
    for sides in (Sides(mesh), Sides(mesh, [int(loop[4])])):
        assert len(sides.chains) == 1
        assert not sides.polylines.closed[0]
        assert sides.chains[0][0] == sides.chains[0][-1] == loop[3]


def test_a_corner_dragged_by_hand_takes_its_sides_along():
    mesh = grid()
    corner = int(np.flatnonzero((mesh.points == [1, 1, 0]).all(axis=1))[0])
    mesh.move([corner], [[1.5, 1.7, 0.0]])
    sides = Sides(mesh)
    ends = [tuple(sides.polylines.points[i]) for i in sides.polylines.first[:-1]]
    assert (1.5, 1.7, 0.0) in ends
    assert np.diff(sides.polylines.first).tolist() == [2] * 4


def test_ids_of_the_outline_follow_compact():
    mesh = grid()
    before = Outline.of(mesh)
    assert Outline.of(mesh) is before
    mesh.apply("collapse", 4 * 5)
    mesh.compact()
    assert Outline.of(mesh) is not before
    assert np.diff(Sides(mesh).polylines.first).tolist() == [2] * 4


@pytest.mark.parametrize(
    "values", [[0, 0, 0, 0, 1], [0, 0.6, 0.5, 0.4, 1], [0, 2, 2, 2, 1], [0, -3, 0.1, 0.9, 1]]
)
def test_order_is_restored(values):
    ordered = in_order(np.array(values, float), 1.0)
    assert (np.diff(ordered) > 0).all()
    assert ordered[[0, -1]].tolist() == [0.0, 1.0]


def test_values_in_order_are_kept_to_the_bit():
    values = np.array([0.0, 0.1, 0.30000000000000004, 1.0])
    assert in_order(values, 1.0) is values


def test_all_vertices_of_a_circle_at_one_point_are_spread():
    mesh = disc()
    loop = mesh.boundary_loops()[0]
    mesh.points[loop] = mesh.points[loop[0]]
    t = Sides(mesh).parameters(0)
    assert (np.diff(t) > 0).all()
    assert t[-1] - t[0] < Sides(mesh).length(0)


def test_without_an_outline_nothing_slides():
    mesh = HalfEdgeMesh.from_elements(grid().points, grid().elements(), np.zeros(25, bool))
    mesh.outline = []
    with pytest.raises(MeshError, match="no outline"):
        Sides(mesh)
