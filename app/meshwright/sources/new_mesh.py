"""What the process that makes meshes answers: a mesh, and what was found in a drawing, as bytes."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright_core.core.composite_curves import Curves
from meshwright_core.geometry.edge_parts import EdgeParts

if TYPE_CHECKING:
    from meshwright_core import HalfEdgeMesh
    from meshwright_core.io.drawings.report import DrawingReport

_LENGTH = 8
"""Bytes at the start of a frame that give its length."""
_MESH = "mesh."
"""Prefix, in a frame, of the names of a mesh's own arrays."""
_WORDS = ("name", "path", "kind")
_NUMBERS = ("score", "optimum")
_ARRAYS = (
    "low", "high", "delta", "reach", "edges", "corners", "anchors",
    "rim_curve", "rim_span", "rim_ends", "sizes", "owners",
)  # fmt: skip


@dataclass(frozen=True)
class RegionRow:
    """A region found in a drawing. ``group`` is the number of the regions that touch, directly or
    through others.
    """

    name: str
    area: float
    holes: int
    corners: int
    layer: str
    group: int


@dataclass(frozen=True)
class DrawingContents:
    """What was found in a drawing; see :class:`meshwright_core.io.drawings.DrawingReport`.

    ``chosen`` are the indices of the regions that are meshed; ``missed`` is what is open.
    """

    regions: tuple[RegionRow, ...]
    chosen: tuple[int, ...]
    repairs: tuple[str, ...]
    ignored: tuple[str, ...]
    missed: tuple[str, ...]
    units: str

    @classmethod
    def of(cls, report: DrawingReport, chosen: tuple[int, ...]) -> DrawingContents:
        """The contents of a report."""
        group = {i: number for number, rows in enumerate(report.groups()) for i in rows}
        rows = (
            RegionRow(one.name, one.area, one.holes, one.corners, one.layer, group[i])
            for i, one in enumerate(report.regions)
        )
        return cls(
            regions=tuple(rows),
            chosen=chosen,
            repairs=tuple(report.repairs),
            ignored=tuple(report.ignored),
            missed=tuple(report.open_outlines),
            units=report.units,
        )

    @classmethod
    def from_json(cls, text: str) -> DrawingContents:
        """The contents that :meth:`to_json` wrote."""
        content = json.loads(text)
        rows = tuple(RegionRow(**row) for row in content.pop("regions"))
        units = content.pop("units")
        return cls(rows, **{key: tuple(value) for key, value in content.items()}, units=units)

    def to_json(self) -> str:
        """The contents as text."""
        return json.dumps(asdict(self))


@dataclass(frozen=True)
class NewMesh:
    """A new mesh as arrays, with what the dialog shows and draws of it.

    Attributes:
        name: name of the mesh.
        path: the mesh file that it was read from, empty for a mesh that was made.
        kind: "tri" or "quad".
        score, optimum: s and s*.
        low, high: (2,) the corners of its bounding box, in the plane.
        delta: (n,) degree less desired degree.
        reach: (n,) length of the shortest edge at a vertex, in the plane.
        edges: (e, 2) vertices of the edges inside of regions.
        corners, anchors: vertices that stay, where a side turns and where it does not.
        rim_curve, rim_span, rim_ends: the edges around each region, loop after loop, as in
            :class:`meshwright_core.geometry.edge_parts.EdgeParts`.
        sizes: (l,) how many of them each loop has.
        owners: (l,) its region.
        stored: the mesh, as :func:`meshwright_core.io.snapshot.to_arrays` has it.
    """

    name: str
    path: str
    kind: str
    score: int
    optimum: int
    low: np.ndarray
    high: np.ndarray
    delta: np.ndarray
    reach: np.ndarray
    edges: np.ndarray
    corners: np.ndarray
    anchors: np.ndarray
    rim_curve: np.ndarray
    rim_span: np.ndarray
    rim_ends: np.ndarray
    sizes: np.ndarray
    owners: np.ndarray
    stored: Mapping[str, np.ndarray]

    @property
    def extent(self) -> float:
        """The longer side of its bounding box."""
        return float((self.high - self.low).max())

    @property
    def points(self) -> np.ndarray:
        """(n, 3) the vertices."""
        return np.asarray(self.stored["points"])

    @property
    def elements(self) -> np.ndarray:
        """(m, 3 or 4) vertices of the elements."""
        k = 4 if self.kind == "quad" else 3
        return np.asarray(self.stored["edge"][:, 0]).reshape(-1, k)

    @cached_property
    def rim(self) -> EdgeParts:
        """The edges around each region, loop after loop."""
        curves = Curves(*(self.stored[f"curves.{field}"] for field in Curves._fields))
        return EdgeParts(curves, self.rim_curve, self.rim_span, self.rim_ends)

    def mesh(self) -> HalfEdgeMesh:
        """Build the mesh from the arrays."""
        from meshwright_core.io import snapshot

        return snapshot.from_arrays(self.stored)


@dataclass(frozen=True)
class Answer:
    """A mesh, or the sentence of a refusal; and what was found, if a drawing was read."""

    mesh: NewMesh | None = None
    refusal: str = ""
    contents: DrawingContents | None = None


def frame(answer: Answer) -> bytes:
    """Return an answer as bytes with their length."""
    arrays: dict[str, np.ndarray] = {}
    if answer.contents is not None:
        arrays["contents"] = np.array(answer.contents.to_json())
    if answer.mesh is None:
        arrays["refusal"] = np.array(answer.refusal)
    else:
        for name in (*_WORDS, *_NUMBERS, *_ARRAYS):
            arrays[name] = np.asarray(getattr(answer.mesh, name))
        arrays.update({_MESH + name: array for name, array in answer.mesh.stored.items()})
    content = io.BytesIO()
    np.savez(content, **arrays)  # type: ignore[arg-type]
    whole = content.getvalue()
    return len(whole).to_bytes(_LENGTH, "little") + whole


def length(content: bytes | bytearray) -> int:
    """Return the length of a frame in bytes, read from its beginning."""
    return _LENGTH + int.from_bytes(content[:_LENGTH], "little")


def unframed(content: bytes | bytearray) -> Answer:
    """Return the answer in a complete frame."""
    with np.load(io.BytesIO(memoryview(content)[_LENGTH:]), allow_pickle=False) as arrays:
        found: dict[str, Any] = dict(arrays.items())
    contents = None
    if "contents" in found:
        contents = DrawingContents.from_json(str(found.pop("contents")))
    if "refusal" in found:
        return Answer(None, str(found["refusal"]), contents)
    stored = {name.removeprefix(_MESH): found[name] for name in found if name.startswith(_MESH)}
    values: dict[str, Any] = {name: str(found[name]) for name in _WORDS}
    values.update({name: int(found[name]) for name in _NUMBERS})
    values.update({name: found[name] for name in _ARRAYS})
    return Answer(NewMesh(**values, stored=stored), "", contents)
