"""Patches of a large mesh, improved as separate meshes, and their operations in the large mesh."""

import numpy as np
import pytest

from meshwright_agent.env.task import Task
from meshwright_agent.env.vector_env import stack
from meshwright_agent.policy import policy_files
from meshwright_agent.policy.policy_files import PolicyError
from meshwright_agent.search.patch_extraction import (
    MOST_TAKEN,
    Edits,
    cut_out,
    next_patch,
    put_back,
)
from meshwright_agent.search.patchwise import improve_large, is_large
from meshwright_agent.search.repair_queue import FILL, agenda, dequeue, enlarged, enlist
from meshwright_agent.search.solver import solve
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import JOURNALLING, STEP_COLUMNS, allocate
from meshwright_core.core.mesh_boundary import MeshBoundary
from meshwright_core.domains import meshing
from meshwright_core.domains.elements import quadrangulation
from meshwright_core.operations.catalogue import CODES, NAMES, score_change

pytestmark = pytest.mark.slow


def scrambled(kind, levels, seed=0):
    rng = np.random.default_rng(seed)
    if kind == "tri":
        mesh = meshing.grid("tri", 6 * 4**levels)
    else:
        points, quads, geometric = meshing.benchmark_arrays("quad", 9, rng)
        for _ in range(levels):
            points, quads, geometric = quadrangulation.catmull_clark(points, [quads], geometric)
        mesh = HalfEdgeMesh.from_elements(points, quads, geometric)
    names = list(CODES[mesh.k])[: 3 if kind == "tri" else 4]
    wanted = mesh.n_elements // 5
    while wanted:
        ids = mesh.element_ids()
        h = int(rng.choice(ids)) * mesh.k + int(rng.integers(mesh.k))
        name = names[int(rng.integers(len(names)))]
        if mesh.check(name, h):
            mesh.apply(name, h)
            wanted -= 1
    mesh.compact()
    return mesh


@pytest.fixture(scope="module")
def quads():
    return scrambled("quad", 2)


@pytest.fixture(scope="module")
def policy():
    return policy_files.load(policy_files.shipped("quad")[0])


def replayed(mesh, run):
    copy = mesh.copy()
    for operation, h in run.steps():
        copy.apply(operation, h)
    return copy


def patches_of(mesh, sizes=(40, 80)):
    """All patches that can be cut out at the same time, with their elements and vertices."""
    arrays, k = mesh.arrays, mesh.k
    a = agenda(len(arrays.vertex), len(arrays.element_mark))
    enlist(a, arrays.irregular[: mesh.irregular_count].copy())
    found, ids = np.zeros(512, np.int64), np.zeros(2048, np.int64)
    patches, tries = [], int(a.state[FILL])
    while True:
        count, tries, _ = next_patch(arrays, a, *sizes, 3, len(patches) + 1, tries, found)
        if count == 0:
            break
        out = allocate(k, count * k, count, 1, 1)
        vertices = cut_out(arrays, a, k, found[:count], k == 4, out, ids)
        patches.append(
            (HalfEdgeMesh(out, MeshBoundary()), found[:count].copy(), ids[:vertices].copy())
        )
    assert not a.place.any() and not a.number.any()
    return patches


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_patches_are_meshes_with_the_delta_of_the_large_one(kind):
    mesh = scrambled(kind, 2)
    patches = patches_of(mesh)
    assert len(patches) > 2
    vertices = np.concatenate([ids for _, _, ids in patches])
    assert len(np.unique(vertices)) == len(vertices)
    for patch, elements, ids in patches:
        patch.validate()
        assert (ids[patch.elements()] == mesh.elements()[elements]).all()
        assert (patch.irregularity() == mesh.irregularity()[ids]).all()
        shared = np.isin(ids, np.delete(mesh.elements(), elements, axis=0))
        assert patch.locked()[shared].all() and patch.boundary()[shared].all()


