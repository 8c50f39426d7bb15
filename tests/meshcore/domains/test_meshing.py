"""Generated meshes: conforming, of the domain's area and topology, with all its corners."""

import itertools
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshwright_core import MeshError
from meshwright_core.domains import gallery, meshing, quadrangulation, triangulation
from meshwright_core.domains.domain import Domain

SQUARE = Domain([[0, 0], [1, 0], [1, 1], [0, 1]])
WAYS = [("tri", {}), ("quad", {}), ("quad", {"quads": "pairing"}), ("quad", {"max_edge": 0.2})]


def areas(points, elements):
    x, y = points[elements][..., 0], points[elements][..., 1]
    return 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)


def longest_edge(points, elements):
    sides = points[elements] - points[np.roll(elements, 1, axis=1)]
    return np.linalg.norm(sides, axis=2).max()


def assert_meshes(domain, mesh):
    mesh.validate()
    elements = mesh.elements()
    assert areas(mesh.points, elements).sum() == pytest.approx(domain.area)
    assert areas(mesh.points, elements).min() > 0
    assert mesh.euler == 1 - len(domain.holes)
    assert len(mesh.boundary_loops()) == 1 + len(domain.holes)
    flags = mesh.geometric()
    corners = [loop[marks] for loop, marks in zip(domain.loops, domain.loop_corners, strict=True)]
    expected = {tuple(corner) for corner in np.concatenate(corners).tolist()}
    assert {tuple(p) for p in mesh.points[: len(flags)][flags][:, :2].tolist()} == expected
    assert (mesh.boundary() | ~flags).all()
    straight = 4 if mesh.k == 3 else 3
    assert (mesh.desired()[mesh.boundary() & ~flags] == straight).all()


@pytest.mark.parametrize(("kind", "options"), WAYS)
@pytest.mark.parametrize("name", gallery.names())
def test_gallery(name, kind, options):
    domain = gallery.shape(name)
    mesh = meshing.mesh_domain(domain, kind, **options)
    assert mesh.kind == kind
    assert_meshes(domain, mesh)
    interior = np.flatnonzero(~mesh.boundary() & (mesh.degree() > 0))
    assert (mesh.degree()[interior] > 2).all()


@settings(max_examples=40, deadline=None)
@given(
    st.integers(3, 30),
    st.integers(0, 2**32 - 1),
    st.sampled_from(["tri", "quad"]),
    st.sampled_from([None, "small", "turned"]),
)
def test_random_polygons_with_a_hole(sides, seed, kind, hole):
    rng = np.random.default_rng(seed)
    outline = gallery.random_corners(sides, rng)
    ring = gallery.random_corners(5, rng) * {"small": 0.2, "turned": -0.2}.get(hole, 1)
    domain = Domain(outline, [ring] if hole else [])
    assert_meshes(domain, meshing.mesh_domain(domain, kind))


@settings(max_examples=25, deadline=None)
@given(st.integers(3, 30), st.integers(0, 2**32 - 1), st.floats(0.08, 1.0))
def test_no_edge_is_longer_than_asked_for(sides, seed, bound):
    domain = gallery.random_polygon(sides, np.random.default_rng(seed))
    for kind, quads in [("tri", "pairing"), ("quad", "catmull-clark"), ("quad", "pairing")]:
        points, elements, _ = meshing.mesh_arrays(domain, kind, max_edge=bound, quads=quads)
        assert longest_edge(points, elements) <= bound * (1 + 1e-12)


def test_default_triangles_keep_angle_and_edges():
    points, triangles, _ = meshing.mesh_arrays(SQUARE, "tri")
    corners = points[triangles]
    u, v = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    cosine = (u * v).sum(2) / np.linalg.norm(u, axis=2) / np.linalg.norm(v, axis=2)
    assert np.degrees(np.arccos(cosine)).min() >= 28.6
    assert longest_edge(points, triangles) <= 0.2 * SQUARE.diameter


