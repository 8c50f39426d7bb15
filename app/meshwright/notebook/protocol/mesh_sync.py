"""Synchronises a browser's copy of the mesh: one whole state, then patches.

A patch is found by comparing arrays with those that were sent last, so that operations, smoothing,
undo and jumps through the history need no code of their own. Arrays are sent as little-endian
buffers beside a small object. Coordinates are float32 in a frame in which the mesh reaches from
about -1 to 1.

Arrays are indexed by slots of the mesh: vertex v, half-edge h. Flags of a dead vertex are 0, the
origin of a dead half-edge is -1. The number of slots never decreases: an undo leaves dead slots.

The curves of boundary and interfaces are constant: they are part of the state alone. Curves and
parameters of vertices are sent for the vertices on curves, or where they have changed; regions of
elements where there are several.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import (
    CURVE,
    DEGREE,
    DESIRED,
    ELEMENT_SLOTS,
    FLAGS,
    GEOMETRIC,
    HALF,
    LOCKED,
    ORIGIN,
    TWIN,
)
from meshwright_core.core.composite_curves import Curves
from meshwright_core.core.irregularity import usual_desired_degree
from meshwright_core.core.mesh_boundary import MeshBoundary
from meshwright_core.core.vertex_flags import PINNED

VERSION = 2
ALIVE, BOUNDARY, CORNER, FIXED, ANCHOR, PIN = 1, 2, 4, 8, 16, 32
"""Bits of a vertex's flags; FIXED is a vertex locked by the user, PIN a pinned one, ANCHOR
with CORNER a geometric vertex whose desired degree is that of a straight side.
"""


@dataclass
class Packet:
    """A message to the browser: a small object, and arrays as bytes."""

    content: dict[str, Any]
    buffers: list[bytes] = field(default_factory=list)

    @property
    def size(self) -> int:
        """Bytes of the arrays."""
        return sum(map(len, self.buffers))


@dataclass(frozen=True)
class CoordinateFrame:
    """Maps coordinates of the mesh to those that are sent: x' = (x - cx) / scale, y' likewise."""

    cx: float = 0.0
    cy: float = 0.0
    scale: float = 1.0

    @classmethod
    def of(cls, mesh: HalfEdgeMesh) -> CoordinateFrame:
        """The frame in which the live vertices lie between -1 and 1."""
        live = mesh.points[mesh.vertices(), :2]
        if not len(live):
            return cls()
        low, high = live.min(axis=0), live.max(axis=0)
        (cx, cy), scale = (0.5 * (low + high)).tolist(), 0.5 * float((high - low).max())
        return cls(cx, cy, scale if scale > 0 else 1.0)

    def normalised(self, places: np.ndarray) -> np.ndarray:
        """Coordinates (..., 2 or 3) as float32 (..., 2)."""
        moved = (places[..., :2] - (self.cx, self.cy)) / self.scale
        return moved.astype("<f4")

    def control(self, curves: Curves) -> np.ndarray:
        """(c, 3) float64 homogeneous control points w x', w y', w of curves in the plane."""
        weight = curves.control[:, 3:]
        moved = (curves.control[:, :2] - weight * (self.cx, self.cy)) / self.scale
        return np.hstack([moved, weight])


@dataclass(frozen=True)
class SlotArrays:
    """The arrays that are sent of a mesh with ``V`` vertex slots and ``H`` half-edge slots."""

    places: np.ndarray
    """(V, 2) float32 coordinates; 0 for dead vertices."""
    delta: np.ndarray
    """(V,) int8, degree minus desired degree."""
    flags: np.ndarray
    """(V,) uint8, bits as above."""
    origin: np.ndarray
    """(H,) int32."""
    twin: np.ndarray
    """(H,) int32."""
    curve: np.ndarray
    """(V,) int32, the curve that a vertex lies on; -1 for none."""
    parameter: np.ndarray
    """(V,) float64, its parameter there; 0 for none."""
    region: np.ndarray
    """(E,) int16, the region of an element; 0 for dead ones."""

    @classmethod
    def of(
        cls, mesh: HalfEdgeMesh, frame: CoordinateFrame, vertices: int = 0, halfedges: int = 0
    ) -> SlotArrays:
        """Copies from the mesh, padded to at least so many slots."""
        arrays = mesh.arrays
        used, held = mesh.slots, mesh.k * int(arrays.counters[ELEMENT_SLOTS])
        rows, edges = arrays.vertex[:used], arrays.edge[:held]
        half = rows[:, HALF]
        alive = half >= 0
        on_boundary = arrays.edge[np.maximum(half, 0), TWIN] < 0
        geometric = (rows[:, FLAGS] & GEOMETRIC) > 0
        usual = [usual_desired_degree(mesh.k, boundary) for boundary in (True, False)]
        straight = rows[:, DESIRED] == np.where(on_boundary, *usual)
        flags = np.zeros(max(used, vertices), np.uint8)
        flags[:used] = np.where(
            alive,
            ALIVE
            + BOUNDARY * on_boundary
            + CORNER * geometric
            + ANCHOR * (geometric & straight)
            + FIXED * ((rows[:, FLAGS] & LOCKED) > 0)
            + PIN * ((rows[:, FLAGS] & PINNED) > 0),
            0,
        )
        delta = np.zeros(len(flags), np.int8)
        delta[:used] = np.clip(rows[:, DEGREE] - rows[:, DESIRED], -127, 127) * alive
        places = np.zeros((len(flags), 2), "<f4")
        places[:used][alive] = frame.normalised(mesh.points[alive])
        origin = np.full(max(held, halfedges), -1, "<i4")
        origin[:held] = np.maximum(edges[:, ORIGIN], -1)
        twin = np.full(len(origin), -1, "<i4")
        twin[:held] = np.where(edges[:, ORIGIN] >= 0, edges[:, TWIN], -1)
        curve = np.full(len(flags), -1, "<i4")
        curve[:used][alive] = rows[alive, CURVE]
        parameter = np.zeros(len(flags), "<f8")
        parameter[:used] = np.where(curve[:used] >= 0, arrays.parameter[:used], 0.0)
        region = np.zeros(len(origin) // mesh.k, "<i2")
        region[: held // mesh.k] = arrays.region[: held // mesh.k] * (origin[: held : mesh.k] >= 0)
        return cls(places, delta, flags, origin, twin, curve, parameter, region)

    @classmethod
    def none(cls) -> SlotArrays:
        """Arrays without slots."""
        return cls(
            np.zeros((0, 2), "<f4"),
            np.zeros(0, np.int8),
            np.zeros(0, np.uint8),
            np.zeros(0, "<i4"),
            np.zeros(0, "<i4"),
            np.full(0, -1, "<i4"),
            np.zeros(0, "<f8"),
            np.zeros(0, "<i2"),
        )

    @property
    def buffers(self) -> list[bytes]:
        """All arrays, in the order of a state message; no regions where all are the same."""
        seated = np.flatnonzero(self.curve >= 0)
        arrays = (
            self.places,
            self.delta,
            self.flags,
            self.origin,
            self.twin,
            seated.astype("<i4"),
            self.curve[seated],
            self.parameter[seated],
            self.region if self.region.any() else self.region[:0],
        )
        return [array.tobytes() for array in arrays]


class MeshSync:
    """The arrays that were sent last; the same for all views of a session.

    :attr:`revision` counts states and patches.
    """

    def __init__(self) -> None:
        self.revision = 0
        self.frame = CoordinateFrame()
        self._k = 3
        self._boundary = MeshBoundary()
        self._sent = SlotArrays.none()

    def reset(self, mesh: HalfEdgeMesh | None) -> None:
        """Start again with another mesh, or None; views need :meth:`state` next."""
        self.revision += 1
        self.frame, self._k = CoordinateFrame(), 3
        self._boundary, self._sent = MeshBoundary(), SlotArrays.none()
        if mesh is not None:
            self.frame, self._k = CoordinateFrame.of(mesh), mesh.k
            self._boundary = mesh.boundary_info
            self._sent = SlotArrays.of(mesh, self.frame)

    def state(self) -> Packet:
        """The message with the whole mesh, as it was sent last."""
        sent = self._sent
        content = {
            "type": "state",
            "version": VERSION,
            "revision": self.revision,
            "k": self._k,
            "vertices": len(sent.flags),
            "halfedges": len(sent.origin),
            "frame": {"cx": self.frame.cx, "cy": self.frame.cy, "scale": self.frame.scale},
            "regions": list(self._boundary.region_names),
        }
        return Packet(content, [*sent.buffers, *_curve_buffers(self._boundary, self.frame)])

    def patch(self, mesh: HalfEdgeMesh | None) -> Packet:
        """The message with all changes since the last message.

        Where it would be larger than the whole state: the state.
        """
        old = self._sent
        new = old
        if mesh is not None:
            new = SlotArrays.of(mesh, self.frame, len(old.flags), len(old.origin))
        changed = _differing((new.places, new.delta, new.flags), (old.places, old.delta, old.flags))
        turned = _differing((new.origin, new.twin), (old.origin, old.twin))
        reseated = _differing((new.curve, new.parameter), (old.curve, old.parameter), (-1, 0.0))
        renamed = _differing((new.region,), (old.region,), (0,))
        self._sent = new
        self.revision += 1
        buffers = [
            changed.astype("<i4").tobytes(),
            new.places[changed].tobytes(),
            new.delta[changed].tobytes(),
            new.flags[changed].tobytes(),
            turned.astype("<i4").tobytes(),
            new.origin[turned].tobytes(),
            new.twin[turned].tobytes(),
            reseated.astype("<i4").tobytes(),
            new.curve[reseated].tobytes(),
            new.parameter[reseated].tobytes(),
            renamed.astype("<i4").tobytes(),
            new.region[renamed].tobytes(),
        ]
        content = {
            "type": "patch",
            "from": self.revision - 1,
            "to": self.revision,
            "vertices": len(new.flags),
            "halfedges": len(new.origin),
        }
        packet = Packet(content, buffers)
        if mesh is not None and mesh.boundary_info is not self._boundary:
            self._boundary = mesh.boundary_info  # another mesh, or one that was renumbered
            return self.state()
        whole = 10 * len(new.flags) + 8 * len(new.origin)
        return self.state() if packet.size > whole else packet


def _curve_buffers(boundary: MeshBoundary, frame: CoordinateFrame) -> list[bytes]:
    """The curves in the order of a state message, and the regions and ends of interfaces."""
    curves = boundary.curves
    return [
        frame.control(curves).tobytes(),
        curves.first_control.astype("<i4").tobytes(),
        curves.start.astype("<f8").tobytes(),
        curves.stop.astype("<f8").tobytes(),
        curves.first_span.astype("<i4").tobytes(),
        curves.closed.astype(np.uint8).tobytes(),
        boundary.table().astype("<i4").tobytes(),
    ]


def _differing(
    new: Sequence[np.ndarray], old: Sequence[np.ndarray], unset: Sequence[float] | None = None
) -> np.ndarray:
    """Indices where any array differs from the older one, to the bit.

    New slots always differ; with ``unset`` where they do from these values.
    """
    count = len(old[0])
    differs = np.ones(len(new[0]), dtype=bool)
    differs[:count] = False
    if unset is not None:
        pairs = [now[count:] != value for now, value in zip(new, unset, strict=True)]
        differs[count:] = np.any(pairs, axis=0)
    for now, before in zip(new, old, strict=True):
        # floats are compared as bits, so that NaN equals itself
        a, b = (_bits(x) for x in (now[:count], before))
        unlike = a != b
        differs[:count] |= unlike.any(axis=1) if unlike.ndim == 2 else unlike
    return np.flatnonzero(differs)


def _bits(values: np.ndarray) -> np.ndarray:
    return values.view(f"<u{values.itemsize}") if values.dtype.kind == "f" else values
