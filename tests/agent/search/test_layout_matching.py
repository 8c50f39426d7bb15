"""Vertices of equal layouts that differ in ids are matched, and an answer keeps its positions."""

import numpy as np
import pytest

from meshwright_agent.search.annealing import anneal
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.guarded_coarsening import Aims, Coarsener
from meshwright_agent.search.layout_matching import matched_vertices
from meshwright_agent.search.solution import Solution, judged
from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.quality import scaled_jacobian
from meshwright_core.mesh import HalfEdgeMesh


def renumbered(mesh: HalfEdgeMesh, seed: int) -> HalfEdgeMesh:
    """The same mesh; its elements come in another order and begin at other vertices."""
    rng = np.random.default_rng(seed)
    elements = [np.roll(e, int(rng.integers(4))) for e in rng.permutation(mesh.elements())]
    return HalfEdgeMesh.from_elements(
        mesh.points, np.array(elements), mesh.geometric(), mesh.desired()
    )


@pytest.fixture(scope="module")
def star():
    return mesh_domain(gallery.shape("star"), "quad")


def test_equal_layouts_are_matched(star):
    found = matched_vertices(star.arrays, renumbered(star, 1).arrays)
    assert found is not None
    own, other = found
    assert np.array_equal(own, other)
    assert sorted(own.tolist()) == star.vertices().tolist()


def test_different_layouts_are_not_matched(star):
    operations, _ = anneal(star, proposals=2000, seed=1)
    assert operations
    assert matched_vertices(star.arrays, replayed(star, operations).arrays) is None


def test_positions_given_are_never_made_worse():
    mesh = mesh_domain(gallery.shape("plate-with-round-hole"), "quad")
    coarsener = Coarsener(mesh, Aims(1.0, 1.0, 0.0, False), ceiling=1)
    placed = mesh.copy()
    placed.move(*coarsener.positions(coarsener.layout([])))
    solution = Solution([], mesh.score, mesh.optimum, 0)
    answer = judged(solution, mesh, placed=placed.arrays)
    assert answer.worst_scaled_jacobian >= scaled_jacobian(placed).min() - 1e-12
