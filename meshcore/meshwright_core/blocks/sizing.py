"""How a block structure is divided: target sizes, given numbers, and layers of cells at walls."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from meshwright_core.analysis.chord_counts import Sum, chord_counts
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.core.grid_plan import Grading, GridPlan
from meshwright_core.errors import MeshError
from meshwright_core.geometry.turning import CurveTurning

ALONG = 30.0
"""Cells along the side of a square as large as the domain, where no size is given."""
TURN = math.radians(15.0)
"""Radians that a cell's side turns at most along a curve, where no size is given."""
ACROSS = 3.0
"""Cells across a block, at least, where no size is given."""
MOST_CELLS = 50_000_000
"""Cells that a grid may have."""
THINNEST = 1e-12
"""The lowest first cell, relative to the largest coordinate: rounding spoils thinner ones."""
EVERY_SIDE = "all"
"""In place of the name of a side: every one."""
STEEPEST = 10.0
"""The largest ratio of growth that is taken."""


class GridConflictError(MeshError):
    """Wishes for numbers of cells that no grid meets."""

    def __init__(self, words: str, chords: list[int]) -> None:
        super().__init__(words)
        self.chords = chords
        """The chords that they are about."""


@dataclass(frozen=True)
class WallLayer:
    """Thin cells along a named side."""

    name: str
    """Of the patch; "all" for every side."""
    height: float
    """Of the first cell, above 0."""
    ratio: float = 1.2
    """From one cell to the next, 1 to 10."""

    def __post_init__(self) -> None:
        if not (self.height > 0.0 and math.isfinite(self.height)):
            raise MeshError(f"The first cell at {self.name} needs a height above 0.")
        if not 1.0 <= self.ratio <= STEEPEST:
            raise MeshError(f"The ratio of growth at {self.name} must be 1 to {STEEPEST:g}.")


@dataclass(frozen=True)
class Sizing:
    """What is wanted. Without a size, a division or numbers the geometry decides: 30 cells along
    the side of a square of the same area, 15 degrees of a curve and a third of a block's width for
    a cell at most.
    """

    size: float | None = None
    """Length of a cell."""
    side_sizes: Mapping[str, float] = field(default_factory=dict)
    """Length of a cell on named sides."""
    divide: int | None = None
    """Cells along every block edge; excludes sizes."""
    walls: tuple[WallLayer, ...] = ()
    """Layers at walls."""
    side_counts: Mapping[str, int] = field(default_factory=dict)
    """Cells on named sides in all."""
    edge_counts: Mapping[tuple[int, int], int] = field(default_factory=dict)
    """Cells on block edges, by the ids of their two vertices; they hold for the whole chord."""
    chord_counts: Mapping[int, int] = field(default_factory=dict)
    """Cells across chords."""
    edge_gradings: Mapping[tuple[int, int], Grading] = field(default_factory=dict)
    """Gradings of block edges, by the ids of their first and last vertex; they hold for the whole
    chord, in place of layers at walls."""

    @classmethod
    def planned(cls, structure: BlockStructure, plan: GridPlan) -> Sizing:
        """The wishes kept with a mesh; those for sides and edges that there are no longer are left
        out, and where a chord has several gradings the first one counts.

        Raises GridConflictError if a chord has several numbers of cells.
        """
        names = {name for patch in structure.patches for name in (patch.name, patch.title)}
        counts: dict[int, int] = {}
        for (a, b), count in plan.counts.items():
            edge = structure.edge_between(a, b)
            if edge < 0:
                continue
            chord = int(structure.chord[edge])
            if counts.setdefault(chord, count) != count:
                raise GridConflictError(
                    f"Chord {chord} has both {counts[chord]} and {count} cells since blocks were "
                    "joined: set its number of cells again.",
                    [chord],
                )
        gradings: dict[int, tuple[tuple[int, int], Grading]] = {}
        for ends, grading in plan.gradings.items():
            edge = structure.edge_between(*ends)
            if edge >= 0:
                gradings.setdefault(int(structure.chord[edge]), (ends, grading))
        return cls(
            size=plan.size,
            divide=plan.divide,
            walls=tuple(
                WallLayer(*wall) for wall in plan.walls if wall.name in names | {EVERY_SIDE}
            ),
            side_counts={name: n for name, n in plan.side_counts.items() if name in names},
            chord_counts=counts,
            edge_gradings=dict(gradings.values()),
        )

    def over(self, other: Sizing) -> Sizing:
        """These wishes, and others where there are none of these."""
        sized = self.size is not None or self.divide is not None or bool(self.side_sizes)
        amounts = self if sized else other
        return replace(
            self,
            size=amounts.size,
            divide=amounts.divide,
            side_sizes=amounts.side_sizes,
            walls=self.walls or other.walls,
            side_counts={**other.side_counts, **self.side_counts},
            edge_counts={**other.edge_counts, **self.edge_counts},
            chord_counts={**other.chord_counts, **self.chord_counts},
            edge_gradings={**other.edge_gradings, **self.edge_gradings},
        )