def test_default_quads_of_straight_sides_add_no_points():
    points, quads, geometric = meshing.mesh_arrays(gallery.shape("star"), "quad")
    assert len(quads) == 3 * 8
    assert np.array_equal(points[:10], gallery.shape("star").outline)
    assert geometric.tolist() == [True] * 10 + [False] * (len(points) - 10)


def test_largest_area_is_kept():
    points, triangles, _ = meshing.mesh_arrays(SQUARE, "tri", max_edge=9, max_area=0.01)
    assert areas(points, triangles).max() <= 0.01


def test_scale_does_not_matter():
    small = Domain(SQUARE.outline * 2.0**-200)
    one = meshing.mesh_arrays(SQUARE, "tri", max_edge=0.1)
    other = meshing.mesh_arrays(small, "tri", max_edge=0.1 * 2.0**-200)
    assert np.array_equal(one[1], other[1])
    assert np.array_equal(one[0] * 2.0**-200, other[0])


def test_seed_makes_another_mesh_of_the_same_domain_and_repeats():
    domain = gallery.shape("polygon")
    plain = meshing.mesh_arrays(domain, "tri")
    turned = [meshing.mesh_arrays(domain, "tri", seed=seed) for seed in (3, 3, 4)]
    assert all(np.array_equal(a, b) for a, b in zip(*turned[:2], strict=True))
    assert any(len(turned[i][1]) != len(plain[1]) for i in (0, 2))
    assert_meshes(domain, meshing.mesh_domain(domain, "quad", seed=3))
    holes = gallery.shape("plate-with-holes")
    for seed in range(1, 9):
        assert_meshes(holes, meshing.mesh_domain(holes, "tri", seed=seed))


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ({"kind": "hex"}, "'hex'"),
        ({"kind": "tri", "max_edge": 0.0}, "longest edge must be a positive number"),
        ({"kind": "quad", "max_edge": -1.0}, "longest edge must be a positive number"),
        ({"kind": "tri", "max_edge": float("nan")}, "longest edge"),
        ({"kind": "tri", "max_area": -1.0}, "largest area"),
        ({"kind": "tri", "min_angle": 45.0}, "between 0 and 34"),
        ({"kind": "tri", "max_edge": 1e-6}, "no more than 4,000,000"),
        ({"kind": "quad", "quads": "paving"}, "'paving'"),
    ],
)
def test_bad_arguments(arguments, reason):
    with pytest.raises(MeshError, match=reason):
        meshing.mesh_domain(SQUARE, **arguments)


def test_mesh_that_would_grow_without_end_is_refused(monkeypatch):
    monkeypatch.setattr(triangulation, "MAX_TRIANGLES", 2000)
    thin = Domain([[0, 0], [1, 0], [1, 1e-5], [0, 1e-5]])
    with pytest.raises(MeshError, match="more than 2,000 triangles"):
        meshing.mesh_domain(thin, "tri")


@settings(max_examples=40, deadline=None)
@given(st.integers(3, 50), st.integers(0, 2**32 - 1), st.sampled_from(["tri", "quad"]))
def test_benchmark_mesh(sides, seed, kind):
    mesh = meshing.benchmark_mesh(kind, sides, np.random.default_rng(seed))
    domain = gallery.random_polygon(sides, np.random.default_rng(seed))
    assert mesh.geometric().sum() == sides
    assert mesh.euler == 1
    assert areas(mesh.points, mesh.elements()).sum() == pytest.approx(domain.area)
    if kind == "tri":
        assert longest_edge(mesh.points, mesh.elements()) <= 0.4
    else:
        assert mesh.n_elements == 3 * (sides - 2)


