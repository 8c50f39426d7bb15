"""Finds the interfaces of the regions of a mesh: chains of the edges between two of them."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from meshwright_core.core.mesh_boundary import Chain


def interface_chains(
    elements: np.ndarray, twin: np.ndarray, regions: np.ndarray
) -> tuple[list[Chain], np.ndarray]:
    """The chains of edges between two regions, the smaller region on the left, and the junctions.

    Args:
        elements: (m, k) vertex ids.
        twin: (m * k,) twin of each half-edge, -1 on the boundary.
        regions: (m,) region of each element.

    Returns:
        the chains, and the ids of the vertices where they end: on the boundary, and where other
        than two edges between the same two regions meet. If two chains would have the same ends
        and regions, they are cut at one more junction in the middle.
    """
    k = elements.shape[1]
    across = regions.repeat(k)
    other = np.where(twin >= 0, across[twin], across)
    edges = np.flatnonzero(across < other)
    if not len(edges):
        return [], np.zeros(0, np.int64)
    flat = elements.ravel()
    ahead = edges + 1 - k * ((edges + 1) % k == 0)
    start, end = flat[edges].tolist(), flat[ahead].tolist()
    pair = list(zip(across[edges].tolist(), other[edges].tolist(), strict=True))
    leaving: dict[int, list[int]] = defaultdict(list)
    met: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for i, (a, b) in enumerate(zip(start, end, strict=True)):
        leaving[a].append(i)
        met[a].append(pair[i])
        met[b].append(pair[i])
    on_boundary = set(flat[twin < 0].tolist())
    junctions = {
        v for v, pairs in met.items() if v in on_boundary or len(pairs) != 2 or len(set(pairs)) > 1
    }
    left = set(range(len(edges)))

    def walked(first: int) -> list[int]:
        chain, i = [start[first]], first
        while True:
            left.discard(i)
            chain.append(end[i])
            if end[i] in junctions or end[i] == chain[0]:
                return chain
            i = leaving[end[i]][0]

    chains = []
    for v in sorted(junctions):
        for i in leaving[v]:
            chains.append(Chain(np.array(walked(i)), False, *pair[i]))
    for i in range(len(edges)):
        if i not in left:
            continue
        chains.append(Chain(np.array(walked(i)[:-1]), True, *pair[i]))
    chains, more = _told_apart(chains)
    return chains, np.array(sorted(junctions | more), np.int64)


def _told_apart(chains: list[Chain]) -> tuple[list[Chain], set[int]]:
    """Chains of which no two lie between the same regions and junctions, and the added junctions.

    An edge between two junctions names its interface by them alone. Where two chains have the same
    ends, those of more than one edge are cut in the middle.
    """
    alike: dict[tuple[int, int, int, int], int] = defaultdict(int)
    for chain in chains:
        alike[_key(chain)] += 1
    apart, more = [], set()
    for chain in chains:
        line = chain.vertices
        if chain.closed or alike[_key(chain)] == 1 or len(line) < 3:
            apart.append(chain)
            continue
        middle = len(line) // 2
        more.add(int(line[middle]))
        apart.append(chain._replace(vertices=line[: middle + 1]))
        apart.append(chain._replace(vertices=line[middle:]))
    return apart, more


def _key(chain: Chain) -> tuple[int, int, int, int]:
    ends = (-1, -1) if chain.closed else (int(chain.vertices[0]), int(chain.vertices[-1]))
    return chain.left, chain.right, *ends