@dataclass(frozen=True, eq=False)
class Division:
    """The cells of each chord and how they are graded."""

    counts: np.ndarray
    """(c,) int64."""
    first: np.ndarray
    """(c,) height of the first cell at the start of the chord's edges, 0 where it is free."""
    last: np.ndarray
    """(c,) at their end."""
    ratio: np.ndarray
    """(c,) growth from cell to cell, at least 1."""


def division(structure: BlockStructure, sizing: Sizing) -> Division:
    """The numbers of cells and the grading of all chords.

    Raises MeshError, one sentence: sizes out of range, a side that does not exist, numbers that
    contradict each other, more than :data:`MOST_CELLS` cells.
    """
    _require_positive(sizing)
    _require_resolved(structure, sizing)
    first, last, ratio = _layers(structure, sizing.walls)
    _grade(structure, sizing, first, last, ratio)
    chord = structure.chord
    if sizing.divide is not None:
        wanted = np.full(len(chord), float(sizing.divide))
    else:
        size = _edge_sizes(structure, sizing)
        wanted = structure.lengths / size
        if sizing.size is None and not sizing.side_sizes:
            turns = structure.parts.turning(CurveTurning.of(structure.mesh))
            wanted = np.maximum(np.maximum(wanted, turns / TURN), ACROSS)
        layered = np.flatnonzero((first[chord] > 0.0) | (last[chord] > 0.0))
        for edge in layered:
            c = chord[edge]
            length = structure.lengths[edge]
            here = min(size[edge], length / wanted[edge])
            wanted[edge] = layer_cells(length, here, first[c], last[c], ratio[c])
    wanted = np.clip(wanted, 1e-3, 1e7)
    fixed = _fixed(structure, sizing)
    sums = _sums(structure, sizing)
    try:
        counts = chord_counts(chord, wanted, fixed=fixed, sums=[one for _, one in sums])
    except MeshError as error:
        raise _conflict(sums, fixed, str(error)) from error
    cells = float(counts[structure.crossing].astype(float).prod(axis=1).sum())
    if cells > MOST_CELLS:
        raise MeshError(f"That makes {cells:,.0f} cells; at most {MOST_CELLS:,} are made.")
    return Division(counts, first, last, ratio)


def layer_cells(length: float, size: float, first: float, last: float, ratio: float) -> float:
    """How many cells a line of this length takes whose cells grow by `ratio` from the heights at
    its ends, 0 for none, up to `size`.
    """
    ends = [height for height in (first, last) if 0.0 < height < size]
    if not ends:
        return max(length / size, 1e-9)
    if ratio <= 1.0:
        return length / min(ends)

    def cells(top: float) -> tuple[float, float]:
        """Number and length of the layers whose cells grow up to `top`."""
        number, covered = 0.0, 0.0
        for height in ends:
            steps = max(math.log(top / height) / math.log(ratio), 0.0)
            number += steps
            covered += height * (ratio**steps - 1.0) / (ratio - 1.0)
        return number, covered

    number, covered = cells(size)
    if covered <= length:
        return number + (length - covered) / size
    low, high = min(ends), size
    for _ in range(60):
        middle = math.sqrt(low * high)
        if cells(middle)[1] < length:
            low = middle
        else:
            high = middle
    return max(cells(high)[0], 1.0)


def _require_positive(sizing: Sizing) -> None:
    if sizing.divide is not None and (sizing.size is not None or sizing.side_sizes):
        raise MeshError("Give a size of the cells or the number of cells along an edge, not both.")
    if sizing.divide is not None and sizing.divide < 1:
        raise MeshError("An edge is divided into at least 1 cell.")
    for size in (sizing.size, *sizing.side_sizes.values()):
        if size is not None and not (size > 0.0 and math.isfinite(size)):
            raise MeshError("The size of a cell must be above 0.")
    every = (sizing.side_counts, sizing.edge_counts, sizing.chord_counts)
    if any(count < 1 for counts in every for count in counts.values()):
        raise MeshError("A number of cells must be at least 1.")
    most = max((count for counts in every for count in counts.values()), default=0)
    if max(most, sizing.divide or 0) > MOST_CELLS:
        raise MeshError(
            f"Along one edge {max(most, sizing.divide or 0):,} cells are wanted; at most "
            f"{MOST_CELLS:,} are made in all."
        )


