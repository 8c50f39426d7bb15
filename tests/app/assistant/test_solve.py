"""``meshwright.solve``: one call from a source to a better mesh."""

import numpy as np
import pytest

import meshwright as mw
from meshwright_core import MeshError


@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_solve_improves_a_copy(kind):
    mesh = mw.mesh("star", kind)
    points, score = mesh.points.copy(), mesh.score
    solved = mw.solve(mesh, seconds=1.0, seed=3)
    assert np.array_equal(mesh.points, points) and mesh.score == score == solved.score_before
    assert solved.score == solved.mesh.score < score
    assert solved.optimum == mesh.optimum
    assert solved.at_optimum == (solved.score == solved.optimum)
    assert 0.0 < solved.normalised_return <= 1.0
    assert solved.inverted == [] and solved.policy == kind and solved.seconds < 10.0
    for operation, halfedge in solved.operations:
        mesh.apply(operation, halfedge)
    assert mesh.score == solved.score
    solved.mesh.validate()


def test_solved_mesh_shows_itself():
    solved = mw.solve("square", seconds=0.1)
    data, _ = solved._repr_mimebundle_()
    assert data["text/plain"].startswith("SolvedMesh(") and "text/html" in data


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"mesh": "starr"}, "starr"),
        ({"mesh": "star", "seconds": 0}, "seconds is a number above 0, not 0"),
        ({"mesh": "star", "seconds": "long"}, "not 'long'"),
        ({"mesh": "star", "seed": -1}, "seed is a whole number of at least 0, not -1"),
        ({"mesh": "star", "policy": "tri"}, "this policy is for triangles, the mesh is of quads"),
        ({"mesh": "star", "policy": "nobody"}, "nobody: there is no such policy"),
    ],
)
def test_bad_arguments_are_one_sentence(arguments, words):
    with pytest.raises(MeshError, match=words) as caught:
        mw.solve(**arguments)
    assert str(caught.value)[-1] in ".?" and "\n" not in str(caught.value)
