"""Wishes for a block grid: kept with the mesh, undone, stored, dropped with their edges."""

import json

import numpy as np
import pytest
from block_meshes import corner_blocks, two_regions

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.grid_plan import Grading, GridPlan, Wall
from meshwright_core.io import snapshot

PLAN = GridPlan(
    size=0.1, walls=(Wall("outline", 0.01, 1.3),), side_counts={"outline": 12},
    counts={(0, 1): 6}, gradings={(1, 0): Grading(0.02, 0.0, 1.1)},
)  # fmt: skip


def test_a_plan_is_a_step_of_the_history():
    mesh = corner_blocks()
    mesh.plan_grid(PLAN)
    mesh.plan_grid(PLAN)
    assert mesh.steps == 1
    assert mesh.grid_plan == PLAN
    mesh.undo()
    assert mesh.grid_plan.empty
    mesh.redo()
    assert mesh.grid_plan == PLAN
    assert mesh.copy().grid_plan == PLAN
    mesh.validate()


def test_a_plan_survives_json_and_damage_is_named():
    assert GridPlan.of_record(json.loads(json.dumps(PLAN.record()))) == PLAN
    assert GridPlan.of_record({}) == GridPlan()
    for damaged in (
        {"size": -1.0}, {"size": "x"}, {"divide": 0}, {"walls": [["a", 1.0]]}, {"sides": []},
        {"counts": [[0, 1, 0]]}, {"counts": [[0, -1, 3]]}, {"counts": 3},
        {"gradings": [[0, 1, 0.1, 0.1, 0.5]]}, {"walls": [["a", float("nan"), 1.2]]}, [],
    ):  # fmt: skip
        with pytest.raises(MeshError, match="wishes for a block grid are damaged"):
            GridPlan.of_record(damaged)


def test_snapshots_keep_the_plans_of_the_whole_history():
    mesh = two_regions()
    mesh.plan_grid(PLAN)
    mesh.plan_grid(GridPlan(divide=4))
    read = snapshot.from_arrays(snapshot.to_arrays(mesh))
    assert read.grid_plan == GridPlan(divide=4)
    read.undo()
    assert read.grid_plan == PLAN
    assert read.boundary_info.region_names == mesh.boundary_info.region_names
    read.undo()
    assert read.grid_plan.empty


def test_wishes_follow_renumbering_and_names():
    points = np.array([(9, 9), (0, 0), (1, 0), (1, 1), (0, 1)], float)
    mesh = HalfEdgeMesh.from_elements(points, [[1, 2, 3, 4]])
    mesh.plan_grid(GridPlan(counts={(1, 2): 5, (0, 3): 7}, gradings={(4, 3): Grading(0.1)}))
    mesh.compact()
    assert mesh.grid_plan == GridPlan(counts={(0, 1): 5}, gradings={(3, 2): Grading(0.1)})
    mesh.name_sides([mesh.halfedge(0, 1)], "wall")
    mesh.plan_grid(GridPlan(walls=(Wall("wall", 0.1),), side_counts={"wall": 3}))
    mesh.rename("wall", "floor")
    assert mesh.grid_plan == GridPlan(walls=(Wall("floor", 0.1),), side_counts={"floor": 3})
    mesh.rename("floor", "")
    assert mesh.grid_plan.empty


def test_wishes_of_a_chord_replace_each_other():
    plan = GridPlan().with_count([(3, 1), (2, 5)], 4).with_count([(1, 3)], 7)
    assert plan.counts == {(1, 3): 7, (2, 5): 4}
    assert plan.with_count([(1, 3), (5, 2)], None).empty
    graded = GridPlan().with_grading([(3, 1)], Grading(0.1)).with_grading([(1, 3)], Grading(0.2))
    assert graded.gradings == {(1, 3): Grading(0.2)}
    assert graded.with_grading([(3, 1)], None).empty
    assert graded.kept(lambda a, b: False).empty
    assert graded.kept(lambda a, b: True) is graded