def gains(mesh, codes):
    """Some operations inside a mesh that lower s, done on it one after another."""
    done = []
    for _ in range(30):
        better = (
            (code, h)
            for h in range(mesh.k * mesh.n_elements)
            for code in codes
            if mesh.live(h) and mesh.twin(h) >= 0 and mesh.check(NAMES[code], h)
            if score_change(mesh.arrays, code, h) < 0
        )
        step = next(better, None)
        if step is None:
            break
        mesh.apply(NAMES[step[0]], step[1])
        done.append(step)
    return done


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_operations_on_patches_are_applied_to_the_mesh(kind):
    mesh = scrambled(kind, 2)
    before = mesh.copy()
    patches = patches_of(mesh)
    pool = stack([patch for patch, _, _ in patches], Task(kind))
    codes = list(CODES[mesh.k].values())[: 3 if kind == "tri" else 4]
    start = sum(patch.score for patch, _, _ in patches)
    played = [gains(patch, codes) for patch, _, _ in patches]
    fallen = start - sum(patch.score for patch, _, _ in patches)
    counts = np.array([len(steps) + 1 for steps in played])
    record = np.full((2, counts.max(), len(patches)), codes[0])
    record[1] = 0
    for b, steps in enumerate(played):
        record[:, : len(steps), b] = np.array(steps).reshape(-1, 2).T
        # a last one that raises s, or is refused, must not be kept
        record[:, len(steps), b] = codes[-2], record[1, 0, b]
    elements = np.full((len(patches), pool.element_mark.shape[1]), -1, np.int64)
    for row, (_, ids, _) in zip(elements, patches, strict=True):
        row[: len(ids)] = ids
    done = np.zeros((2, int(counts.sum())), np.int64)
    mesh.reserve(500, 500)
    mesh.arrays.counters[JOURNALLING] = 0
    work = mesh.arrays._replace(
        journal=np.zeros((20_000, 2), np.int64), steps=np.zeros((100, STEP_COLUMNS), np.int64)
    )
    total = put_back(
        work, pool, 0, elements, Edits(record[0], record[1]), counts,
        np.zeros((2, MOST_TAKEN), np.int64), Edits(done[0], done[1]),
    )  # fmt: skip
    assert counts.tolist() == [len(steps) for steps in played] and total == counts.sum() > 0
    mesh.validate()
    assert mesh.score == before.score - fallen
    for code, h in done[:, :total].T.tolist():
        before.apply(NAMES[code], h)
    assert (before.elements() == mesh.elements()).all()


def test_the_queue_keeps_its_order_when_the_mesh_grows():
    a = agenda(6, 4)
    enlist(a, np.array([3, 1, 4, 1, 5]))
    assert [dequeue(a) for _ in range(2)] == [3, 1]
    enlist(a, np.array([0, 1, 2]))
    a = enlarged(a, 9, 8)
    enlist(a, np.array([8, 4]))
    assert [dequeue(a) for _ in range(int(a.state[FILL]))] == [4, 5, 0, 1, 2, 8]
    assert not a.queued.any()


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_a_scrambled_mesh_is_improved_by_operations_that_replay(kind):
    mesh = scrambled(kind, 2)
    reported = []
    run = improve_large(
        mesh,
        policy_files.load(kind),
        max_steps=130,
        progress=lambda *values: reported.append(values),
    )
    run.mesh.validate()
    after = replayed(mesh, run)
    after.validate()
    assert (after.elements() == run.mesh.elements()).all()
    assert after.score == run.score and run.optimum == mesh.optimum
    assert run.start_score - run.score > 0.6 * (run.start_score - run.optimum)
    assert run.removed > 0.6 and 0 < run.descent < len(run.operations)
    assert [s for _, s in reported] == sorted((s for _, s in reported), reverse=True)
    assert reported[-1] == (len(run.operations), run.score)


def test_the_seed_determines_the_result(quads, policy):
    runs = [improve_large(quads, policy, max_steps=40, seed=seed) for seed in (1, 1, 2)]
    assert (runs[0].halfedges == runs[1].halfedges).all()
    assert runs[0].halfedges.tolist() != runs[2].halfedges.tolist()


def test_a_run_stops_when_it_is_cancelled_or_out_of_time(quads, policy):
    calls = []

    def cancelled():
        calls.append(0)
        return len(calls) > 12

    run = improve_large(quads, policy, cancelled=cancelled)
    assert run.reason == "cancelled" and run.score < quads.score
    assert replayed(quads, run).score == run.score
    assert improve_large(quads, policy, seconds=0.0).score == quads.score
    assert improve_large(quads, policy, max_steps=0).decisions == 0


def test_a_policy_of_the_other_kind_is_refused(quads):
    with pytest.raises(PolicyError, match="the mesh is of quads"):
        improve_large(quads, policy_files.load("tri"))


def test_a_regular_mesh_is_left_as_it_is(policy):
    mesh = meshing.grid("quad", 100)
    run = improve_large(mesh, policy)
    assert (len(run.operations), run.removed, run.reason) == (0, 0.0, "at the optimum")


def test_the_solver_improves_very_irregular_meshes_patch_by_patch(quads, policy, monkeypatch):
    monkeypatch.setattr("meshwright_agent.search.patchwise.MANY", 100)
    few = meshing.benchmark_mesh("quad", 50, np.random.default_rng(0))
    assert is_large(quads) and not is_large(few)
    reported = []
    found = solve(quads, policy, max_steps=130, progress=lambda *values: reported.append(values[1]))
    copy = quads.copy()
    for operation, h in found.operations:
        copy.apply(operation, h)
    assert found.method == "patches"
    assert (copy.score, copy.n_elements) == (found.score, found.elements)
    assert quads.score - found.score > 0.6 * (quads.score - quads.optimum)
    assert reported == sorted(reported, reverse=True)
