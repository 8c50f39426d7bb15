"""Steps taken out of a journal and packed into a third of the memory, exact to the bit.

A journal holds 16 bytes for each write. A packed step needs less: the place of a write and an
integer take 4 bytes each before they are compressed, and a moved vertex is one place with its two
coordinates (three off the plane z = 0). Coordinates, and parameters on curves, keep their 8 bytes:
their last digits do not compress. Done steps hold the values before them, undone steps the values
after them, as in :mod:`meshwright_core.history.journal`; the order of writes is kept.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshwright_core.core.arrays import (
    RESTORED,
    STEP,
    STEP_COLUMNS,
    STEP_COUNTERS,
    STEP_HALFEDGE,
    STEP_OPERATION,
    STEP_START,
    STEP_STOP,
    VERTEX_COLUMNS,
    MeshArrays,
)
from meshwright_core.errors import MeshError
from meshwright_core.history.journal import (
    EDGE_WRITE,
    LIST_WRITE,
    PARAMETER_WRITE,
    POINT_WRITE,
    REGION_WRITE,
    VERTEX_WRITE,
    WRITE_KINDS,
)

LENGTH, OPERATION, HALFEDGE, COUNTERS = 0, 1, 2, 3
COLUMNS = COUNTERS + RESTORED


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """Consecutive steps of one journal, first one first; made by :func:`pack`."""

    count: int
    """n, their number."""
    packed_rows: bytes
    packed_places: bytes
    packed_whole: bytes
    coordinates: np.ndarray
    """(p, 2|3) float64: values of the moves, in order; without z where all z are 0."""
    parameters: np.ndarray
    """(t,) float64: values of the writes of parameters on curves, in order."""

    @classmethod
    def of(
        cls,
        rows: np.ndarray,
        places: np.ndarray,
        whole: np.ndarray,
        coordinates: np.ndarray,
        parameters: np.ndarray,
    ) -> Steps:
        """Steps of these arrays, as the attributes of the same names describe them."""
        whole_numbers = (_compressed(rows), _compressed(places), _compressed(whole))
        return cls(len(rows), *whole_numbers, coordinates, parameters)

    @property
    def rows(self) -> np.ndarray:
        """(n, 13) int32: number of journal entries, operation, half-edge, restored counters."""
        return _decompressed(self.packed_rows).reshape(-1, COLUMNS)

    @property
    def places(self) -> np.ndarray:
        """(w,) int32: what each write was to; a moved vertex is one write, to its x."""
        return _decompressed(self.packed_places)

    @property
    def whole(self) -> np.ndarray:
        """(i,) int32: values of the writes of integers, in order."""
        return _decompressed(self.packed_whole)

    def __len__(self) -> int:
        return self.count

    @property
    def nbytes(self) -> int:
        """Bytes that they take."""
        whole_numbers = len(self.packed_rows) + len(self.packed_places) + len(self.packed_whole)
        return whole_numbers + int(self.coordinates.nbytes + self.parameters.nbytes)


def _compressed(numbers: np.ndarray) -> bytes:
    """The bytes of int32 numbers, lowest ones first and highest ones last, which repeat most."""
    numbers = np.ascontiguousarray(numbers, dtype=np.int32)
    return zlib.compress(numbers.view(np.uint8).reshape(-1, 4).T.tobytes(), level=1)


def _decompressed(packed: bytes) -> np.ndarray:
    """The numbers (n,) int32 that :func:`_compressed` was given."""
    by_place = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(4, -1)
    return np.ascontiguousarray(by_place.T).view(np.int32).ravel()


def pack(rows: np.ndarray, entries: np.ndarray) -> Steps:
    """Steps from rows (n, 14) of a mesh's `steps` and the entries (j, 2) that they span.

    Raises MeshError if moves are not written as x, y and z of one vertex after another.
    """
    writes = np.flatnonzero(entries[:, 0] % WRITE_KINDS == POINT_WRITE)
    if len(writes) % 3:
        raise MeshError("a move in the history is cut off")
    moved = writes.reshape(-1, 3)
    axes = entries[moved, 0] // WRITE_KINDS
    triples = (moved == moved[:, :1] + np.arange(3)).all()
    if not triples or not (axes == axes[:, :1] // 3 * 3 + np.arange(3)).all():
        raise MeshError("a move in the history is not of one vertex")
    single = np.ones(len(entries), bool)
    single[moved.ravel()] = False
    first = single.copy()
    first[moved[:, 0]] = True
    slid = entries[:, 0] % WRITE_KINDS == PARAMETER_WRITE
    coordinates = entries[moved, 1].view(np.float64)
    if not entries[moved[:, 2], 1].any():
        coordinates = coordinates[:, :2].copy()
    packed = np.empty((len(rows), COLUMNS), np.int32)
    packed[:, LENGTH] = rows[:, STEP_STOP] - rows[:, STEP_START]
    packed[:, OPERATION] = rows[:, STEP_OPERATION]
    packed[:, HALFEDGE] = rows[:, STEP_HALFEDGE]
    packed[:, COUNTERS:] = rows[:, STEP_COUNTERS:]
    return Steps.of(
        packed,
        entries[first, 0].astype(np.int32),
        entries[single & ~slid, 1].astype(np.int32),
        coordinates,
        entries[slid, 1].copy().view(np.float64),
    )


def unpack(steps: Steps, start: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Rows (n, 14) and entries (j, 2) as a mesh holds them, the first entry at place `start`.

    Raises MeshError if the arrays do not fit together.
    """
    rows, places, whole = steps.rows, steps.places.astype(np.int64), steps.whole
    moved = places % WRITE_KINDS == POINT_WRITE
    slid = places % WRITE_KINDS == PARAMETER_WRITE
    width = np.where(moved, 3, 1)
    at = np.cumsum(width) - width
    total = int(width.sum())
    lengths = rows[:, LENGTH].astype(np.int64)
    moves, slides = int(moved.sum()), int(slid.sum())
    if (lengths < 0).any() or lengths.sum() != total:
        raise MeshError("a step of the history has another length than it states")
    held = len(steps.coordinates), len(steps.parameters), len(whole)
    if held != (moves, slides, len(places) - moves - slides):
        raise MeshError("the history lacks some of its values")
    entries = np.zeros((total, 2), np.int64)
    entries[at[~moved], 0] = places[~moved]
    entries[at[~(moved | slid)], 1] = whole
    entries[at[slid], 1] = np.ascontiguousarray(steps.parameters).view(np.int64)
    bits = np.ascontiguousarray(steps.coordinates).view(np.int64)
    for axis in range(3):
        entries[at[moved] + axis, 0] = places[moved] + axis * WRITE_KINDS
        if axis < bits.shape[1]:
            entries[at[moved] + axis, 1] = bits[:, axis]
    stops = start + np.cumsum(lengths)
    unpacked = np.empty((len(rows), STEP_COLUMNS), np.int64)
    unpacked[:, STEP_START] = stops - lengths
    unpacked[:, STEP_STOP] = stops
    unpacked[:, STEP_OPERATION] = rows[:, OPERATION]
    unpacked[:, STEP_HALFEDGE] = rows[:, HALFEDGE]
    unpacked[:, STEP_COUNTERS:] = rows[:, COUNTERS:]
    return unpacked, entries


