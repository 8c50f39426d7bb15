"""The local patch of a decision: the half-edges that the convolution of section 4.2 reads.

One block of the convolution combines the features of the half-edges of an element and of the twin.
After B blocks the embeddings of the candidates therefore depend on the half-edges within B such
steps of them, and on no others: these form the patch. It is ordered so that the half-edges for
which block b must be computed are always a leading part of the list; a half-edge that several
candidates need is listed once. The cost of a decision does not depend on the size of the mesh.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_agent.env.potential import as_feature
from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    FLAGS,
    GEOMETRIC,
    ORIGIN,
    TWIN,
    on_boundary,
    preceding,
)
from meshwright_core.core.compilation import bare_kernel, kernel

CHANNELS = ("degree", "irregularity", "boundary", "geometric", "potential", "absolute potential")
"""The features of a half-edge, those of its vertex; the paper uses the first two. The last two are
computed by :mod:`meshwright_agent.env.potential`."""
POTENTIALS = 4
"""Number of channels before the potentials."""

LARGEST = 8192
"""Largest number of half-edges in a patch; candidates that lie far apart need more."""


@bare_kernel
def seen_vertex(m, h, k):
    """The vertex of a half-edge: opposite in a triangle, origin in a quad (section 3.1)."""
    return m.edge[preceding(h, k) if k == 3 else h, ORIGIN]


@bare_kernel
def _list_up(h, listed, count, slot_of):
    """List h unless it is listed already; returns the new count."""
    if h < 0 or slot_of[h] or count >= len(listed):
        return count
    listed[count] = h
    slot_of[h] = count + 1
    return count + 1


@bare_kernel
def list_patch(m, chosen, k, sizes, listed, reads, slot_of):
    """List the patch of the candidates `chosen` (K,), -1 for none.

    sizes (B+1,) receives the number of half-edges whose features are needed before block 1, 2,
    ..., B and after block B, so the length of the list comes first; listed (N,) the half-edges;
    reads (N, k+1), for all but the outermost, the positions in the list of h, next, ..., previous
    and twin (-1 beyond the boundary). slot_of: scratch, one entry for each half-edge of the mesh,
    zero before and after.
    """
    blocks = len(sizes) - 1
    count = 0
    for h in chosen:
        count = _list_up(h, listed, count, slot_of)
    sizes[blocks] = count
    done = 0
    for block in range(blocks - 1, -1, -1):
        inner = count
        for i in range(done, inner):
            first = listed[i] - listed[i] % k
            for h in range(first, first + k):
                count = _list_up(h, listed, count, slot_of)
            count = _list_up(m.edge[listed[i], TWIN], listed, count, slot_of)
        done = inner
        sizes[block] = count
    for i in range(done):
        h = listed[i]
        for j in range(k):
            reads[i, j] = slot_of[h - h % k + (h + j) % k] - 1
        t = m.edge[h, TWIN]
        reads[i, k] = slot_of[t] - 1 if t >= 0 else -1
    for i in range(count):
        slot_of[listed[i]] = 0


@bare_kernel
def describe(m, h, k, field, row):
    """Write the features of h into `row` (C,): the first C of CHANNELS.

    field: the solved potentials, needed if C includes them.
    """
    v = seen_vertex(m, h, k)
    row[0] = m.vertex[v, DEGREE]
    row[1] = m.vertex[v, DEGREE] - m.vertex[v, DESIRED]
    if len(row) > 2:
        row[2] = 1 if on_boundary(m, v) else 0
        row[3] = 1 if m.vertex[v, FLAGS] & GEOMETRIC else 0
    if len(row) > POTENTIALS:
        place = field.place_of[v] - 1
        row[4] = as_feature(field.value[place, 0]) if place >= 0 else 0
        row[5] = as_feature(field.value[place, 1]) if place >= 0 else 0


@dataclass
class Patches:
    """The patches of D decisions, concatenated."""

    features: np.ndarray
    """(N, C) int8: the channels of each listed half-edge."""
    reads: np.ndarray
    """(M, k+1) int16: for all but the outermost half-edges, positions within the list of the same
    decision."""
    sizes: np.ndarray
    """(D, B+1) int32, see :func:`list_patch`."""

    @classmethod
    def join(cls, parts: list[Patches]) -> Patches:
        """The decisions of all parts, in order."""
        return cls(
            np.concatenate([part.features for part in parts]),
            np.concatenate([part.reads for part in parts]),
            np.concatenate([part.sizes for part in parts]),
        )


@kernel
def _assemble(reads, sizes, read_starts, picked, level, beyond, out):
    """Convert the reads of one block to positions in the concatenated rows of the block before."""
    at = 0
    base = 0
    for d in picked:
        for i in range(sizes[d, level]):
            for j in range(reads.shape[1]):
                place = reads[read_starts[d] + i, j]
                out[at, j] = base + place if place >= 0 else beyond
            at += 1
        base += sizes[d, level - 1]


@kernel
def _copy_rows(features, sizes, starts, picked, out):
    at = 0
    for d in picked:
        for i in range(sizes[d, 0]):
            for column in range(out.shape[1]):
                out[at, column] = features[starts[d] + i, column]
            at += 1


def assemble(patches: Patches, picked: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """The network's input for the decisions `picked` (M,).

    Returns features (N, C) int8 and, for each block, reads (Q, k+1) int64 into the rows that the
    block before computed; the index after the last row stands for "beyond the boundary".
    """
    sizes = patches.sizes
    starts = np.concatenate([[0], np.cumsum(sizes[:, 0])])
    read_starts = np.concatenate([[0], np.cumsum(sizes[:, 1])])
    totals = sizes[picked].sum(axis=0)
    features = np.empty((int(totals[0]), patches.features.shape[1]), np.int8)
    _copy_rows(patches.features, sizes, starts, picked, features)
    tables = []
    for level in range(1, sizes.shape[1]):
        table = np.empty((int(totals[level]), patches.reads.shape[1]), np.int64)
        beyond = int(totals[level - 1])
        _assemble(patches.reads, sizes, read_starts, picked, level, beyond, table)
        tables.append(table)
    return features, tables
