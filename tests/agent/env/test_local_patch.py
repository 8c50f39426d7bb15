"""The convolution on a local patch gives the same embeddings as on the whole mesh."""

import numpy as np
import pytest
import torch

from meshwright_agent.env.local_patch import LARGEST, Patches, assemble, describe
from meshwright_agent.env.potential import field, forget, solve_potential
from meshwright_agent.env.task import Scratch, Task, look
from meshwright_agent.policy.network import Architecture, Block, PolicyNetwork
from meshwright_core.core.arrays import TWIN
from meshwright_core.domains.meshing import benchmark_mesh


def _whole(network, mesh):
    arrays, k = mesh.arrays, mesh.k
    count = k * mesh.n_elements
    features = np.zeros((count, network.task.channels), np.int8)
    solved = field(len(arrays.vertex))
    elements = solve_potential(arrays, k, np.array([-1]), solved)
    for h in range(count):
        describe(arrays, h, k, solved, features[h])
    forget(arrays, k, solved, elements)
    assert not solved.place_of.any()
    twins = torch.from_numpy(arrays.edge[:count, TWIN].astype(np.int64))
    return network.convolve_mesh(torch.from_numpy(features), twins)


def _local(network, mesh, chosen):
    task = network.task
    scratch = Scratch(task, len(mesh.arrays.edge), len(mesh.arrays.vertex))
    sizes = np.zeros((1, task.blocks + 1), np.int32)
    features = np.zeros((LARGEST, task.channels), np.int8)
    look(
        mesh.arrays,
        chosen,
        task.k,
        sizes[0],
        scratch.listed,
        scratch.reads,
        scratch.slot_of,
        scratch.field,
        features,
    )
    assert not scratch.slot_of.any()
    patches = Patches(features[: sizes[0, 0]], scratch.reads[: sizes[0, 1]], sizes)
    rows, tables = assemble(patches, np.array([0]))
    return network.convolve(torch.from_numpy(rows), [torch.from_numpy(t) for t in tables]), sizes[0]


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("blocks", [1, 3, 6])
def test_logits_of_the_patch_are_those_of_the_whole_mesh(kind, blocks):
    rng = np.random.default_rng(blocks)
    torch.manual_seed(blocks)
    network = PolicyNetwork(
        Task(kind, blocks=blocks, channels=6), Architecture(prior=False)
    ).double()
    torch.nn.init.normal_(network.head.weight)
    for block in network.blocks:
        torch.nn.init.normal_(block.beyond)
    network.embed.float()
    network = network.float()
    mesh = benchmark_mesh(kind, 14, rng)
    whole = network.head(_whole(network, mesh))
    chosen = rng.permutation(mesh.k * mesh.n_elements)[:9].astype(np.int64)
    chosen[4] = -1
    embedding, sizes = _local(network, mesh, chosen)
    real = chosen[chosen >= 0]
    assert sizes[-1] == len(real) and (np.diff(sizes) <= 0).all()
    torch.testing.assert_close(network.head(embedding), whole[real], rtol=1e-4, atol=1e-5)


def test_the_patch_of_one_half_edge_does_not_grow_with_the_mesh():
    rng = np.random.default_rng(0)
    network = PolicyNetwork(Task("quad", blocks=4), Architecture())
    sizes = []
    for sides in (40, 80):
        mesh = benchmark_mesh("quad", sides, rng)
        degree = mesh.degree()
        inner = next(
            h
            for h in range(4 * mesh.n_elements)
            if not mesh.is_boundary(mesh.origin(h)) and degree[mesh.origin(h)] == 4
        )
        sizes.append(_local(network, mesh, np.array([inner]))[1][0])
    assert max(sizes) <= 41  # half-edges within four steps, in a mesh without short cycles


def test_assembling_several_decisions_equals_assembling_each():
    rng = np.random.default_rng(3)
    torch.manual_seed(0)
    network = PolicyNetwork(Task("tri", blocks=3), Architecture())
    task = network.task
    parts, alone = [], []
    for sides in (10, 17, 12):
        mesh = benchmark_mesh("tri", sides, rng)
        chosen = rng.permutation(3 * mesh.n_elements)[:5].astype(np.int64)
        scratch = Scratch(task, len(mesh.arrays.edge), len(mesh.arrays.vertex))
        sizes = np.zeros((1, task.blocks + 1), np.int32)
        features = np.zeros((LARGEST, task.channels), np.int8)
        look(
            mesh.arrays,
            chosen,
            3,
            sizes[0],
            scratch.listed,
            scratch.reads,
            scratch.slot_of,
            scratch.field,
            features,
        )
        parts.append(Patches(features[: sizes[0, 0]], scratch.reads[: sizes[0, 1]].copy(), sizes))
        alone.append(_local(network, mesh, chosen)[0])
    rows, tables = assemble(Patches.join(parts), np.array([2, 0]))
    both = network.convolve(torch.from_numpy(rows), [torch.from_numpy(t) for t in tables])
    torch.testing.assert_close(both, torch.cat([alone[2], alone[0]]), rtol=1e-4, atol=1e-5)


def test_a_convolution_of_no_half_edges_has_no_rows():
    none = torch.zeros((0, 5), dtype=torch.long)
    assert Block(4, 3, 7)(torch.zeros((6, 3)), none).shape == (0, 7)
