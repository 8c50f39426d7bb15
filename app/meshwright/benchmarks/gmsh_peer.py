"""Gmsh's quad meshes of a domain with about as many elements, for comparison in benchmarks.

Two of its ways: quasi-structured, and blossom with full-quad recombination, each with the size of
elements that gives a number near to the wanted one. Both need more elements than blocks do; what
counts then is their coarsest mesh. Needs the module `gmsh`, which nothing else does; without it
there is nothing to compare.
"""

from __future__ import annotations

import importlib.util
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright_core.geometry import quality
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.mesh import HalfEdgeMesh

if TYPE_CHECKING:
    from meshwright_core.domains.domain import Domain

WAYS: dict[str, dict[str, float]] = {
    "quasi-structured": {"Mesh.Algorithm": 11},
    "blossom": {"Mesh.RecombinationAlgorithm": 3},
}
"""Name of each way, and the options that choose it."""
SIZES = tuple(4.0 / math.sqrt(2.0) ** i for i in range(10))
"""Sizes that are tried, the coarsest first, relative to the side of a square of the mean area."""


def available() -> bool:
    """Whether the module `gmsh` is installed."""
    return importlib.util.find_spec("gmsh") is not None


def measured(domain: Domain, elements: int) -> dict[str, Any]:
    """Columns of a table for both ways; none without `gmsh`. `elements`: how many to aim at."""
    if not available():
        return {}
    found: dict[str, Any] = {}
    for way, options in WAYS.items():
        mesh = nearest(domain, elements, options)
        if mesh is None:
            found |= {f"{way}: elements": 0, f"{way}: s": -1, f"{way}: worst shape": -1.0}
            continue
        found[f"{way}: elements"] = mesh.n_elements
        found[f"{way}: s"] = mesh.score
        shapes = element_shapes(mesh)
        valid = not len(quality.inverted(mesh))
        found[f"{way}: worst shape"] = round(float(shapes.min()), 3) if valid else -1.0
    return found


def nearest(domain: Domain, elements: int, options: dict[str, float]) -> HalfEdgeMesh | None:
    """Of the meshes of all sizes that with about so many elements; None if none can be made."""
    best, off = None, math.inf
    for size in SIZES:
        mesh = meshed(domain, size * math.sqrt(domain.area / max(elements, 1)), options)
        if mesh is None:
            continue
        if abs(math.log(mesh.n_elements / elements)) < off:
            best, off = mesh, abs(math.log(mesh.n_elements / elements))
        if mesh.n_elements >= elements:
            break
    return best


def meshed(domain: Domain, size: float, options: dict[str, float]) -> HalfEdgeMesh | None:
    """The domain, with straight sides, meshed by Gmsh in quads of about `size`; None if that fails
    or leaves triangles.
    """
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        for name, value in options.items():
            gmsh.option.setNumber(name, value)
        gmsh.option.setNumber("Mesh.RecombineAll", 1)
        loops = []
        for ring in domain.loops:
            points = [gmsh.model.geo.addPoint(float(x), float(y), 0.0, size) for x, y in ring]
            pairs = zip(points, points[1:] + points[:1], strict=True)
            loops.append(gmsh.model.geo.addCurveLoop([gmsh.model.geo.addLine(*p) for p in pairs]))
        gmsh.model.geo.addPlaneSurface(loops)
        gmsh.model.geo.synchronize()
        gmsh.model.mesh.generate(2)
        kinds, _, nodes = gmsh.model.mesh.getElements(2)
        if list(kinds) != [3]:
            return None
        tags, places, _ = gmsh.model.mesh.getNodes()
        quads = np.asarray(nodes[0], np.int64).reshape(-1, 4)
        used, rows = np.unique(quads, return_inverse=True)
        order = np.argsort(tags)
        at = order[np.searchsorted(np.asarray(tags)[order], used)]
        points3 = np.asarray(places).reshape(-1, 3)[at]
        return _mesh(points3, rows.reshape(-1, 4))
    except Exception:  # it raises no other type
        return None
    finally:
        gmsh.finalize()


def _mesh(points: np.ndarray, quads: np.ndarray) -> HalfEdgeMesh:
    p = points[quads]
    ahead, back = p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]
    if (ahead[:, 0] * back[:, 1] - ahead[:, 1] * back[:, 0]).sum() < 0.0:
        quads = quads[:, ::-1]
    return HalfEdgeMesh.from_elements(points, quads)


def summary(rows: list[dict[str, Any]], usable: float) -> dict[str, int]:
    """In how many rows each way is at s*, and its every shape usable."""
    found: dict[str, int] = {}
    for way in WAYS:
        if rows and f"{way}: s" in rows[0]:
            found[f"{way} at s*"] = sum(row[f"{way}: s"] == row["s*"] for row in rows)
            found[f"{way}: every shape {usable} or more"] = sum(
                row[f"{way}: worst shape"] >= usable for row in rows
            )
    return found
