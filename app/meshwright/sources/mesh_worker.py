"""Makes new meshes in a separate process, on request of the window.

Triangle and the readers of foreign files hold the interpreter lock until they are done, so that a
thread would block the window. The process runs `serve`: it reads requests from stdin, one JSON
object a line, and writes a frame for each to stdout (:mod:`meshwright.sources.new_mesh`).
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from meshwright.document.document import Document
from meshwright.document.storage.document_file import is_drawing
from meshwright.document.storage.project_file import is_project
from meshwright.sources.new_mesh import Answer, DrawingContents, NewMesh, frame
from meshwright.sources.resolve import resolve
from meshwright_core.core.arrays import TWIN
from meshwright_core.core.irregularity import usual_desired_degree
from meshwright_core.errors import MeshError
from meshwright_core.geometry.edge_curves import curve_halfedges, ends_of
from meshwright_core.geometry.edge_parts import EdgeParts
from meshwright_core.io import snapshot

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh
    from meshwright_core.domains.domain import Domain
    from meshwright_core.domains.meshing import Quads

MOST = 2_000_000
"""Limit on the elements of a new mesh."""

_PER_AREA = {"tri": 4.9, "quad": 3.7, "pairing": 2.6}
"""Elements per area of max_edge squared, measured on shapes of the gallery."""


def make(request: Mapping[str, Any]) -> Answer:
    """Return the requested mesh, or why there is none.

    Args:
        request: ``"source"`` is one of ``{"shape": name}``, ``{"polygon": sides, "seed": n}``,
            ``{"part": corners, "seed": n}``, ``{"domain": as in Domain.to_json, "corner_angle":
            degrees, or left out}`` and
            ``{"file": path, "corner_angle": degrees, "curve_step": degrees, "region": choice,
            "fit": "arcs" or "splines"}``; besides there are ``"kind"``, and, each null for the
            default, ``"max_edge"``, ``"min_angle"`` (degrees) and ``"quads"`` ("catmull-clark" or
            "pairing"). ``"region"`` is as in :func:`meshwright_core.io.drawings.read_domain`; null
            for those that touch the largest one. A mesh file is read as it is.
    """
    contents = None
    try:
        source = request["source"]
        path = source.get("file", "")
        if is_project(path):
            raise MeshError(f"{path}: a project is opened by Open, not here.")
        if path and is_drawing(path):
            contents, region = _contents(source)
            return Answer(_meshed(_drawn(source, region), request), "", contents)
        if path:
            found = resolve(Path(path), corner_angle=source["corner_angle"])
            assert isinstance(found, Document)
            assert found.mesh is not None
            _refuse_many(found.mesh.n_elements, "has")
            return Answer(_made(found.mesh, found.name, path))
        return Answer(_meshed(_domain(source), request))
    except MeshError as error:
        return Answer(None, str(error), contents)
    except MemoryError:
        return Answer(None, "There is not enough memory for this mesh.", contents)


def _contents(source: Mapping[str, Any]) -> tuple[DrawingContents, str]:
    """What a drawing holds, and the regions of it that are meshed, as a choice of numbers."""
    from meshwright_core.io import drawings

    report = drawings.read_regions(source["file"], source["corner_angle"])
    choice = source["region"]
    rows = report.groups()[0] if choice is None else [int(one) - 1 for one in choice.split(",")]
    rows = [row for row in rows if row < len(report.regions)] or [0]
    region = ",".join(str(row + 1) for row in rows)
    return DrawingContents.of(report, tuple(rows)), region


def _drawn(source: Mapping[str, Any], region: str) -> Domain:
    domain = resolve(
        Path(source["file"]),
        corner_angle=source["corner_angle"],
        curve_step=source["curve_step"],
        region=region,
        fit=source["fit"],
    )
    assert not isinstance(domain, Document)
    return domain


def _meshed(domain: Domain, request: Mapping[str, Any]) -> NewMesh:
    from meshwright_core.domains import meshing

    kind, max_edge = request["kind"], request["max_edge"]
    quads: Quads = request["quads"] or "catmull-clark"
    if max_edge:
        rule = "pairing" if kind == "quad" and quads == "pairing" else kind
        _refuse_many(int(_PER_AREA[rule] * domain.area / max_edge**2), "would need about")
    mesh = meshing.mesh_domain(domain, kind, max_edge, request["min_angle"], quads=quads)
    _refuse_many(mesh.n_elements, "would have")
    return _made(mesh, domain.name or "drawing", "")


def serve() -> None:
    """Answer requests until stdin ends, which also happens when the window's process ends."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # output that a library prints must not mix with the frames
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    _answer(sys.stdin.buffer, answers)


