"""Random engineering parts: straight-sided outlines with steps, slots, bosses, chamfers and holes.

A part begins as an axis-aligned box. Features change its outline one after another, each a union
with or a difference from something simple: steps and corner notches (boxes at a corner), bosses and
slots (boxes on a side, now and then tapered), V-notches, chamfers. Holes are turned rectangles and
regular polygons. A feature that would make a side too short, two sides nearly meet, a corner too
sharp or nearly straight is rejected and drawn again. Lengths are in units of the least side until
the part is scaled to the size of the gallery's shapes.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import shapely

from meshwright_core.domains import meshing
from meshwright_core.domains.domain import Domain, Points
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh

DIAMETER = 2.0
"""Largest distance between two corners of a finished part."""
GAP = 0.75
"""Least distance between a corner and a side that it does not lie on, in least sides."""
SHARPEST, FLATTEST = 30.0, 12.0
"""Degrees that a corner has at least inside and outside of the part; and turns by at least."""
FEWEST = 4
"""Corners that an outline keeps for itself when holes are given theirs."""

_ATTEMPTS = 200  # outlines begun, and features drawn for each of them
_HOLE = 3  # corners of the smallest hole


def random_part(
    corners: int | tuple[int, int], rng: np.random.Generator, holes: bool | None = None
) -> Domain:
    """Draw a part; all its points are corners.

    Args:
        corners: of all loops together; a number, at least 4, or a closed range of them.
        rng: the only source of randomness.
        holes: whether the part has one or two holes; None: every other part has, at random. A part
            of fewer than seven corners has none.

    Raises:
        MeshError: a range without numbers, or fewer than four corners.
    """
    least, most = corners if isinstance(corners, tuple) else (corners, corners)
    if not 4 <= least <= most:
        raise MeshError(f"A part has at least 4 corners, not {least} to {most}.")
    count = int(rng.integers(least, most + 1))
    wanted = bool(rng.random() < 0.5) if holes is None else holes
    for _ in range(_ATTEMPTS):
        loops = _loops(count, _hole_sizes(count, rng) if wanted else [], rng)
        if loops is not None:
            points = np.concatenate(loops)
            middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
            size = DIAMETER / shapely.minimum_bounding_radius(shapely.MultiPoint(points)) / 2
            outline, *inner = [(loop - middle) * size for loop in loops]
            flags = [np.ones(len(loop), bool) for loop in loops]
            return Domain(outline, inner, flags[0], flags[1:], name=f"part-{count}")
    raise MeshError(f"No part with {count} corners was found in {_ATTEMPTS} attempts.")


def parts(count: int, corners: int | tuple[int, int], seed: int) -> list[Domain]:
    """Return parts, every second with holes; part i depends on the seed and on i alone.

    Arguments and errors as for :func:`random_part`.
    """
    return [
        random_part(corners, np.random.default_rng([seed, i]), holes=i % 2 == 1)
        for i in range(count)
    ]


def part_mesh(
    kind: str, corners: int | tuple[int, int], rng: np.random.Generator, holes: bool | None = None
) -> HalfEdgeMesh:
    """Draw a part and mesh it, "tri" or "quad", as
    :func:`meshwright_core.domains.meshing.mesh_domain` does by
    default; the rest, errors too, as for :func:`random_part`.
    """
    return meshing.mesh_domain(random_part(corners, rng, holes), kind)


def _hole_sizes(count: int, rng: np.random.Generator) -> list[int]:
    """Corners of one or two holes of a part with so many corners in all, as far as they go."""
    sizes: list[int] = []
    left = count - FEWEST
    for _ in range(int(rng.integers(1, 3))):
        # as often a rectangle as all other polygons together
        size = 4 if rng.random() < 0.5 else int(rng.integers(_HOLE, 9))
        if left >= _HOLE:
            sizes.append(min(size, left))
            left -= sizes[-1]
    return sizes


def _loops(count: int, holes: list[int], rng: np.random.Generator) -> list[Points] | None:
    """An outline and holes, `count` corners in all; None if all attempts fail."""
    target = count - sum(holes)
    size = 2.5 + 0.2 * target + 1.2 * len(holes)
    width, height = size * rng.uniform(0.7, 1.5, 2)
    loops = [np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])]
    pending = list(holes)
    for _ in range(_ATTEMPTS):
        if len(loops[0]) == target and not pending:
            return loops
        # a hole at any time, but before the outline has used up the room
        if pending and (len(loops[0]) == target or rng.random() < 0.3):
            trial = [*loops, _hole(pending[0], loops[0], rng)]
        else:
            outline = _with_feature(loops[0], target - len(loops[0]), rng)
            if outline is None:
                continue
            trial = [outline, *loops[1:]]
        if _fine(trial):
            pending = pending[len(trial) - len(loops) :]
            loops = trial
    return None


def _hole(corners: int, outline: Points, rng: np.random.Generator) -> Points:
    """A turned rectangle, or regular polygon, somewhere in the outline's box, clockwise."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    radius = rng.uniform(0.15, 0.3) * (high - low).min()
    if corners == 4:
        slender = rng.uniform(0.2, 1.0) * np.pi / 4
        angle = np.array([slender, np.pi - slender, np.pi + slender, -slender])
    else:
        angle = 2 * np.pi * np.arange(corners) / corners
    angle = angle + rng.uniform(0, 2 * np.pi)
    place = rng.uniform(low + radius, high - radius)
    turned: Points = place + radius * np.column_stack([np.cos(angle), np.sin(angle)])[::-1]
    return turned


