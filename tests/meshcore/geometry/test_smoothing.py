import numpy as np
import pytest
from side_checks import assert_on_sides

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry import movable_part, quality, smoothing


def jittered(kind, elements, amount, seed=0):
    """A grid whose interior vertices have been shaken."""
    mesh = meshing.grid(kind, elements)
    inside = np.flatnonzero(~mesh.boundary())
    rng = np.random.default_rng(seed)
    mesh.points[inside, :2] += amount * rng.uniform(-1, 1, (len(inside), 2))
    return mesh


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("name", ["star", "l-shape", "disc", "plate-with-holes", "airfoil"])
def test_smoothing_makes_the_worst_no_worse_and_keeps_the_outline(kind, name):
    mesh = meshing.mesh_domain(gallery.shape(name), kind)
    corners = np.flatnonzero(mesh.geometric())
    before = mesh.points[corners].copy()
    worst = shape_of(movable_part.whole(mesh)).min()
    vertices, positions, parameters = smoothing.smooth(mesh)
    assert len(vertices)
    mesh.move(vertices, positions, parameters)
    assert mesh.points[corners].tobytes() == before.tobytes()
    assert len(quality.inverted(mesh)) == 0
    assert shape_of(movable_part.whole(mesh)).min() >= worst - 1e-12
    assert_on_sides(mesh)


def shape_of(part):
    stars = smoothing.stars_of(part)
    return np.array(
        [smoothing.true_shape(part.points, stars, e) for e in range(len(part.elements))]
    )


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("amount", [0.02, 0.1, 0.3])
def test_smoothing_never_inverts(kind, amount):
    for seed in range(5):
        mesh = jittered(kind, 60, amount, seed)
        before = set(quality.inverted(mesh).tolist())
        mesh.move(*smoothing.smooth(mesh, iterations=3))
        assert set(quality.inverted(mesh).tolist()) <= before


def test_averaging_folds_where_the_outline_is_not_convex():
    # a strip bent into a V: averages lie outside of it, across the inner corner
    u, v = (axis.ravel() for axis in np.meshgrid(np.linspace(-1, 1, 9), np.linspace(0, 1, 4)))
    points = np.column_stack([u, 4 * np.abs(u) + v])
    a = np.array([i + 9 * j for j in range(3) for i in range(8)])
    flags = np.zeros(36, bool)
    flags[[0, 4, 8, 27, 31, 35]] = True
    quads = np.column_stack([a, a + 1, a + 10, a + 9])
    mesh = HalfEdgeMesh.from_elements(points, quads, flags)
    assert len(quality.inverted(mesh)) == 0
    averaged, smoothed = mesh.copy(), mesh.copy()
    averaged.move(*smoothing.average(averaged))
    smoothed.move(*smoothing.smooth(smoothed))
    assert len(quality.inverted(averaged)) > 0
    assert len(quality.inverted(smoothed)) == 0
    assert_on_sides(averaged)


def test_locked_vertices_stay():
    mesh = jittered("quad", 36, 0.03)
    inside = int(np.flatnonzero(~mesh.boundary())[3])
    edge = int(np.flatnonzero(mesh.boundary() & ~mesh.geometric())[2])
    for v in (inside, edge):
        mesh.set_locked(v)
    before = mesh.points.copy()
    smoothing.relax(mesh)
    assert mesh.points[[inside, edge]].tobytes() == before[[inside, edge]].tobytes()
    assert (mesh.points != before).any()