def last_done(m: MeshArrays) -> Steps:
    """The last done step with the values after it, as if it had just been undone.

    A place that it wrote twice has the last value at both: swapped in and out, that comes to the
    same.
    """
    row = m.steps[int(m.counters[STEP]) - 1]
    entries = m.journal[row[STEP_START] : row[STEP_STOP]].copy()
    index, written = entries[:, 0] // WRITE_KINDS, entries[:, 0] % WRITE_KINDS
    for form, values, width in (
        (EDGE_WRITE, m.edge, 2),
        (VERTEX_WRITE, m.vertex, VERTEX_COLUMNS),
        (POINT_WRITE, m.points.view(np.int64), 3),
        (LIST_WRITE, m.irregular[:, None], 1),
        (PARAMETER_WRITE, m.parameter.view(np.int64)[:, None], 1),
        (REGION_WRITE, m.region[:, None], 1),
    ):
        these = written == form
        at = index[these]
        entries[these, 1] = values[at // width, at % width]
    after = row.copy()
    after[STEP_START : STEP_STOP + 1] -= row[STEP_START]
    after[STEP_COUNTERS:] = m.counters[:RESTORED]
    return pack(after[None], entries)


def joined(parts: Sequence[Steps]) -> Steps:
    """All steps of `parts` as one."""
    deep = max((piece.coordinates.shape[1] for piece in parts), default=2)
    return Steps.of(
        np.concatenate([np.zeros((0, COLUMNS), np.int32), *(piece.rows for piece in parts)]),
        np.concatenate([np.zeros(0, np.int32), *(piece.places for piece in parts)]),
        np.concatenate([np.zeros(0, np.int32), *(piece.whole for piece in parts)]),
        np.concatenate([np.zeros((0, deep)), *(_deep(piece, deep) for piece in parts)]),
        np.concatenate([np.zeros(0), *(piece.parameters for piece in parts)]),
    )


def _deep(piece: Steps, width: int) -> np.ndarray:
    coordinates = np.zeros((len(piece.coordinates), width))
    coordinates[:, : piece.coordinates.shape[1]] = piece.coordinates
    return coordinates


def first_steps(parts: Sequence[Steps], count: int) -> list[Steps]:
    """The first `count` steps of `parts`, all if there are fewer."""
    return _some(parts, 0, count)


def last_steps(parts: Sequence[Steps], count: int) -> list[Steps]:
    """The last `count` steps of `parts`, all if there are fewer."""
    held = sum(map(len, parts))
    return _some(parts, max(0, held - count), held)


def _some(parts: Sequence[Steps], start: int, stop: int) -> list[Steps]:
    """Steps `start` up to `stop` of all in `parts`."""
    found = []
    at = 0
    for piece in parts:
        first, last = max(0, start - at), min(len(piece), stop - at)
        at += len(piece)
        if last - first == len(piece):
            found.append(piece)
        elif first < last:
            rows, entries = unpack(piece)
            found += pieces(rows[first:last], entries, last - first)
    return found


def divided(steps: Steps, size: int) -> list[Steps]:
    """The same steps in pieces of up to `size`; MeshError if the arrays do not fit together."""
    return pieces(*unpack(steps), size)


def pieces(rows: np.ndarray, entries: np.ndarray, size: int) -> list[Steps]:
    """Rows of a journal with these entries, packed up to `size` at a time."""
    packed = []
    for first in range(0, len(rows), size):
        some = rows[first : first + size]
        packed.append(pack(some, entries[some[0, STEP_START] : some[-1, STEP_STOP]]))
    return packed