def _with_feature(outline: Points, room: int, rng: np.random.Generator) -> Points | None:
    """The outline with one feature more, of at most `room` new corners; None where none fits."""
    feature, new = _FEATURES[int(rng.choice(len(_FEATURES), p=_CHANCES))]
    if new > room:
        return None
    # long sides are changed more often; the one that is comes first: from point 0 to point 1
    lengths = np.hypot(*(np.roll(outline, -1, axis=0) - outline).T)
    side = int(np.searchsorted(np.cumsum(lengths), rng.random() * lengths.sum()))
    return feature(np.roll(outline, -side, axis=0), rng)


def _side(outline: Points) -> tuple[Points, Points, float]:
    """Direction, outward normal and length of the side from point 0 to point 1."""
    along = outline[1] - outline[0]
    length = float(np.hypot(*along))
    along = along / length
    return along, np.array([along[1], -along[0]]), length


def _on_side(outline: Points, out: float, taper: bool, rng: np.random.Generator) -> Points | None:
    """A box on the side, put on (out = 1) or cut out (out = -1): four corners more."""
    along, normal, length = _side(outline)
    if length < 3.0:
        return None
    width = rng.uniform(1.0, max(1.0, min(0.5 * length, 4.0)))
    start = rng.uniform(1.0, max(1.0, length - width - 1.0))
    depth = out * rng.uniform(1.0, 3.0)
    slant = rng.uniform(-0.3, 0.3) * min(abs(depth), width) if taper else 0.0
    foot, end = outline[0] + start * along, outline[0] + (start + width) * along
    top = [foot + slant * along + depth * normal, end - slant * along + depth * normal]
    return np.vstack([outline[:1], foot, top, end, outline[1:]])


def _boss(outline: Points, rng: np.random.Generator) -> Points | None:
    return _on_side(outline, 1.0, False, rng)


def _slot(outline: Points, rng: np.random.Generator) -> Points | None:
    return _on_side(outline, -1.0, False, rng)


def _tapered(outline: Points, rng: np.random.Generator) -> Points | None:
    return _on_side(outline, float(rng.choice([1.0, -1.0])), True, rng)


