"""The region of a domain that each element of a mesh lies in."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.domains.domain import Domain
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh


def element_regions(mesh: HalfEdgeMesh, domain: Domain) -> NDArray[np.int64] | None:
    """(m,) the region of each element in the order of `mesh.elements()`; None if there is one.

    By the middle of its corners; one that lies in no region belongs to the nearest one.

    Raises:
        MeshError: a region without elements.
    """
    if len(domain.regions) < 2:
        return None
    middles = shapely.points(mesh.points[mesh.elements(), :2].mean(axis=1))
    areas = []
    for region in domain.regions:
        rings = [np.concatenate([c.sampled(turn_degrees=4.0)[:-1] for c in loop])
                 for loop in region.loops]  # fmt: skip
        area = shapely.Polygon()
        for ring in rings:  # loops nest by even-odd
            area = shapely.symmetric_difference(area, shapely.make_valid(shapely.Polygon(ring)))
        shapely.prepare(area)
        areas.append(area)
    distance = np.array([shapely.distance(area, middles) for area in areas])
    found: NDArray[np.int64] = distance.argmin(axis=0).astype(np.int64)
    empty = np.setdiff1d(np.arange(len(areas)), found)
    if len(empty):
        name = domain.regions[int(empty[0])].name or f"{int(empty[0])}"
        raise MeshError(f"No element of the mesh lies in region {name} of the drawing.")
    return found