def test_benchmark_is_the_size_that_others_measured():
    for kind, sides, expected in [("tri", (10, 20), 54), ("quad", (10, 20), 39)]:
        rng = np.random.default_rng(1)
        sizes = [
            len(meshing.benchmark_arrays(kind, int(rng.integers(sides[0], sides[1] + 1)), rng)[1])
            for _ in range(200)
        ]
        assert np.mean(sizes) == pytest.approx(expected, rel=0.08)


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_benchmark_arrays_are_quick(kind):
    rng = np.random.default_rng(0)
    times = []
    for _ in range(30):
        start = time.perf_counter()
        meshing.benchmark_arrays(kind, 30, rng)
        times.append(time.perf_counter() - start)
    assert min(times) < 2e-3


@pytest.mark.parametrize("random", [False, True])
@pytest.mark.parametrize(("kind", "count"), [("tri", 800), ("quad", 400)])
def test_grid(kind, count, random):
    rng = np.random.default_rng(2) if random else None
    mesh = meshing.grid(kind, count, rng)
    assert_meshes(SQUARE, mesh)
    assert mesh.n_elements == count
    assert mesh.n_vertices == 21**2
    if kind == "quad":
        assert mesh.score == 0


def test_grid_of_few_elements():
    assert meshing.grid("quad", 1).n_elements == 1
    assert meshing.grid("tri", 1).n_elements == 2
    with pytest.raises(MeshError, match="at least one element"):
        meshing.grid("quad", 0)


def test_catmull_clark_counts_and_mixes():
    points = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0.5]], dtype=float)
    quad, triangle = np.array([[0, 1, 2, 3]]), np.array([[1, 4, 2]])
    geometric = np.array([1, 0, 0, 1, 1], bool)
    new, quads, flags = quadrangulation.catmull_clark(points, [quad, triangle], geometric)
    assert len(new) == 5 + 6 + 2
    assert len(quads) == 4 + 3
    assert flags.tolist() == geometric.tolist() + [False] * 8
    assert areas(new, quads).sum() == pytest.approx(1.5)
    assert areas(new, quads).min() > 0


def test_pairing_finds_a_perfect_matching():
    points, triangles, _ = meshing.grid_arrays("tri", 72, np.random.default_rng(1))
    quads, alone = quadrangulation.pair(points, triangles)
    assert len(quads) == 36
    assert len(alone) == 0
    assert areas(points, quads).sum() == pytest.approx(1.0)


def test_large_pairing_is_greedy_and_valid():
    points, triangles, _ = meshing.grid_arrays("tri", 1800, np.random.default_rng(1))
    quads, alone = quadrangulation.pair(points, triangles)
    assert 2 * len(quads) + len(alone) == 1800
    assert areas(points, quads).min() > 0
    assert len(quads) > 700


def test_pairing_joins_no_triangles_to_a_dart():
    points = np.array([[0, 0], [4, 0], [1, 1], [0, 4]], dtype=float)
    quads, alone = quadrangulation.pair(points, np.array([[0, 1, 2], [0, 2, 3]]))
    assert len(quads) == 0
    assert len(alone) == 2


def test_doublets_are_merged():
    # a 2 by 1 strip whose left square is cut into two darts through vertex 6
    points = np.array([[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [0.4, 0.5]], dtype=float)
    quads = np.array([[0, 1, 4, 6], [0, 6, 4, 3], [1, 2, 5, 4]])
    new, merged, flags = quadrangulation.without_doublets(points, quads, np.arange(7) < 6)
    assert len(new) == len(flags) == 6
    assert {frozenset(q) for q in merged.tolist()} == {
        frozenset({0, 1, 4, 3}),
        frozenset({1, 2, 5, 4}),
    }
    assert areas(new, merged).tolist() == [1.0, 1.0]


def test_triangle_is_deterministic():
    domains = [gallery.shape("gear"), gallery.shape("plate-with-holes")]
    runs = [
        [meshing.mesh_arrays(d, k)[1].tobytes() for d in domains for k in ("tri", "quad")]
        for _ in range(3)
    ]
    assert all(a == b for a, b in itertools.pairwise(runs))
