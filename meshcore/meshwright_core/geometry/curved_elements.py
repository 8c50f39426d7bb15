"""Finds the elements with sides that bend."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry.coons import SAMPLES, CurvedElements
from meshwright_core.geometry.edge_curves import EdgePlaces, bent_edges

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


def table(
    mesh: HalfEdgeMesh,
    ids: np.ndarray,
    elements: np.ndarray,
    places: EdgePlaces,
    parameter: np.ndarray,
) -> CurvedElements:
    """The elements with the sides `places`.

    Args:
        mesh: the mesh.
        ids: (m,) elements, ascending.
        elements: (m, k) their vertices, by any numbering.
        places: the sides that bend, half-edges of these elements.
        parameter: (n,) by the same numbering, what is left out of the parameters in `places`.
    """
    rows = np.searchsorted(ids, places.halfedges // mesh.k)
    element, place = np.unique(rows, return_inverse=True)
    sides = np.full((len(element), mesh.k), -1, np.int64)
    sides[place.reshape(-1), places.halfedges % mesh.k] = np.arange(len(rows))
    row = np.full(len(ids), -1, np.int64)
    row[element] = np.arange(len(element))
    return CurvedElements(
        curves=mesh.boundary_info.curves,
        samples=SAMPLES[mesh.k],
        elements=elements,
        element=element,
        row=row,
        sides=sides,
        curve=places.curve,
        base=np.ascontiguousarray(places.span),
        parameter=parameter,
    )


def curved_elements(
    mesh: HalfEdgeMesh, ids: np.ndarray, elements: np.ndarray, halfedges: np.ndarray | None = None
) -> CurvedElements:
    """The elements with sides that bend, of elements `ids` (m,), ascending, at the vertices
    `elements` (m, k) of the mesh.

    halfedges: those that may bend; None: all of the mesh, which must be of these elements.
    """
    return table(mesh, ids, elements, bent_edges(mesh, halfedges), np.zeros(mesh.slots))