def _require_resolved(structure: BlockStructure, sizing: Sizing) -> None:
    largest = float(np.abs(structure.points).max())
    heights = [(f"at {wall.name}", wall.height) for wall in sizing.walls]
    for (a, b), grading in sizing.edge_gradings.items():
        heights += [(f"along edge {a}-{b}", height) for height in (grading.first, grading.last)]
    for where, height in heights:
        if 0.0 < height < THINNEST * largest:
            raise MeshError(
                f"The first cell {where} of {height:g} is too thin: at coordinates up to "
                f"{largest:g} it must be at least {THINNEST * largest:.2g}."
            )


def _edge_sizes(structure: BlockStructure, sizing: Sizing) -> np.ndarray:
    """(e,) the size of a cell on each edge. Sizes on sides grow away from them block by block."""
    if sizing.size is None:
        area = abs(_area(structure))
        size = np.full(len(structure.edges), math.sqrt(area) / ALONG)
    else:
        size = np.full(len(structure.edges), sizing.size)
    for name, own in sizing.side_sizes.items():
        size[structure.patch(name).edges] = own
    return size


def _area(structure: BlockStructure) -> float:
    corner = structure.points[structure.corners]
    cross = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    return float(0.5 * np.linalg.norm(cross, axis=1).sum())


def _layers(
    structure: BlockStructure, walls: tuple[WallLayer, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Heights at the start and at the end of each chord, and ratios: the least where several."""
    count = structure.chord_count
    heights = np.full((2, count), np.inf)
    ratio = np.full(count, np.inf)
    for wall in walls:
        for block, across, end in _away_from(structure, wall.name):
            chord = structure.crossing[block, across]
            heights[end, chord] = min(heights[end, chord], wall.height)
            ratio[chord] = min(ratio[chord], wall.ratio)
    first, last = np.where(np.isfinite(heights), heights, 0.0)
    return first, last, np.where(np.isfinite(ratio), ratio, 1.0)


def _away_from(structure: BlockStructure, name: str) -> Iterator[tuple[int, int, int]]:
    """For each block edge on a side: its block, the axis of the block that leads away from the
    side, and whether the side is at the start (0) or at the end (1) of that axis's chord.
    """
    patches = structure.patches if name == EVERY_SIDE else (structure.patch(name),)
    for edge in np.concatenate([patch.edges for patch in patches]).tolist():
        block = int(structure.neighbours[edge].max())
        side = int(np.flatnonzero(structure.sides[block] == edge)[0])
        across = (side + 1) % 2
        near_start = side in (0, 3)
        yield block, across, 0 if near_start == structure.forward[block, across] else 1


def flat_layers(structure: BlockStructure, sizing: Sizing, divided: Division) -> tuple[str, ...]:
    """The layers at walls, and gradings of edges, that have no effect, or not everywhere, since the
    cells there are thinner already than the first cell that is wished: a sentence each.
    """
    said = []
    for a, b in sizing.edge_gradings:
        edge = structure.edge_between(a, b)
        chord = int(structure.chord[edge])
        even = float(structure.lengths[edge]) / float(divided.counts[chord])
        highest = float(max(divided.first[chord], divided.last[chord]))
        if highest >= even:
            said.append(
                f"The grading of chord {chord} has no effect where its first cell of {highest:g} "
                f"would be longer than even cells, {even:.3g}."
            )
    for wall in sizing.walls:
        flat, thinnest, every = 0, math.inf, 0
        for block, across, end in _away_from(structure, wall.name):
            chord = structure.crossing[block, across]
            # the lower cells of another wall, or a grading, are not this wall's
            if (divided.first, divided.last)[end][chord] != wall.height:
                continue
            every += 1
            sides = structure.sides[block, [across, across + 2]]
            even = float(structure.lengths[sides].max()) / float(divided.counts[chord])
            if wall.height >= even:
                flat, thinnest = flat + 1, min(thinnest, even)
        if flat:
            where = "" if flat == every else f" along {flat} of its {every} block edges"
            said.append(
                f"The layer at {wall.name} has no effect{where}: its first cell of "
                f"{wall.height:g} would be higher than the cells there, {thinnest:.3g}."
            )
    return tuple(said)


def _grade(
    structure: BlockStructure,
    sizing: Sizing,
    first: np.ndarray,
    last: np.ndarray,
    ratio: np.ndarray,
) -> None:
    """Write the gradings of edges over those of walls."""
    for (a, b), grading in sizing.edge_gradings.items():
        edge = structure.edge_between(a, b)
        if edge < 0:
            raise MeshError(f"There is no block edge between vertices {a} and {b}.")
        if min(grading.first, grading.last) < 0.0 or not 1.0 <= grading.ratio <= STEEPEST:
            raise MeshError(
                f"The grading of edge {a}-{b} needs lengths above 0 and a growth of 1 to "
                f"{STEEPEST:g}."
            )
        ahead = int(structure.vertices[structure.edges[edge, 0]]) == a
        along = grading if ahead else grading.turned
        chord = int(structure.chord[edge])
        first[chord], last[chord], ratio[chord] = along


def _fixed(structure: BlockStructure, sizing: Sizing) -> dict[int, int]:
    """Given numbers by chord. Raises MeshError where two of them contradict each other."""
    fixed: dict[int, int] = {}
    said: dict[int, str] = {}

    def note(chord: int, count: int, where: str) -> None:
        if fixed.setdefault(chord, count) != count:
            raise GridConflictError(
                f"{said[chord]} and {where} are on chord {chord}, and it cannot have both "
                f"{fixed[chord]} and {count} cells.",
                [chord],
            )
        said.setdefault(chord, where)

    for chord, count in sizing.chord_counts.items():
        if not 0 <= chord < structure.chord_count:
            raise MeshError(
                f"There is no chord {chord}; there are 0 to {structure.chord_count - 1}."
            )
        note(chord, count, f"chord {chord}")
    for (a, b), count in sizing.edge_counts.items():
        edge = structure.edge_between(a, b)
        if edge < 0:
            raise MeshError(f"There is no block edge between vertices {a} and {b}.")
        note(int(structure.chord[edge]), count, f"edge {a}-{b}")
    return fixed


def _sums(structure: BlockStructure, sizing: Sizing) -> list[tuple[str, Sum]]:
    found = []
    for name, total in sizing.side_counts.items():
        chords = structure.chord[structure.patch(name).edges]
        if len(chords) > total:
            raise GridConflictError(
                f"The side {name} consists of {len(chords)} block edges, and cannot have "
                f"{total} cell{'s' * (total > 1)}.",
                np.unique(chords).tolist(),
            )
        found.append((f"{total} cells on {name}", Sum(chords.tolist(), total)))
    return found


def _conflict(sums: list[tuple[str, Sum]], fixed: dict[int, int], reason: str) -> GridConflictError:
    """Why numbers contradict each other: one side alone where that is enough to see it."""
    for words, one in sums:
        chords, often = np.unique(np.array(one.chords, np.int64), return_counts=True)
        given = np.array([chord in fixed for chord in chords.tolist()])
        taken = sum(
            fixed[chord] * n for chord, n in zip(chords.tolist(), often.tolist(), strict=True)
            if chord in fixed
        )  # fmt: skip
        left, free = int(one.total or 0) - taken, often[~given]
        pinned = " and ".join(
            f"{fixed[chord]} on chord {chord}" for chord in chords[given].tolist()
        )
        if not len(free) and left:
            said = f"{words} and {pinned} contradict each other: together those make {taken}."
        elif left < int(free.sum()):
            said = f"{words} leave too few for its other block edges beside {pinned}."
        elif len(free) and left % int(np.gcd.reduce(free)):
            step = int(np.gcd.reduce(free))
            rest = f" beside {pinned}" if pinned else ""
            what = "an even number" if step == 2 else f"a multiple of {step}"
            said = (
                f"{words} cannot be: each chord that ends there does so {step} times, so{rest} "
                f"it must be {what}."
            )
            said = said if not taken else said.replace("it must be", "what is left must be")
        else:
            continue
        return GridConflictError(said, chords.tolist())
    if not sums:
        return GridConflictError(reason, sorted(fixed))
    wanted = [words for words, _ in sums]
    wanted += [f"{count} on chord {chord}" for chord, count in fixed.items()]
    shared: list[str] = []
    about: set[int] = set()
    for i, (words, one) in enumerate(sums):
        for other, more in sums[i + 1 :]:
            both = sorted(set(one.chords) & set(more.chords))
            if both:
                about |= set(both)
                named = ", ".join(map(str, both))
                shared.append(f"{words} and {other} share chords {named}")
    why = f": {'; '.join(shared)}" if shared else ""
    return GridConflictError(
        f"These numbers contradict each other: {', '.join(wanted)}{why}.", sorted(about)
    )
