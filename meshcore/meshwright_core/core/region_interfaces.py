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
        than two edges between the same two regions meet.
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
    return chains, np.array(sorted(junctions), np.int64)
