"""Every level file holds a valid mesh, a goal, and a solution of par operations."""

import dataclasses
import json

import numpy as np
import pytest

from meshwright.benchmarks.levels import played
from meshwright.puzzles import level as levels
from meshwright_agent.search.exhaustive import fewest
from meshwright_core import HalfEdgeMesh, MeshError, Operation

LARGEST = 60


@pytest.fixture(params=levels.names())
def level(request):
    return levels.load(request.param)


def test_there_are_levels_of_both_kinds_from_one_operation_on():
    found = levels.all()
    assert len(found) >= 16
    assert [level.number for level in found] == list(range(1, len(found) + 1))
    assert len({level.title for level in found}) == len(found)
    assert found[0].par == 1
    assert {level.kind for level in found} == {"tri", "quad"}
    assert [levels.after(level.name) for level in found] == [*levels.names()[1:], None]


def test_levels_show_themselves_as_a_table():
    shelf = levels.all()
    assert repr(shelf).splitlines()[0].split() == [
        "one-flip", "One", "flip:", "24", "triangles,", "par", "1"
    ]  # fmt: skip
    table = shelf._repr_html_()
    assert table.count("<tr>") == len(shelf)
    assert "<code>star</code>" in table


def test_a_level_is_a_valid_mesh_that_is_not_at_its_goal(level):
    mesh = level.mesh()
    mesh.validate()
    assert mesh.kind == level.kind
    assert mesh.n_elements <= LARGEST
    assert level.goal == mesh.optimum
    assert not level.reached(mesh)
    assert 20 < len(level.text) < 260
    assert level.text.endswith((".", "?"))


def test_solutions_reach_the_goal_without_inverted_elements(level):
    assert played(level) == 0
    assert len(level.solution) == level.par


def test_par_is_proved_where_the_proof_is_quick(level):
    if not level.proved or level.par > 3:
        assert not fewest(level.mesh(), level.goal, level.most, deepest=2, slots=1 << 16).sequences
        return
    answer = fewest(level.mesh(), level.goal, level.most, slots=1 << 16)
    assert answer.proved == level.par - 1
    assert len(answer.sequences[0]) == level.par


def test_the_star_can_never_be_perfect():
    star = levels.load("star")
    assert (star.goal, star.mesh().optimum) == (4, 4)
    assert (star.par, star.proved) == (4, True)


def test_the_shortest_solution_is_found_even_if_the_score_rises():
    points = np.array([(i, j) for j in range(4) for i in range(5)], float)
    cells = np.array([(i, i + 1, i + 6, i + 5) for j in range(3) for i in range(5 * j, 5 * j + 4)])
    mesh = HalfEdgeMesh.from_elements(points, cells)
    start = mesh.score
    for operation, (a, b) in ((Operation.COLLAPSE, (6, 7)), (Operation.FLIP_LEFT, (3, 8))):
        mesh.apply(operation, mesh.halfedge(a, b))
    answer = fewest(mesh, start)
    assert answer.sequences
    assert answer.proved == len(answer.sequences[0]) - 1
    before = mesh.elements().copy()
    for way in answer.sequences:
        work = mesh.copy()
        for operation, halfedge in way:
            work.apply(operation, halfedge)
        assert work.score <= start
    assert (mesh.elements() == before).all()


def test_a_stopped_search_reports_its_result():
    level = levels.load("notch")
    answer = fewest(level.mesh(), level.goal, nodes=100, slots=1 << 12)
    assert answer.sequences == ()
    assert 1 <= answer.proved < level.par


def test_levels_are_read_as_they_are_written(level, tmp_path):
    path = tmp_path / f"{level.number:02d}-{level.name}.json"
    path.write_text(json.dumps(levels.record(level)))
    again = levels.read(path, level.number)
    assert again == level
    for one in ("points", "elements", "corners", "desired"):
        assert (getattr(again, one) == getattr(level, one)).all()


def broken(**changes):
    return {**levels.record(levels.load("one-flip")), **changes}


@pytest.mark.parametrize(
    ("contents", "why"),
    [
        ("", "no valid level"),
        ("[]", "expected object, got array"),
        ("[" * 100_000, "no valid level"),
        (broken(version=9), "version"),
        (broken(kind="hex"), "'kind' is wrong"),
        (broken(title=""), "'title' is wrong"),
        (broken(points=[[0, 0], [1]]), "'points[1]' is wrong: expected array of length 2"),
        (broken(points=[[0, True]]), "'points[0][1]' is wrong: expected float, got bool"),
        (broken(points=7), "'points' is wrong: expected array, got int"),
        (broken(elements=[[0, 1, 9999]]), "9999"),
        (
            broken(elements=[[0, 1, 2]] * 2000),
            "array of length <= 1000",
        ),
        (broken(corners=[-1]), "'corners[0]' is wrong: expected int >= 0"),
        (broken(corners=[9999]), "no vertex 9999"),
        (broken(elements=[[0, 1]]), "3 vertices in each row"),
        (broken(corners=["a"]), "'corners[0]' is wrong: expected int, got str"),
        (broken(desired=[6]), "'desired'"),
        (broken(goal=-1), "'goal'"),
        (broken(solution=[["flip", 0]]), "'solution[0]'"),
        (broken(solution=[["global_split", 0, 1]]), "'solution'"),
        (broken(solution=[["flip", 0, 18]]), "no half-edge"),
        (broken(solution=[]), "does not reach the goal"),
        (broken(par=2), "not as long as its par"),
    ],
)
def test_a_bad_file_is_refused_with_one_sentence(tmp_path, contents, why):
    path = tmp_path / "01-bad.json"
    path.write_text(contents if isinstance(contents, str) else json.dumps(contents))
    with pytest.raises(MeshError) as refused:
        levels.read(path)
    output = str(refused.value)
    assert why in output
    assert output.startswith(str(path))
    assert "\n" not in output


def test_an_unknown_name_is_refused_with_suggestions():
    with pytest.raises(MeshError, match="did you mean two-flips"):
        levels.load("two-flip")
    with pytest.raises(MeshError, match="there are one-flip"):
        levels.load("zzz")


def test_a_goal_may_limit_the_elements():
    level = levels.load("three-blocks")
    mesh = level.mesh()
    assert mesh.score == level.goal
    assert not level.reached(mesh)
    levels.play(mesh, level.solution)
    assert mesh.n_elements == level.most == 3
    assert dataclasses.replace(level, most=0).reached(level.mesh())
