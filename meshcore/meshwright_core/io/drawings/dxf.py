"""DXF drawings, text or binary, of any version and code page: read with ezdxf's repair.

Lines, polylines with arcs in them, arcs, circles, ellipses, splines, and blocks inserted at places.
Texts, dimensions, points and the like are counted and left out, and so is what the drawing hides:
layers that are off or frozen, invisible entities, paper space. Boundaries of hatches serve only
where there are no other curves, and paper space where the model space is empty.
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.drawings import dxf_entities, dxf_tags
from meshwright_core.io.drawings.drawn import (
    MAX_CURVES,
    Drawing,
    DrawnCurve,
    Points,
    listed,
)
from meshwright_core.io.formats import contained

_DEPTH = 8
"""Blocks within blocks that are followed."""
_NAMELESS = ("", "0", "defpoints")
"""Layers whose names say nothing."""
_CENTRE_LINES = ("CENTER", "CENTRE", "DASHDOT", "PHANTOM", "ACAD_ISO04W100", "ACAD_ISO10W100")
"""Line types that mark axes and bends, not edges."""
_MATTERS = re.compile(
    rf"\b(?:{'|'.join([*dxf_entities.KINDS, 'INSERT'])})\b(?!.*without required BLOCK)"
)
"""Messages of ezdxf about what may be a part of the shape; of missing blocks we know the names."""
_UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 13: "um", 14: "dm"}


def read(content: bytes) -> Drawing:
    """Return what a DXF file draws, in drawing units.

    Raises:
        MeshError: the file is no DXF, or damaged beyond repair; an entity is damaged; blocks are
            nested too deep or repeat too often; there is nothing to trace.
    """
    text, notes, dropped = dxf_tags.completed(content)
    with contained():
        from ezdxf import recover

        document, auditor = recover.read(io.BytesIO(text), errors="ignore")
    reader = _Reader(document)
    reader.drawing.notes = [*notes, *_repairs(auditor)]
    reader.drawing.ignored.update(dropped)
    reader.read_model(document)
    return reader.drawing


def _repairs(auditor: Any) -> list[str]:
    """What ezdxf left out or changed that may matter for the shape."""
    messages = [" ".join(e.message.split()).rstrip(".") for e in [*auditor.fixes, *auditor.errors]]
    told = [message for message in dict.fromkeys(messages) if _MATTERS.search(message)]
    return [f"repaired by ezdxf: {message[:1].lower()}{message[1:]}" for message in told][:20]


@dataclass
class _Place:
    """Where a block is put: an affine map, and the layer that its layer 0 stands for."""

    matrix: Points = field(default_factory=lambda: np.eye(3))
    layer: str = "0"
    depth: int = 0

    @property
    def moves(self) -> bool:
        return self.depth > 0


class _Reader:
    """Turns entities into curves, with the blocks and the hidden layers of the drawing."""

    def __init__(self, document: Any) -> None:
        self.drawing = Drawing(units=_UNITS.get(int(document.header.get("$INSUNITS", 0)), ""))
        self.blocks = document.blocks
        self.hidden, self.types = set(), {}
        for layer in document.layers:
            key = layer.dxf.name.lower()
            self.types[key] = layer.dxf.get("linetype", "CONTINUOUS").upper()
            if layer.is_off() or layer.is_frozen():
                self.hidden.add(key)
        self.centre_lines: list[DrawnCurve] = []
        self.hatches: list[tuple[Any, _Place]] = []
        self.members: dict[str, list[Any]] = {}
        self.curves: dict[int, list[Any]] = {}
        self.sizes: dict[str, int] = {}

    def read_model(self, document: Any) -> None:
        """Read the model space, or the first layout that holds anything if it is empty."""
        drawing = self.drawing
        for layout in [document.modelspace(), *_paper_layouts(document)]:
            self.read(layout, _Place())
            if not drawing.curves and self.centre_lines:
                drawing.curves, self.centre_lines = self.centre_lines, []
            if not drawing.curves:
                for hatch, place in self.hatches:
                    self.add(hatch, hatch.dxf.layer, place)
                self.hatches = []
            if drawing.curves:
                if not layout.is_modelspace:
                    drawing.notes.append(
                        f"the model space is empty; the layout {layout.name!r} was read instead"
                    )
                break
        if self.centre_lines:
            drawing.ignored["centre line"] += len(self.centre_lines)
        if self.hatches:
            drawing.ignored["HATCH"] += len(self.hatches)
        if not drawing.curves:
            others = [
                name if count == 1 else f"{count:,} {name}"
                for name, count in sorted(drawing.ignored.items())
            ]
            found = f", only {listed(others)}" if others else ""
            told = f"; {drawing.notes[0]}" if drawing.notes else ""
            raise MeshError(f"there are no lines or curves to trace in it{found}{told}")

    def read(self, entities: Iterable[Any], place: _Place) -> None:
        """Read the entities of a layout, or of a block that is put at a place."""
        for entity in entities:
            kind = entity.dxftype()
            layer = entity.dxf.get("layer", "0")
            layer = place.layer if layer == "0" else layer
            if layer.lower() in self.hidden or entity.dxf.get("invisible", 0):
                self.drawing.ignored["hidden entity"] += 1
            elif kind == "INSERT":
                self.insert(entity, layer, place)
            elif kind == "HATCH":
                self.hatches.append((entity, place))
            elif kind not in dxf_entities.KINDS or layer.lower() == "defpoints":
                if kind not in ("VIEWPORT", "ATTDEF"):
                    self.drawing.ignored[kind] += 1
            else:
                self.add(entity, layer, place)

    def add(self, entity: Any, layer: str, place: _Place) -> None:
        """Add the curves of one entity to the drawing."""
        key = id(entity)
        try:
            if key not in self.curves:
                self.curves[key] = list(dxf_entities.curves_of(entity))
        except dxf_entities.TiltedError:
            self.drawing.ignored[f"{entity.dxftype()} that does not lie in the plane"] += 1
            return
        named = "" if layer.lower() in _NAMELESS else layer
        line_type = entity.dxf.get("linetype", "BYLAYER").upper()
        if line_type == "BYLAYER":
            line_type = self.types.get(layer.lower(), "")
        for curve in self.curves[key]:
            if place.moves:
                try:
                    curve = curve.transformed(place.matrix[:2])
                except MeshError as error:
                    raise MeshError("a block is scaled to nothing, or beyond all bounds") from error
            if line_type.startswith(_CENTRE_LINES):
                self.centre_lines.append(DrawnCurve(curve, named, named))
            else:
                self.drawing.add(curve, named, named)

    def insert(self, entity: Any, layer: str, place: _Place) -> None:
        """Read a block at each place of an INSERT."""
        name = entity.dxf.get("name", "")
        block = self.blocks.get(name)
        if block is None:
            raise MeshError(f"there is no block named {name[:40]!r}")
        if place.depth == _DEPTH:
            raise MeshError(f"blocks are nested more than {_DEPTH} deep, in {name[:40]!r}")
        columns, rows = (
            max(1, int(entity.dxf.get(key, 1))) for key in ("column_count", "row_count")
        )
        members = self.members.setdefault(name, list(block))
        if columns * rows * max(1, len(members)) > MAX_CURVES:
            raise MeshError(f"it has more than {MAX_CURVES:,} lines and curves")
        try:
            side = dxf_entities.mirror(entity)
        except dxf_entities.TiltedError:
            self.drawing.ignored["INSERT that does not lie in the plane"] += 1
            return
        own = _affine(entity)
        angle = math.radians(entity.dxf.get("rotation", 0.0))
        across = np.array([side * math.cos(angle), math.sin(angle)])
        along = np.array([-side * math.sin(angle), math.cos(angle)])
        across *= entity.dxf.get("column_spacing", 0.0)
        along *= entity.dxf.get("row_spacing", 0.0)
        for column in range(columns if across.any() else 1):
            for row in range(rows if along.any() else 1):
                matrix = own.copy()
                matrix[:2, 2] += column * across + row * along
                self.read(members, _Place(place.matrix @ matrix, layer, place.depth + 1))


def _affine(entity: Any) -> Points:
    """The (3, 3) map of the plane of a block to where an INSERT puts it."""
    image = np.array([tuple(p)[:2] for p in entity.matrix44().transform_vertices(
        [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    )])  # fmt: skip
    matrix = np.eye(3)
    matrix[:2] = np.column_stack([image[1] - image[0], image[2] - image[0], image[0]])
    if not np.isfinite(matrix).all() or np.linalg.det(matrix) == 0.0:
        raise MeshError(f"the block {entity.dxf.name[:40]!r} is scaled to nothing")
    return matrix


def _paper_layouts(document: Any) -> list[Any]:
    return [layout for layout in document.layouts if not layout.is_modelspace]
