"""Checks that a history from a file leads to sound meshes only: undone, redone, on every branch.

Each state is checked at the cost of what its step changes: see
:mod:`meshwright_core.history.state_checks`. Histories from before meshes had curves hold no seats;
those are projected after each step, as an undo does, and checked as a whole.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from typing import Any, Protocol, cast

import numba
import numpy as np

from meshwright_core.core.arrays import (
    END,
    JOURNAL_TOP,
    LEFT,
    START,
    STEP,
    STEP_END,
    MeshArrays,
    allocate,
    copied,
)
from meshwright_core.core.curve_checks import require_seats
from meshwright_core.core.mesh_boundary import MeshBoundary
from meshwright_core.core.projected_seats import take_projected_seats
from meshwright_core.errors import MeshError
from meshwright_core.history import state_checks
from meshwright_core.history.packed_steps import Steps, pack, unpack
from meshwright_core.history.step_archive import with_journal
from meshwright_core.mesh import HalfEdgeMesh

_JOURNAL = (STEP, STEP_END, JOURNAL_TOP)


class Fork(Protocol):
    """Steps that follow the state at cursor ``at``, beside those of the history itself."""

    @property
    def at(self) -> int:
        """The number of steps before it, counted from the start of the history."""

    @property
    def steps(self) -> Sequence[Steps]:
        """Its steps, undone."""

    @property
    def branches(self) -> Sequence[Fork]:
        """Forks that start on one of its steps."""


def require_history(mesh: HalfEdgeMesh, forks: Sequence[Fork] = ()) -> None:
    """Raise MeshError if undo, redo or a fork of the mesh's history leads to a broken mesh.

    The mesh itself must be sound, and all steps within its arrays
    (:func:`meshwright_core.io.snapshot_checks.require_within`).
    """
    done, undone = mesh.packed_steps()
    if not (done or undone or forks):
        return
    cursor = sum(map(len, done))
    _Walk(mesh).along(done, False, cursor, _by_cursor(f for f in forks if f.at <= cursor))
    _Walk(mesh).along(undone, True, cursor, _by_cursor(f for f in forks if f.at > cursor))


def _by_cursor(forks: Iterable[Fork]) -> dict[int, list[Fork]]:
    found: dict[int, list[Fork]] = {}
    for fork in forks:
        found.setdefault(fork.at, []).append(fork)
    return found


class _Walk:
    """A copy of a mesh that is taken along its history."""

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        self._m: MeshArrays = copied(mesh.arrays)
        self._boundary: MeshBoundary = mesh.boundary_info
        self._recorded = mesh.seats_recorded
        table = self._m.interface
        ends = table[table[:, LEFT] >= 0][:, (START, END)].ravel()
        regions = len(self._boundary.region_names)
        self._carried = state_checks.carried(
            self._m, ends[ends >= 0], self._recorded and self._boundary.count > 0, regions
        )
        _require(_walk()(self._m, self._carried, 0, 1))

    def along(
        self, steps: Sequence[Steps], forward: bool, at: int, forks: Mapping[int, Sequence[Fork]]
    ) -> list[Steps]:
        """Do or undo steps, the first or last of which is next to the present state at cursor `at`,
        and visit each fork on the way; returns the steps as they are then.
        """
        left_behind = []
        self._visit(forks.get(at, ()))
        for piece in steps if forward else reversed(steps):
            rows, entries = unpack(piece)
            self._m = with_journal(self._m, rows, entries, 0 if forward else len(rows))
            stop = at + len(rows) if forward else at - len(rows)
            stops = {stop, *(c for c in forks if min(at, stop) < c < max(at, stop))}
            for next_stop in sorted(stops, reverse=not forward):
                self._advance(abs(next_stop - at), forward)
                at = next_stop
                self._visit(forks.get(at, ()))
            left_behind.append(pack(self._m.steps[: len(rows)], self._m.journal[: len(entries)]))
        return left_behind if forward else left_behind[::-1]

    def _advance(self, count: int, forward: bool) -> None:
        at_once = count if self._recorded else 1
        for _ in range(0, count, at_once):
            _require(_walk()(self._m, self._carried, at_once, int(forward)))
            if not self._recorded:
                self._project()

    def _project(self) -> None:
        seen = HalfEdgeMesh(self._m, self._boundary)
        take_projected_seats(self._m, seen.boundary_loops(), self._boundary)
        require_seats(self._m, self._boundary)

    def _visit(self, forks: Sequence[Fork]) -> None:
        """Take each fork to its end and come back."""
        for fork in forks:
            here = self._m
            journal = here.counters[list(_JOURNAL)]
            kept = self.along(fork.steps, True, fork.at, _by_cursor(fork.branches))
            end = fork.at + sum(map(len, fork.steps))
            self.along(kept, False, end, {})
            self._m = here
            here.counters[list(_JOURNAL)] = journal


@cache
def _walk() -> Callable[..., int]:
    """What runs :func:`state_checks.walk`, compiled for writable arrays alone: those of files are
    read-only, which would be other types.
    """
    m = allocate(3, 1, 1)
    known = state_checks.carried(m, np.zeros(0, np.int64), True, 1)
    types = (numba.typeof(m), numba.typeof(known), numba.int64, numba.int64)
    compiled: Any = state_checks.walk
    return cast(Callable[..., int], compiled.compile(types))


def _require(wrong: int) -> None:
    if wrong:
        reason = state_checks.WORDS[wrong]
        raise MeshError(f"its history leads to a broken mesh: {reason}")