def test_only_the_vertices_asked_for_move():
    mesh = jittered("tri", 200, 0.02)
    wanted = np.flatnonzero(~mesh.boundary())[:5]
    vertices, *_ = smoothing.smooth(mesh, wanted)
    assert set(vertices) <= set(wanted)
    with pytest.raises(MeshError, match="Vertex 100000 is not in the mesh"):
        smoothing.smooth(mesh, [100000])


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_relax_touches_only_what_is_near_and_is_one_step(kind):
    mesh = jittered(kind, 1600, 0.004)
    middle = int(np.argmin(np.linalg.norm(mesh.points - [0.5, 0.5, 0], axis=1)))
    operation = "flip" if kind == "tri" else "flip_left"
    edit = mesh.apply(operation, mesh.outgoing(middle)[0])
    before, steps = mesh.points.copy(), mesh.steps
    assert len(smoothing.relax(mesh, edit.touched)) == 0
    assert mesh.steps == steps + 1
    moved = np.flatnonzero((mesh.points != before).any(axis=1))
    assert 0 < len(moved) < 60
    assert set(moved) <= set(movable_part.rings(mesh, edit.touched, 2).tolist())
    assert mesh.undo()
    assert mesh.points.tobytes() == before.tobytes()


def test_relax_goes_further_where_two_rings_do_not_suffice():
    mesh = jittered("quad", 400, 0.005)
    x, y = mesh.points[:, 0], mesh.points[:, 1]
    # the middle of the mesh is folded over to the right
    middle = np.flatnonzero((abs(x - 0.5) < 0.2) & (abs(y - 0.5) < 0.2))
    mesh.points[middle, 0] = 1.0 - mesh.points[middle, 0]
    mesh.points[middle, 0] += 0.3
    assert len(quality.inverted(mesh)) > 20
    steps = mesh.steps
    assert len(smoothing.relax(mesh, middle[:1])) == 0
    assert len(quality.inverted(mesh)) == 0
    assert mesh.steps == steps + 1


def test_relax_of_a_large_mesh_untangles_it_in_one_step(monkeypatch):
    monkeypatch.setattr(smoothing, "WHOLE", 100)
    mesh = jittered("quad", 900, 0.0)
    inside = np.flatnonzero(~mesh.boundary())[::60]
    mesh.points[inside, :2] += 0.06
    assert len(quality.inverted(mesh)) > 10
    steps, before = mesh.steps, mesh.points.copy()
    assert len(smoothing.relax(mesh)) == 0
    assert len(quality.inverted(mesh)) == 0
    assert mesh.steps == steps + 1
    mesh.undo()
    assert mesh.points.tobytes() == before.tobytes()


def test_relax_after_every_operation_keeps_the_mesh_drawn():
    mesh = meshing.mesh_domain(gallery.shape("l-shape"), "tri", max_edge=0.4)
    rng = np.random.default_rng(1)
    corners = mesh.points[mesh.geometric()].copy()
    flags, done = mesh.geometric(), 0
    while done < 15:
        h = int(rng.choice(mesh.element_ids())) * 3 + int(rng.integers(3))
        if mesh.is_boundary(mesh.origin(h)) or not mesh.check("split", h):
            continue
        edit = mesh.apply("split", h)
        assert len(smoothing.relax(mesh, edit.touched)) == 0
        done += 1
    assert len(quality.inverted(mesh)) == 0
    assert mesh.points[: len(flags)][flags].tobytes() == corners.tobytes()
    assert_on_sides(mesh)


def test_a_surface_is_smoothed_in_its_tangent_planes():
    flat = meshing.grid("quad", 100, np.random.default_rng(0))
    points = flat.points.copy()
    points[:, 2] = 0.2 * np.sin(3 * points[:, 0])
    mesh = HalfEdgeMesh.from_elements(points, flat.elements(), flat.geometric())
    before = mesh.points.copy()
    assert len(smoothing.relax(mesh)) == 0
    assert (mesh.points != before).any()
    off = mesh.points[:, 2] - 0.2 * np.sin(3 * mesh.points[:, 0])
    assert np.abs(off).max() < 0.01
    assert len(smoothing.relax(mesh, [50])) == 0


def test_a_closed_surface_is_smoothed_without_errors():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    mesh = HalfEdgeMesh.from_elements(corners, faces)
    assert len(smoothing.relax(mesh)) == 0
    assert len(quality.inverted(mesh)) == 0


def test_relax_without_changes_adds_no_step():
    mesh = meshing.grid("quad", 4)
    steps = mesh.steps
    assert len(smoothing.relax(mesh, [])) == 0
    assert mesh.steps == steps
