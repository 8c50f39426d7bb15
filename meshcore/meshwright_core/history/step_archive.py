"""Packed steps of a long history: the journal holds only those near the present state.

One archive belongs to one mesh. Its `past` are done steps before the journal's first, its `future`
undone steps after the journal's last; both are lists of
:class:`~meshwright_core.history.packed_steps.Steps` in order.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from meshwright_core.core.arrays import (
    JOURNAL_TOP,
    STEP,
    STEP_COLUMNS,
    STEP_END,
    STEP_START,
    STEP_STOP,
    MeshArrays,
)
from meshwright_core.errors import MeshError
from meshwright_core.history.packed_steps import Steps, pieces, unpack

PIECE = 64
"""Steps that are packed together."""
LOOSE = 4 * PIECE
"""Steps on either side of the present beyond which the farther ones are packed."""
ENTRIES = 1 << 17
"""Journal entries on either side beyond which they are packed too, however few the steps."""


class Archive:
    """Packed steps on both sides of those that a journal holds.

    Attributes:
        done: how many steps of the past there are.
        undone: how many of the future.
    """

    def __init__(self, past: Sequence[Steps] = (), future: Sequence[Steps] = ()) -> None:
        self._past = list(past)
        self._future = list(future)
        # kept, because they are asked for in each step
        self.done = sum(map(len, self._past))
        self.undone = sum(map(len, self._future))

    @property
    def past(self) -> Sequence[Steps]:
        """Done steps before the journal's first."""
        return self._past

    @property
    def future(self) -> Sequence[Steps]:
        """Undone steps after the journal's last."""
        return self._future

    def copy(self) -> Archive:
        """Another archive of the same steps."""
        return Archive(self._past, self._future)

    def replace_future(self, future: Sequence[Steps] = ()) -> None:
        """Forget the steps of the future, and take these instead."""
        self._future = list(future)
        self.undone = sum(map(len, self._future))

    def fetch_past(self, m: MeshArrays) -> MeshArrays:
        """Move the last steps of the past to the front of the journal; there must be some."""
        piece = self._past.pop()
        self.done -= len(piece)
        rows, entries = held(m)
        return with_journal(m, *_joined(piece, rows, entries), int(m.counters[STEP]) + len(piece))

    def fetch_future(self, m: MeshArrays) -> MeshArrays:
        """Move the first steps of the future to the end of the journal; there must be some."""
        rows, entries = held(m)
        piece = self._future.pop(0)
        self.undone -= len(piece)
        more_rows, more_entries = unpack(piece, len(entries))
        rows, entries = np.concatenate([rows, more_rows]), np.concatenate([entries, more_entries])
        return with_journal(m, rows, entries, int(m.counters[STEP]))

    def trimmed(self, m: MeshArrays) -> MeshArrays:
        """Pack the journal's steps that are far from the present; returns the shorter arrays."""
        step, end = int(m.counters[STEP]), int(m.counters[STEP_END])
        top = int(m.steps[step - 1, STEP_STOP]) if step else 0
        all_entries = int(m.steps[end - 1, STEP_STOP]) if end else 0
        first = step // 2 if step > LOOSE or (top > ENTRIES and step > 1) else 0
        ahead = end - step
        crowded = ahead > LOOSE or (all_entries - top > ENTRIES and ahead > 1)
        last = step + ahead // 2 if crowded else end
        if first == 0 and last == end:
            return m
        rows, entries = held(m)
        self._past += pieces(rows[:first], entries, PIECE)
        self._future[:0] = pieces(rows[last:], entries, PIECE)
        self.done += first
        self.undone += end - last
        kept = rows[first:last].copy()
        start = int(kept[0, STEP_START])
        stop = int(kept[-1, STEP_STOP])
        kept[:, STEP_START : STEP_STOP + 1] -= start
        return with_journal(m, kept, entries[start:stop], step - first)

    def everything(self, m: MeshArrays) -> tuple[list[Steps], list[Steps]]:
        """All done and all undone steps, those of the journal among them; nothing changes."""
        rows, entries = held(m)
        step = int(m.counters[STEP])
        done = self._past + pieces(rows[:step], entries, PIECE)
        return done, pieces(rows[step:], entries, PIECE) + self._future


def held(m: MeshArrays) -> tuple[np.ndarray, np.ndarray]:
    """Views of the rows and entries that the journal holds, undone ones included."""
    end = int(m.counters[STEP_END])
    return m.steps[:end], m.journal[: int(m.steps[end - 1, STEP_STOP]) if end else 0]


def cut_undone(m: MeshArrays) -> list[Steps]:
    """Take the undone steps out of the journal."""
    rows, entries = held(m)
    step = int(m.counters[STEP])
    cut = pieces(rows[step:], entries, PIECE)
    m.counters[STEP_END] = step
    return cut


def _joined(piece: Steps, rows: np.ndarray, entries: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    before_rows, before_entries = unpack(piece)
    rows = rows.copy()
    rows[:, STEP_START : STEP_STOP + 1] += len(before_entries)
    return np.concatenate([before_rows, rows]), np.concatenate([before_entries, entries])


def with_journal(m: MeshArrays, rows: np.ndarray, entries: np.ndarray, step: int) -> MeshArrays:
    """The arrays with a journal of just these rows and entries, `step` of the rows done."""
    if step > len(rows):
        raise MeshError("a history cannot have more done steps than steps")
    journal = np.zeros((max(1024, len(entries) * 5 // 4), 2), np.int64)
    journal[: len(entries)] = entries
    steps = np.zeros((max(64, len(rows) * 5 // 4), STEP_COLUMNS), np.int64)
    steps[: len(rows)] = rows
    m.counters[STEP], m.counters[STEP_END] = step, len(rows)
    m.counters[JOURNAL_TOP] = int(rows[step - 1, STEP_STOP]) if step else 0
    return m._replace(journal=journal, steps=steps)
