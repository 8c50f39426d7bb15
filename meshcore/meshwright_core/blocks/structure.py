"""The block structure of a quad mesh: blocks, their edges on true curves, chords and patches.

Each quad of the mesh is a block, an image of a rectangle of cells. All block edges that lie across
from one another, a *chord*, are divided into the same number of cells; they are given the same
direction along the chord, so that a grading has one meaning for all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.analysis.element_division import chords
from meshwright_core.blocks.patches import Patch, boundary_patches
from meshwright_core.core.arrays import TWIN
from meshwright_core.errors import MeshError
from meshwright_core.geometry.edge_parts import EdgeParts

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

SAMPLES = 129
"""Points on a curved block edge from which its length is taken."""

SIDE_CORNERS = ((0, 1), (1, 2), (3, 2), (0, 3))
"""The corners of a block between which each side runs, in the direction of the block's axes: the
first axis runs along sides 0 and 2, the second one along sides 1 and 3."""


@dataclass(frozen=True, eq=False)
class BlockStructure:
    """b blocks, e block edges, c chords, n corners. Made by :meth:`of`; nothing in it changes."""

    mesh: HalfEdgeMesh
    """The quads."""
    vertices: np.ndarray
    """(n,) ids of the corners in the mesh."""
    points: np.ndarray
    """(n, 3) the corners."""
    corners: np.ndarray
    """(b, 4) the corners of each block, rows of `points`, counter-clockwise."""
    edges: np.ndarray
    """(e, 2) the corners at the start and the end of each edge, in the direction of its chord."""
    parts: EdgeParts
    """The edges on their curves, from start to end."""
    sides: np.ndarray
    """(b, 4) the edge of each side; side i of a block begins at its corner i."""
    forward: np.ndarray
    """(b, 4) whether the edge of each side runs in the direction of :data:`SIDE_CORNERS`."""
    chord: np.ndarray
    """(e,) the chord of each edge, numbered as by
    :func:`meshwright_core.analysis.element_division.chords`."""
    neighbours: np.ndarray
    """(e, 2) the block on the left and on the right of each edge, -1 on the boundary."""
    region: np.ndarray
    """(b,) the region of each block."""
    patches: tuple[Patch, ...]
    """The named sides of the boundary; each boundary edge is in one."""

    @classmethod
    def of(cls, mesh: HalfEdgeMesh) -> BlockStructure:
        """The blocks of a quad mesh. Raises MeshError for triangles and for a mesh of nothing."""
        if mesh.k != 4:
            raise MeshError("Only quad meshes have blocks.")
        ids = mesh.element_ids()
        if not len(ids):
            raise MeshError("The mesh has no quads, and so no blocks.")
        live = mesh.vertices()
        row_of = np.full(mesh.slots, -1, np.int64)
        row_of[live] = np.arange(len(live))
        halfedges = (4 * ids[:, None] + np.arange(4)).ravel()
        place = np.full(4 * (int(ids.max()) + 1), -1, np.int64)
        place[halfedges] = np.arange(len(halfedges))
        twin = mesh.arrays.edge[halfedges, TWIN].astype(np.int64)
        twin = np.where(twin >= 0, place[np.maximum(twin, 0)], -1)
        chord = np.tile(chords(mesh), 2).ravel()
        along = _directions(twin, chord)
        corners = row_of[mesh.elements()].astype(np.int64)
        # the half-edge of each edge with the lower number; the boundary has one only
        first = np.flatnonzero((twin < 0) | (twin > np.arange(len(twin))))
        edge_of = np.full(len(twin), -1, np.int64)
        edge_of[first] = np.arange(len(first))
        edge_of = np.where(edge_of >= 0, edge_of, edge_of[np.maximum(twin, 0)])
        ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
        parts = _directed(EdgeParts.of(mesh.arrays, halfedges[first], 4), along[first])
        edges = np.where(along[first, None], ends[first], ends[first, ::-1])
        block = np.arange(len(twin)) // 4
        other = np.where(twin[first] >= 0, block[np.maximum(twin[first], 0)], -1)
        neighbours = np.column_stack([block[first], other])
        neighbours = np.where(along[first, None], neighbours, neighbours[:, ::-1])
        # sides 2 and 3 of a block run against its axes
        forward = along.reshape(-1, 4) ^ np.array([False, False, True, True])
        outer = first[twin[first] < 0]
        return cls(
            mesh, live, mesh.points[live].copy(), corners, edges, parts, edge_of.reshape(-1, 4),
            forward, chord[first], neighbours, mesh.arrays.region[ids].astype(np.int64),
            boundary_patches(mesh, halfedges[outer], edge_of[outer]),
        )  # fmt: skip

    @property
    def region_names(self) -> tuple[str, ...]:
        """The name of each region; "region_1" and so on where it has none."""
        names = self.mesh.region_names
        return tuple(name or f"region_{i}" for i, name in enumerate(names, start=1))

    @cached_property
    def chord_count(self) -> int:
        """The number of chords."""
        return int(self.chord.max()) + 1

    @cached_property
    def crossing(self) -> np.ndarray:
        """(b, 2) the chords that divide the first and the second axis of each block."""
        return self.chord[self.sides[:, :2]]

    @cached_property
    def samples(self) -> tuple[np.ndarray, np.ndarray]:
        """(e, q) fractions of the parameter and (e, q) of the length at samples of each edge."""
        w = np.tile(np.linspace(0.0, 1.0, SAMPLES), (len(self.edges), 1))
        share = w.copy()
        bent = np.flatnonzero(self.parts.curve >= 0)
        if len(bent):
            at = self.parts.points(np.repeat(bent, SAMPLES), w[bent].ravel())
            steps = np.linalg.norm(np.diff(at.reshape(-1, SAMPLES, 3), axis=1), axis=2)
            arc = np.cumsum(steps, axis=1)
            whole = np.where(arc[:, -1:] > 0.0, arc[:, -1:], 1.0)
            share[bent, 1:] = arc / whole
        return w, share

    @cached_property
    def lengths(self) -> np.ndarray:
        """(e,) the lengths of the true edges."""
        found = np.linalg.norm(np.diff(self.parts.ends, axis=1)[:, 0], axis=1)
        bent = np.flatnonzero(self.parts.curve >= 0)
        if len(bent):
            w = np.linspace(0.0, 1.0, SAMPLES)
            at = self.parts.points(np.repeat(bent, SAMPLES), np.tile(w, len(bent)))
            steps = np.linalg.norm(np.diff(at.reshape(-1, SAMPLES, 3), axis=1), axis=2)
            found[bent] = steps.sum(axis=1)
        return found

    def edge_points(self, edges: np.ndarray, fractions: np.ndarray) -> np.ndarray:
        """(p, 3) points of edges (p,) at fractions (p,) of their length; on the curves exactly."""
        w, share = self.samples
        at = np.empty(len(edges))
        bounds = np.flatnonzero(np.diff(edges, prepend=-1, append=-1))
        for low, high in pairwise(bounds.tolist()):
            edge = int(edges[low])
            at[low:high] = np.interp(fractions[low:high], share[edge], w[edge])
        return self.parts.points(edges, at)

    def edge_between(self, a: int, b: int) -> int:
        """The edge between two vertices of the mesh, by id; -1 if there is none."""
        return self._edge_of.get((min(a, b), max(a, b)), -1)

    @cached_property
    def _edge_of(self) -> dict[tuple[int, int], int]:
        ends = np.sort(self.vertices[self.edges], axis=1)
        return {(a, b): edge for edge, (a, b) in enumerate(ends.tolist())}

    def patch(self, name: str) -> Patch:
        """The patch with this name, as drawn or plain. Raises MeshError that lists the names if
        there is none.
        """
        for patch in self.patches:
            if name in (patch.title, patch.name):
                return patch
        known = ", ".join(patch.title for patch in self.patches)
        raise MeshError(f"There is no side named {name!r}; there are {known}.")


def _directions(twin: np.ndarray, chord: np.ndarray) -> np.ndarray:
    """(4 b,) whether each half-edge runs in the direction of its chord: that of its first one."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    rows = np.arange(len(twin))
    inner = np.flatnonzero(twin >= 0)
    # node 2 r is half-edge r forwards, node 2 r + 1 backwards; opposite and twin turn around
    a = np.concatenate([2 * rows, 2 * rows + 1, 2 * inner, 2 * inner + 1])
    b = np.concatenate([2 * (rows ^ 2) + 1, 2 * (rows ^ 2), 2 * twin[inner] + 1, 2 * twin[inner]])
    links = coo_matrix((np.ones(len(a), bool), (a, b)), (2 * len(rows), 2 * len(rows)))
    label = connected_components(links, directed=False)[1]
    first = np.unique(chord, return_index=True)[1]
    along: np.ndarray = label[2 * rows] == label[2 * first][chord]
    return along


def _directed(parts: EdgeParts, along: np.ndarray) -> EdgeParts:
    """The same edges, those not `along` from their end to their start."""
    span = np.where(along[:, None], parts.span, parts.span[:, ::-1])
    ends = np.where(along[:, None, None], parts.ends, parts.ends[:, ::-1])
    return EdgeParts(parts.curves, parts.curve, span, ends)
