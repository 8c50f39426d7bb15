"""Finds the elements with sides that bend."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry.coons import SAMPLES, CurvedElements
from meshwright_core.geometry.edge_curves import bent_edges
from meshwright_core.geometry.edge_parts import EdgeParts

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


def table(
    mesh: HalfEdgeMesh,
    ids: np.ndarray,
    elements: np.ndarray,
    halfedges: np.ndarray,
    sides: EdgeParts,
    parameter: np.ndarray,
) -> CurvedElements:
    """The elements with the given sides.

    Args:
        mesh: the mesh.
        ids: (m,) elements, ascending.
        elements: (m, k) their vertices, by any numbering.
        halfedges: (r,) of these elements, those that bend.
        sides: their places.
        parameter: (n,) by the same numbering, what is left out of the parameters in `sides`.
    """
    rows = np.searchsorted(ids, halfedges // mesh.k)
    element, place = np.unique(rows, return_inverse=True)
    number = np.full((len(element), mesh.k), -1, np.int64)
    number[place.reshape(-1), halfedges % mesh.k] = np.arange(len(rows))
    row = np.full(len(ids), -1, np.int64)
    row[element] = np.arange(len(element))
    return CurvedElements(
        curves=sides.curves,
        samples=SAMPLES[mesh.k],
        elements=elements,
        element=element,
        row=row,
        sides=number,
        curve=sides.curve,
        base=np.ascontiguousarray(sides.span),
        parameter=parameter,
    )


def curved_elements(
    mesh: HalfEdgeMesh, ids: np.ndarray, elements: np.ndarray, halfedges: np.ndarray | None = None
) -> CurvedElements:
    """The elements with sides that bend, of elements `ids` (m,), ascending, at the vertices
    `elements` (m, k) of the mesh.

    halfedges: those that may bend; None: all of the mesh, which must be of these elements.
    """
    return table(mesh, ids, elements, *bent_edges(mesh, halfedges), np.zeros(mesh.slots))