def _step(outline: Points, rng: np.random.Generator) -> Points | None:
    """A box put on or cut off at the end of the side, where it meets the next at a right angle:
    two corners more.
    """
    along, normal, length = _side(outline)
    following = outline[2] - outline[1]
    if length < 2.0 or abs(float(following @ along)) > 1e-9 * length:
        return None
    start = rng.uniform(1.0, length - 1.0)
    depth = float(rng.choice([1.0, -1.0])) * rng.uniform(1.0, 4.0)
    foot = outline[0] + start * along
    moved = outline[1] + depth * normal
    return np.vstack([outline[:1], foot, foot + depth * normal, moved, outline[2:]])


def _chamfer(outline: Points, rng: np.random.Generator) -> Points | None:
    """The end of the side cut off, or filled where it is reflex: one corner more."""
    along, _, length = _side(outline)
    following = outline[2] - outline[1]
    longest = float(np.hypot(*following))
    reach = min(length, longest) - 1.0
    if reach < 0.71:
        return None
    legs = np.full(2, rng.uniform(0.71, min(reach, 2.5)))
    if rng.random() < 0.3:
        legs[1] *= rng.uniform(0.6, 1.4)
    cut = [outline[1] - legs[0] * along, outline[1] + legs[1] * following / longest]
    return np.vstack([outline[:1], cut, outline[2:]])


def _notch(outline: Points, rng: np.random.Generator) -> Points | None:
    """A triangle cut out of the side: three corners more."""
    along, normal, length = _side(outline)
    if length < 3.2:
        return None
    width = rng.uniform(1.2, max(1.2, min(0.5 * length, 3.0)))
    start = rng.uniform(1.0, max(1.0, length - width - 1.0))
    foot = outline[0] + start * along
    tip = foot + 0.5 * width * along - rng.uniform(0.8, 1.5) * width * normal
    return np.vstack([outline[:1], foot, tip, foot + width * along, outline[1:]])


Feature = Callable[[Points, np.random.Generator], "Points | None"]

_FEATURES: list[tuple[Feature, int]] = [
    (_step, 2),
    (_boss, 4),
    (_slot, 4),
    (_chamfer, 1),
    (_tapered, 4),
    (_notch, 3),
]
_CHANCES = [0.34, 0.17, 0.2, 0.17, 0.06, 0.06]


def _fine(loops: list[Points]) -> bool:
    """Whether loops make a part that is not degenerate, the holes inside the outline."""
    for loop in loops:
        if not (_long_sides(loop) and _clear_corners(loop)):
            return False
    if not shapely.is_valid(shapely.Polygon(loops[0], loops[1:])):
        return False
    return _least_gap(loops) >= GAP


def _long_sides(loop: Points) -> bool:
    return bool(np.hypot(*(np.roll(loop, -1, axis=0) - loop).T).min() >= 1.0 - 1e-9)


def _clear_corners(loop: Points) -> bool:
    """Whether no corner is all but straight, and none too sharp, be it of the part or beside it."""
    before = loop - np.roll(loop, 1, axis=0)
    after = np.roll(before, -1, axis=0)
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turn = np.abs(np.degrees(np.arctan2(across, (before * after).sum(axis=1))))
    return bool((turn >= FLATTEST).all() and (turn <= 180.0 - SHARPEST).all())


def _least_gap(loops: list[Points]) -> float:
    """The least distance between a corner and a side that it does not lie on."""
    points = np.concatenate(loops)
    ends = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops])
    sizes = np.array([len(loop) for loop in loops])
    index = np.arange(len(points))
    loop_start = np.repeat(np.cumsum(sizes) - sizes, sizes)
    following = loop_start + (index - loop_start + 1) % np.repeat(sizes, sizes)
    along = ends - points
    offset = points[:, None] - points[None]
    share = np.clip((offset * along).sum(-1) / (along * along).sum(-1), 0.0, 1.0)
    distance = np.hypot(*np.moveaxis(offset - share[..., None] * along, -1, 0))
    distance[index, index] = distance[following, index] = np.inf
    return float(distance.min())
