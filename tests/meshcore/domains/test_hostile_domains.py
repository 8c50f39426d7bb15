"""Domains that would take hours or gigabytes: refused in a sentence, soon."""

import time

import numpy as np
import pytest

from meshwright_core.domains import meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.elements import triangle_process, triangulation
from meshwright_core.domains.loops import near_pairs
from meshwright_core.errors import MeshError
from meshwright_core.io import drawings

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
SECONDS = 2.0
"""Of this thread; Triangle has as much in a process of its own."""


def comb(teeth, width):
    """Teeth of height 1, as wide as the gaps between them."""
    x = 2.0 * width * np.arange(teeth)
    tooth = np.array([[0.0, 0.0], [0.0, 1.0], [width, 1.0], [width, 0.0]])
    points = (np.column_stack([x, 0.0 * x])[:, None] + tooth).reshape(-1, 2)
    return Domain(np.vstack([points, [[points[-1, 0], -0.5], [0.0, -0.5]]]))


def soon(work):
    """Run something; it must end within a few times its limit, by a mesh or a sentence."""
    began = time.thread_time()
    try:
        mesh = work()
    except MeshError as error:
        assert "\n" not in str(error)
        mesh = None
    assert time.thread_time() - began < 5.0 * SECONDS
    return mesh


def test_needle():
    notch = [[0, 0], [1, 0], [1, 1], [0.5 + 1e-9, 1], [0.5, 0.1], [0.5 - 1e-9, 1], [0, 1]]
    for kind in ("tri", "quad"):
        mesh = soon(lambda kind=kind: meshing.mesh_domain(Domain(notch), kind, seconds=SECONDS))
        assert mesh is not None
        mesh.validate()


def test_triangle_runs_in_a_process_of_its_own_where_points_nearly_coincide(monkeypatch):
    calls = []
    run = triangle_process.triangulate

    def counted(*given):
        calls.append(given)
        return run(*given)

    monkeypatch.setattr(triangle_process, "triangulate", counted)
    meshing.mesh_domain(Domain(SQUARE), "tri")
    meshing.mesh_domain(comb(1200, 0.1), "quad")  # many points, but apart
    assert not calls
    notch = [[0, 0], [1, 0], [1, 1], [0.5 + 1e-9, 1], [0.5, 0.1], [0.5 - 1e-9, 1], [0, 1]]
    meshing.mesh_domain(Domain(notch), "quad").validate()
    assert calls


def test_triangle_that_does_not_end_is_ended(monkeypatch):
    # a script that goes around for ever in place of Triangle
    loop = "import sys; sys.stdin.buffer.read()\nwhile True: pass\n"
    monkeypatch.setattr(triangle_process, "_WALL", 0.25)
    monkeypatch.setattr(triangle_process, "_COMMAND", ["-c", loop])
    with pytest.raises(MeshError, match="within the time limit") as error:
        meshing.mesh_domain(comb(3, 1e-7), "quad", seconds=1.0)
    assert "\n" not in str(error.value)


def test_teeth_without_end():
    assert soon(lambda: meshing.mesh_domain(comb(300, 1e-7), "quad", seconds=SECONDS)) is None


def test_points_inserted_are_bounded_by_the_time(monkeypatch):
    monkeypatch.setattr(triangulation, "_PER_SECOND", 0)
    with pytest.raises(MeshError, match="more than 2 s of processor time"):
        meshing.mesh_domain(Domain(SQUARE), "tri", 0.01, seconds=2.0)
    assert meshing.mesh_domain(Domain(SQUARE), "tri", 0.2, seconds=2.0).n_elements > 50


@pytest.mark.parametrize("height", [1.0, 1e-9])
def test_more_elements_than_are_made(height):
    thin = Domain([[0, 0], [1, 0], [1, height], [0, height]])
    for quads in ("catmull-clark", "pairing"):
        with pytest.raises(MeshError, match="would take about"):
            meshing.mesh_domain(thin, "quad", 1e-9, quads=quads)
    with pytest.raises(MeshError, match="would take about"):
        meshing.mesh_domain(thin, "tri", max_edge=1e-9)


def test_crossings_are_not_all_looked_for():
    points = np.random.default_rng(1).random((20_000, 2))
    began = time.thread_time()
    with pytest.raises(MeshError, match="crosses or touches itself"):
        Domain(points)
    assert time.thread_time() - began < 10.0


def test_too_many_pairs(monkeypatch):
    monkeypatch.setattr(near_pairs, "MOST_PAIRS", 1000)
    lines = near_pairs.shapely.linestrings(np.random.default_rng(1).random((300, 2, 2)))
    with pytest.raises(MeshError, match="Too many"):
        near_pairs.pairs_near(lines, "intersects")


def test_pairs_are_those_of_one_query(monkeypatch):
    lines = near_pairs.shapely.linestrings(np.random.default_rng(1).random((60, 2, 2)))
    reach = np.linspace(0.0, 0.1, 60)
    expected = near_pairs.shapely.STRtree(lines).query(lines, predicate="dwithin", distance=reach)
    monkeypatch.setattr(near_pairs, "_AT_ONCE", 500)
    found = near_pairs.pairs_near(lines, "dwithin", reach)
    assert {*zip(*found, strict=True)} == {*zip(*expected, strict=True)}


def test_nested_holes_are_named():
    holes = [[[-r, -r], [r, -r], [r, r], [-r, r]] for r in (1.0, 2.0, 0.5)]
    with pytest.raises(MeshError, match="Hole 0 lies inside hole 1"):
        Domain([[-3, -3], [3, -3], [3, 3], [-3, 3]], holes)
    with pytest.raises(MeshError, match="Hole 1 lies outside the outline"):
        Domain([[-3, -3], [3, -3], [3, 3], [-3, 3]], [holes[0], [[4, 4], [5, 4], [5, 5]]])


def test_a_drawing_that_takes_too_long(tmp_path):
    circles = "".join(f"0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n{1 + i * 3e-4}\n" for i in range(1500))
    path = tmp_path / "rings.dxf"
    path.write_text(f"0\nSECTION\n2\nENTITIES\n{circles}0\nENDSEC\n0\nEOF\n")
    with pytest.raises(MeshError, match=r"rings\.dxf: This takes more than 0\.2 s") as error:
        drawings.read_domain(path, seconds=0.2)
    assert "\n" not in str(error.value)