def _answer(requests: BinaryIO, answers: BinaryIO) -> None:
    for line in requests:
        answers.write(frame(make(json.loads(line))))
        answers.flush()


def _domain(source: Mapping[str, Any]) -> Domain:
    from meshwright_core.domains import gallery, random_parts
    from meshwright_core.domains.domain import CORNER_ANGLE, Domain

    if "shape" in source:
        return gallery.shape(source["shape"])
    if "domain" in source:
        return Domain.from_json(source["domain"], source.get("corner_angle", CORNER_ANGLE))
    rng = np.random.default_rng(source["seed"])
    if "part" in source:
        return random_parts.random_part(source["part"], rng)
    return gallery.random_polygon(source["polygon"], rng)


def _refuse_many(count: int, verb: str) -> None:
    if count > MOST:
        if verb == "would need about":
            count = int(float(f"{count:.2g}"))
        raise MeshError(
            f"This mesh {verb} {count:,} elements, and the limit is {MOST:,}: use longer edges."
        )


def _made(mesh: HalfEdgeMesh, name: str, path: str) -> NewMesh:
    halfedges = mesh.halfedges_of(mesh.element_ids()).ravel()
    ends = ends_of(mesh, halfedges)
    steps = mesh.points[ends[:, 0], :2] - mesh.points[ends[:, 1], :2]
    reach = np.full(len(mesh.points), np.inf)
    for side in (0, 1):
        np.minimum.at(reach, ends[:, side], np.hypot(*steps.T))
    rim, sizes, owners = _region_loops(mesh)
    inner = ~np.isin(halfedges, rim) & (halfedges > mesh.arrays.edge[halfedges, TWIN])
    parts = EdgeParts.of(mesh.arrays, rim, mesh.k)
    fixed = np.flatnonzero(mesh.geometric())
    usual = [usual_desired_degree(mesh.k, boundary) for boundary in (True, False)]
    straight = mesh.desired()[fixed] == np.where(mesh.boundary()[fixed], *usual)
    box = np.concatenate([mesh.points[mesh.vertices()], parts.box])
    return NewMesh(
        name=name,
        path=path,
        kind=mesh.kind,
        score=mesh.score,
        optimum=mesh.optimum,
        low=box[:, :2].min(axis=0),
        high=box[:, :2].max(axis=0),
        delta=mesh.irregularity().astype(np.int32),
        reach=reach,
        edges=ends[inner],
        corners=fixed[~straight],
        anchors=fixed[straight],
        rim_curve=parts.curve,
        rim_span=parts.span,
        rim_ends=parts.ends,
        sizes=sizes,
        owners=owners,
        stored=snapshot.to_arrays(mesh),
    )


def _region_loops(mesh: HalfEdgeMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The half-edges around each region, loop after loop; how many each loop has; its region."""
    rim = curve_halfedges(mesh)
    region = mesh.arrays.region[rim // mesh.k].tolist()
    origin, target = ends_of(mesh, rim).T.tolist()
    leaving: dict[tuple[int, int], list[int]] = {}
    for row in range(len(rim) - 1, -1, -1):
        leaving.setdefault((region[row], origin[row]), []).append(row)
    order: list[int] = []
    sizes, owners = [], []
    for (owner, start), rows in leaving.items():
        while rows:  # from a point where a region touches itself several loops may leave
            before, row = len(order), rows.pop()
            order.append(row)
            while target[row] != start:
                row = leaving[owner, target[row]].pop()
                order.append(row)
            sizes.append(len(order) - before)
            owners.append(owner)
    return rim[order], np.array(sizes, np.int64), np.array(owners, np.int64)


if __name__ == "__main__":
    serve()
