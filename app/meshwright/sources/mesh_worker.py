"""Makes new meshes in a separate process, on request of the window.

Triangle and the readers of foreign files hold the interpreter lock until they are done, so that a
thread would block the window. The process runs `serve`: it reads requests from stdin, one JSON
object a line, and writes a frame for each to stdout (`frame`, `unframed`).
"""

from __future__ import annotations

import io
import json
import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from meshwright.document.storage.project_file import is_project
from meshwright_core.errors import MeshError

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh
    from meshwright_core.domains.domain import Domain
    from meshwright_core.domains.meshing import Quads

MOST = 2_000_000
"""Limit on the elements of a new mesh."""

_PER_AREA = {"tri": 4.9, "quad": 3.7, "pairing": 2.6}
"""Elements per area of max_edge squared, measured on shapes of the gallery."""

_LENGTH = 8
"""Bytes at the start of a frame that give its length."""


@dataclass(frozen=True)
class NewMesh:
    """A new mesh as arrays, with what the dialog shows and draws of it.

    Attributes:
        name: name of the mesh.
        path: the mesh file that it was read from, empty for a mesh that was made.
        kind: "tri" or "quad".
        score, optimum: s and s*.
        low, high: (2,) the corners of its bounding box, in the plane.
        points: (n, 3).
        elements: (m, 3 or 4).
        geometric: (n,) whether a vertex is a corner.
        desired: (n,) desired degrees.
        delta: (n,) degree less desired degree.
        reach: (n,) length of the shortest edge at a vertex, in the plane.
        edges: (e, 2) vertices of the inner edges.
        rim: (b,) boundary vertices, loop after loop.
        sizes: (l,) how many of them each loop has.
    """

    name: str
    path: str
    kind: str
    score: int
    optimum: int
    low: np.ndarray
    high: np.ndarray
    points: np.ndarray
    elements: np.ndarray
    geometric: np.ndarray
    desired: np.ndarray
    delta: np.ndarray
    reach: np.ndarray
    edges: np.ndarray
    rim: np.ndarray
    sizes: np.ndarray

    @property
    def extent(self) -> float:
        """The longer side of its bounding box."""
        return float((self.high - self.low).max())

    @property
    def loops(self) -> list[np.ndarray]:
        """Vertices of each loop of the boundary, in order."""
        return np.split(self.rim, np.cumsum(self.sizes)[:-1])

    def mesh(self) -> HalfEdgeMesh:
        """Build the mesh from the arrays."""
        from meshwright_core import HalfEdgeMesh

        return HalfEdgeMesh.from_elements(self.points, self.elements, self.geometric, self.desired)


def make(request: Mapping[str, Any]) -> NewMesh:
    """Return the requested mesh.

    Args:
        request: ``"source"`` is one of ``{"shape": name}``, ``{"polygon": sides, "seed": n}``,
            ``{"part": corners, "seed": n}``, ``{"domain": as in Domain.to_json}`` and
            ``{"file": path, "corner_angle": degrees, "curve_step": degrees}``; besides there are
            ``"kind"``, and, each null for the default, ``"max_edge"``, ``"min_angle"``
            (degrees) and ``"quads"`` ("catmull-clark" or "pairing"). A mesh file is read as it is.

    Raises:
        MeshError: one sentence.
    """
    from meshwright.sources.resolve import resolve
    from meshwright_core.domains import meshing
    from meshwright_core.domains.domain import Domain

    source = request["source"]
    path = source.get("file", "")
    if is_project(path):
        raise MeshError(f"{path}: a project is opened by Open, not here.")
    if path:
        angles = {"corner_angle": source["corner_angle"], "curve_step": source["curve_step"]}
        domain = resolve(Path(path), **angles)
    else:
        domain = _domain(source)
    if not isinstance(domain, Domain):
        assert domain.mesh is not None
        _refuse_many(domain.mesh.n_elements, "has")
        return _made(domain.mesh, domain.name, path)
    kind, max_edge = request["kind"], request["max_edge"]
    quads: Quads = request["quads"] or "catmull-clark"
    if max_edge:
        rule = "pairing" if kind == "quad" and quads == "pairing" else kind
        _refuse_many(int(_PER_AREA[rule] * domain.area / max_edge**2), "would need about")
    mesh = meshing.mesh_domain(domain, kind, max_edge, request["min_angle"], quads=quads)
    _refuse_many(mesh.n_elements, "would have")
    return _made(mesh, domain.name or "drawing", "")


