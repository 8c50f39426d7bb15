"""Comparisons of policies, rows of the paper's tables, and widgets side by side."""

import subprocess
import sys
from itertools import combinations

import numpy as np
import pytest

from meshwright.document.document import Document
from meshwright.experiments import Comparison, compare, side_by_side, table_row
from meshwright.experiments.rollouts import best_of
from meshwright.sources import resolve
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.domains import gallery, meshing


@pytest.fixture(scope="module")
def mesh() -> HalfEdgeMesh:
    return meshing.mesh_domain(gallery.shape("l-shape"), "quad")


@pytest.fixture(scope="module")
def both(mesh: HalfEdgeMesh) -> Comparison:
    return compare(mesh, rollouts=4, seed=5)


def test_import_loads_no_heavy_libraries() -> None:
    code = (
        "import sys, meshwright.experiments;"
        "print([m for m in ('torch', 'matplotlib', 'qtpy', 'PIL', 'scipy.optimize') "
        "if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_rollouts_replay_to_their_scores(mesh: HalfEdgeMesh, both: Comparison) -> None:
    for runs in both.rollouts.values():
        assert len(runs) == 4
        for run in runs:
            played = mesh.copy()
            assert run.scores[0] == mesh.score and len(run.scores) == len(run.steps) + 1
            for step, score in zip(run.steps, run.scores[1:], strict=True):
                for operation, halfedge in step:
                    played.apply(operation, halfedge)
                assert played.score == score
            played.validate()
            assert played.optimum == run.optimum
            assert run.best == run.scores.min() == run.scores[run.decisions]


def test_mesh_is_unchanged_and_equal_seeds_give_equal_rollouts(mesh: HalfEdgeMesh) -> None:
    before = mesh.elements(), mesh.points.copy()
    one, two = (compare(mesh, ["quad-paper"], rollouts=3, seed=9) for _ in range(2))
    assert np.array_equal(before[0], mesh.elements()) and np.array_equal(before[1], mesh.points)
    for a, b in zip(one.rollouts["quad-paper"], two.rollouts["quad-paper"], strict=True):
        assert a.steps == b.steps and np.array_equal(a.scores, b.scores)


def test_rows_agree_with_the_rollouts(both: Comparison) -> None:
    for row in both.rows:
        returns = both.returns(row["policy"])
        best = both.best(row["policy"])
        assert all(isinstance(value, str | int | float) for value in row.values())
        assert row["single_mean"] == pytest.approx(returns.mean())
        assert row["single_std"] == pytest.approx(returns.std())
        assert row["best_return"] == returns.max() == best.normalised
        assert (row["best_score"], row["operations"]) == (best.best, best.decisions)
    assert len(both.rollout_rows) == 8
    assert [row["return"] for row in both.rollout_rows[:4]] == both.returns("quad").tolist()
    assert "quad-paper" in both.table() and repr(both) == both.table()


def test_best_of_k_is_the_mean_over_all_subsets(both: Comparison) -> None:
    values = np.array([0.5, 0.9, 0.9, 0.2, 1.0])
    for k in range(1, 6):
        largest = [max(some) for some in combinations(values, k)]
        assert best_of(values, k) == pytest.approx((np.mean(largest), np.std(largest)))
    assert both.best_of("quad", 4)[0] == both.returns("quad").max()
    curve = both.best_of_curve()
    assert curve.k.tolist() == [1, 2, 3, 4] and len(curve.rows) == 8
    assert curve.means["quad-paper"][1] == both.best_of("quad-paper", 2)[0]
    assert "best of k" in curve.to_svg()
    for k in (0, 5, 1.5, True):
        with pytest.raises(MeshError):
            both.best_of("quad", k)  # type: ignore[arg-type]


@pytest.mark.parametrize("steps", [1, 3, 12])
def test_steps_limit_the_decisions_of_a_rollout(mesh: HalfEdgeMesh, steps: int) -> None:
    found = compare(mesh, ["quad-paper"], rollouts=3, steps=steps)
    assert max(len(run.steps) for run in found.rollouts["quad-paper"]) <= steps


def test_the_film_goes_to_the_best_state(mesh: HalfEdgeMesh, both: Comparison) -> None:
    best = both.best("quad")
    film = both.film("quad")
    film.go_to(0)
    assert film.mesh.score == mesh.score
    film.go_to(len(film) - 1)
    assert film.mesh.score == best.best
    assert both.meshes["quad"].score == best.best
    assert both.document("quad-paper", 2).score == both.rollouts["quad-paper"][2].best


def test_rollouts_from_the_optimum_have_no_steps(both: Comparison) -> None:
    done = both.meshes["quad"]
    assert done.score == done.optimum
    found = compare(done, rollouts=2)
    assert found.returns("quad").tolist() == [1.0, 1.0]
    assert found.best("quad-paper").steps == ()
    assert "s 0" in found.to_svg()


def test_compare_takes_triangles_documents_and_names() -> None:
    triangles = Document(meshing.mesh_domain(gallery.shape("star"), "tri"))
    found = compare(triangles, "tri-paper", rollouts=2, steps=4)
    assert found.policies == ("tri-paper",)
    assert compare("square", "quad", rollouts=1, steps=1).start > 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"policies": ["quad", "none-such"]}, "there is no such policy file"),
        ({"policies": ["tri"]}, "this policy is for triangles"),
        ({"policies": []}, "no policy to compare"),
        ({"policies": ["quad", "quad"]}, "named twice"),
        ({"policies": [3]}, "named by text"),
        ({"rollouts": 0}, "rollouts is a whole number"),
        ({"rollouts": True}, "rollouts is a whole number"),
        ({"steps": 0}, "steps is a whole number"),
        ({"seed": -1}, "seed is a whole number"),
        ({"mesh": "l-shpe"}, "no shape named"),
        ({"mesh": None}, "nothing to show"),
        ({"mesh": Document()}, "no mesh here"),
        ({"mesh": 7}, "cannot be made of int"),
    ],
)
def test_wrong_arguments_are_refused_in_one_sentence(
    mesh: HalfEdgeMesh, arguments: dict[str, object], words: str
) -> None:
    with pytest.raises(MeshError, match=words) as caught:
        compare(**({"mesh": mesh, "rollouts": 1} | arguments))  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)


