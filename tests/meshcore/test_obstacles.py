"""Obstacles to drawing: each kind on a tiny mesh, none where there is a drawing."""

import numpy as np
import pytest
from tiny_meshes import grid, ring

from meshcore import HalfEdgeMesh, generate, shapes, smoothing
from meshcore.obstacles import Obstacles

DART = [[0, 0], [1, -1], [0.4, 0], [1, 1]]
HALF_SQUARE = [[0, 0], [1, 0], [2, 0], [1, 1]]


def _count(mesh):
    return Obstacles(mesh).count(mesh)


@pytest.mark.parametrize("name", ["star", "l-shape", "square-with-hole", "annulus", "arch", "gear"])
@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_fresh_meshes_have_none(name, kind):
    assert _count(generate.mesh_domain(shapes.shape(name), kind)) == 0


def test_grids_and_rings_have_none():
    assert _count(grid(3, 2)) == 0
    assert _count(ring(8, 2)) == 0


@pytest.mark.parametrize(
    ("points", "elements", "count"),
    [
        pytest.param(HALF_SQUARE, [[0, 1, 2, 3]], 1, id="a flat vertex of one quad"),
        pytest.param(DART, [[0, 1, 2, 3]], 1, id="a reflex corner of one quad"),
        pytest.param(
            [[0, 0], [2, 0], [2, 2], [0, 2], [1, 1]],
            [[0, 1, 2, 4], [0, 4, 2, 3]],
            1,
            id="a doublet",
        ),
        pytest.param(
            HALF_SQUARE, [[0, 1, 2], [0, 2, 3]], 2, id="a flat vertex, and an edge along its side"
        ),
        pytest.param(
            DART,
            [[0, 1, 3], [1, 2, 3]],
            2,
            id="a reflex corner, and an edge that leaves the domain",
        ),
        pytest.param(DART, [[0, 1, 2], [0, 2, 3]], 0, id="a reflex corner of two triangles"),
    ],
)
def test_each_kind(points, elements, count):
    assert _count(HalfEdgeMesh.from_elements(points, elements)) == count


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_what_has_an_obstacle_stays_inverted(kind):
    rng = np.random.default_rng(3)
    mesh = generate.benchmark_mesh(kind, 8, rng)
    obstacles = Obstacles(mesh)
    seen = 0
    for _ in range(40):
        h = int(rng.choice(mesh.element_ids())) * mesh.k + int(rng.integers(mesh.k))
        allowed = [name for name, verdict in mesh.allowed(h).items() if verdict]
        if not allowed:
            continue
        mesh.apply(allowed[int(rng.integers(len(allowed)))], h)
        if obstacles.count(mesh):
            seen += 1
            assert len(smoothing.relax(mesh.copy()))
            mesh.undo()
    assert seen > 2