def frame(result: NewMesh | str) -> bytes:
    """Return a mesh, or the sentence of a refusal, as bytes with their length."""
    arrays: dict[str, Any] = {}
    if isinstance(result, str):
        arrays["refusal"] = np.array(result)
    else:
        arrays = {field.name: np.asarray(getattr(result, field.name)) for field in fields(NewMesh)}
    content = io.BytesIO()
    np.savez(content, **arrays)
    whole = content.getvalue()
    return len(whole).to_bytes(_LENGTH, "little") + whole


def length(content: bytes | bytearray) -> int:
    """Return the length of a frame in bytes, read from its beginning."""
    return _LENGTH + int.from_bytes(content[:_LENGTH], "little")


def unframed(content: bytes | bytearray) -> NewMesh | str:
    """Return the mesh, or the refusal, in a complete frame."""
    with np.load(io.BytesIO(memoryview(content)[_LENGTH:]), allow_pickle=False) as arrays:
        if "refusal" in arrays:
            return str(arrays["refusal"])
        values = {name: array[()] for name, array in arrays.items()}
    for name in ("name", "path", "kind"):
        values[name] = str(values[name])
    for name in ("score", "optimum"):
        values[name] = int(values[name])
    return NewMesh(**values)


def serve() -> None:
    """Answer requests until stdin ends, which also happens when the window's process ends."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # output that a library prints must not mix with the frames
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    _answer(sys.stdin.buffer, answers)


def _answer(requests: BinaryIO, answers: BinaryIO) -> None:
    for line in requests:
        try:
            result: NewMesh | str = make(json.loads(line))
        except MeshError as error:
            result = str(error)
        except MemoryError:
            result = "There is not enough memory for this mesh."
        answers.write(frame(result))
        answers.flush()


def _domain(source: Mapping[str, Any]) -> Domain:
    from meshwright_core.domains import gallery, random_parts
    from meshwright_core.domains.domain import Domain

    if "shape" in source:
        return gallery.shape(source["shape"])
    if "domain" in source:
        return Domain.from_json(source["domain"])
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
    elements = mesh.elements().astype(np.int32)
    ends = np.stack([elements, np.roll(elements, -1, axis=1)], axis=2).reshape(-1, 2)
    ends.sort(axis=1)
    key = ends[:, 0].astype(np.int64) * len(mesh.points) + ends[:, 1]
    _, first, uses = np.unique(key, return_index=True, return_counts=True)
    steps = mesh.points[ends[first, 0], :2] - mesh.points[ends[first, 1], :2]
    reach = np.full(len(mesh.points), np.inf)
    for side in (0, 1):
        np.minimum.at(reach, ends[first, side], np.hypot(*steps.T))
    loops = [np.asarray(loop, np.int64) for loop in mesh.boundary_loops()]
    return NewMesh(
        name=name,
        path=path,
        kind=mesh.kind,
        score=mesh.score,
        optimum=mesh.optimum,
        low=mesh.points[:, :2].min(axis=0),
        high=mesh.points[:, :2].max(axis=0),
        points=mesh.points,
        elements=elements,
        geometric=mesh.geometric(),
        desired=mesh.desired(),
        delta=mesh.irregularity().astype(np.int32),
        reach=reach,
        edges=ends[first[uses == 2]],
        rim=np.concatenate(loops) if loops else np.empty(0, np.int64),
        sizes=np.array([len(loop) for loop in loops], np.int64),
    )


if __name__ == "__main__":
    serve()