def test_unknown_rollouts_are_refused(both: Comparison) -> None:
    with pytest.raises(MeshError, match="no rollouts of 'tri'"):
        both.film("tri")
    with pytest.raises(MeshError, match="rollouts 0 to 3"):
        both.film("quad", 4)


def test_table_row_agrees_with_the_command_line() -> None:
    from meshwright_agent.evaluation.rollouts import evaluate
    from meshwright_agent.policy.policy_files import load

    row = table_row("quad-paper", (10, 20), meshes=4, rollouts=2, seed=3)
    measured = evaluate("quad", (10, 20), 4, 2, 3, load("quad-paper"))
    assert row.single == (measured["single_mean"], measured["single_std"])
    assert row.best == (measured["best_mean"], measured["best_std"])
    assert row.at_optimum == measured["at_optimum"] and row.paper == (0.98, 0.03)
    assert len(row.rows) == 8 and "best of 2" in repr(row) and "0.98" in repr(row)
    assert table_row("tri", (5, 5), meshes=3, rollouts=1).paper is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"policy": "none-such"}, "no such policy"),
        ({"sides": (2, 5)}, "Each of the sides is a whole number"),
        ({"sides": (9, 5)}, "the fewest and then the most"),
        ({"sides": 9}, "sides are two numbers"),
        ({"meshes": 0}, "meshes is a whole number"),
        ({"rollouts": 1.5}, "rollouts is a whole number"),
    ],
)
def test_wrong_arguments_of_a_table_row_are_refused(
    arguments: dict[str, object], words: str
) -> None:
    with pytest.raises(MeshError, match=words):
        table_row(**({"policy": "quad"} | arguments))  # type: ignore[arg-type]


def test_side_by_side_has_a_widget_for_each_best_rollout(both: Comparison) -> None:
    box = side_by_side(both, height=240)
    for name, column in zip(both.policies, box.children, strict=True):
        title, widget = column.children
        assert name in title.value
        assert widget.score == both.best(name).best
        assert len(widget.history) >= len(both.best(name).operations())
        assert widget.height == 240 and widget.assistant.policy == name
        widget.close()
    with pytest.raises(MeshError, match="make one by compare"):
        side_by_side([both])  # type: ignore[arg-type]
    with pytest.raises(MeshError, match="no rollouts of 'tri'"):
        side_by_side(both, ["tri"])


def test_default_policies_follow_the_kind_and_one_policy_is_enough(mesh: HalfEdgeMesh) -> None:
    from importlib.resources import files
    from pathlib import Path

    from meshwright_agent.policy import policy_files

    triangles = resolve.mesh("square", "tri")
    assert compare(triangles, rollouts=1).policies == ("tri", "tri-paper")
    assert compare(mesh, rollouts=1).policies == ("quad", "quad-paper")
    path = Path(str(files("meshwright_assets") / "policies" / "quad-paper.safetensors"))
    for one in (path, policy_files.load("quad-paper")):
        assert compare(mesh, one, rollouts=1).policies == ("quad-paper",)
    one = compare(mesh, "quad", rollouts=1)
    assert len(side_by_side(one, "quad").children) == 1
    with pytest.raises(MeshError, match="named by text, not by int"):
        compare(mesh, 3, rollouts=1)
