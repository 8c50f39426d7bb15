"""Smoothing: better positions for the vertices of a mesh; its connectivity stays as it is.

Vertices inside move towards the mean of their neighbours, boundary vertices slide along their own
side towards it, geometric and locked vertices stay. A move is made only if it leaves the worst of
the elements around no worse, and inverts none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.core.references import by_reference
from meshwright_core.geometry import movable_part
from meshwright_core.geometry.coons import CurvedElements, curved_shape
from meshwright_core.geometry.movable_part import MovablePart
from meshwright_core.geometry.quality import TOLERANCE
from meshwright_core.geometry.seats import place_seat
from meshwright_core.geometry.unfixable import fixable
from meshwright_core.geometry.untangling import ALL, untangle_from_sides, untangle_part
from meshwright_core.geometry.vectors import inner

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

GAP = 0.1
"""Share of the room between its neighbours that a sliding vertex keeps to either of them."""
RINGS = 2
"""Rings of elements around an edit in which vertices move."""
SWEEPS = 20
"""The most sweeps of averaging after an edit."""
LARGEST = 2000
"""Elements up to which the region around an edit grows while something stays inverted."""
WHOLE = 20000
"""Elements up to which a mesh is untangled as a whole, beyond that around inverted elements."""


@kernel
def element_shape(points, elements, e, reference):
    """Shape of element e from its worst corner: 1 for the ideal, 0 or less for an inverted one.

    For triangles the mean ratio 2 sqrt(3) det / (sum of squared sides); for quads 2 det / (sum of
    the two squared sides) at the worst corner, so that long rectangles are worse than squares.
    """
    k = elements.shape[1]
    worst = np.inf
    for i in range(k if k == 4 else 1):
        o, s, t = elements[e, i], elements[e, (i + 1) % k], elements[e, (i + k - 1) % k]
        ox, oy, oz = points[o, 0], points[o, 1], points[o, 2]
        px, py, pz = points[s, 0] - ox, points[s, 1] - oy, points[s, 2] - oz
        qx, qy, qz = points[t, 0] - ox, points[t, 1] - oy, points[t, 2] - oz
        det = (
            reference[e, 0] * (py * qz - pz * qy)
            + reference[e, 1] * (pz * qx - px * qz)
            + reference[e, 2] * (px * qy - py * qx)
        )
        squares = px * px + py * py + pz * pz + qx * qx + qy * qy + qz * qz
        if k == 3:
            squares += (px - qx) ** 2 + (py - qy) ** 2 + (pz - qz) ** 2
            det *= np.sqrt(3.0)
        worst = min(worst, 2.0 * det / squares if squares > 0.0 else 0.0)
    return worst


@kernel
def true_shape(points, stars, e):
    """Shape of element e with its sides as they are: :func:`element_shape` where all are straight,
    else the worst over the samples of its Coons map.
    """
    row = stars.curved.row[e]
    if row < 0:
        return element_shape(points, stars.elements, e, stars.reference)
    return curved_shape(stars.curved, points, row, stars.reference[e])


@by_reference
class Stars(NamedTuple):
    """The elements of a movable part, and around each vertex."""

    elements: np.ndarray
    """(m, k) vertices by element."""
    first: np.ndarray
    """(n + 1,) where the entries of each vertex start in `incident`."""
    incident: np.ndarray
    """(m k,) the elements at each vertex, each with the vertex's corner: k * element + corner."""
    reference: np.ndarray
    """(m, 3) normals that the corners of the elements are measured against."""
    curved: CurvedElements
    """Those with curved sides."""


@kernel
def move_to_means(points, stars, order, seats, curves, guarded):
    """One sweep over the vertices `order`, in place. Returns how far the farthest one moved,
    relative to the distance of its neighbours.

    Without `guarded` every vertex moves to its mean even if elements become worse.
    """
    elements, incident, reference = stars.elements, stars.incident, stars.reference
    k = elements.shape[1]
    farthest = 0.0
    mean, normal, old = np.zeros(3), np.zeros(3), np.zeros(3)
    tangent = np.zeros(3)
    before = np.zeros(64)
    for v in order:
        begin, end = stars.first[v], stars.first[v + 1]
        for c in range(3):
            mean[c] = normal[c] = 0.0
            old[c] = points[v, c]
        size = 0.0
        for i in range(begin, end):
            e, corner = incident[i] // k, incident[i] % k
            a, b = elements[e, (corner + 1) % k], elements[e, (corner + k - 1) % k]
            for c in range(3):
                mean[c] += points[a, c] + points[b, c]
                normal[c] += reference[e, c]
                size += abs(points[a, c] - points[v, c]) + abs(points[b, c] - points[v, c])
        size /= 2.0 * (end - begin)
        for c in range(3):
            mean[c] = mean[c] / (2.0 * (end - begin)) - points[v, c]
        slides = seats.curve[v] >= 0
        start = seats.parameter[v]
        shift = 0.0
        if slides:
            place_seat(curves, seats, v, points[v], tangent)
            shift = inner(tangent, mean) / inner(tangent, tangent)
            low, high = seats.low[v], seats.high[v]
            if seats.before[v] >= 0:
                low += seats.parameter[seats.before[v]]
            if seats.after[v] >= 0:
                high += seats.parameter[seats.after[v]]
            margin = GAP * (high - low)
            shift = min(max(start + shift, low + margin), high - margin) - start
        else:
            square = inner(normal, normal)
            if square > 0.0:
                along = inner(mean, normal) / square
                for c in range(3):
                    mean[c] -= along * normal[c]
        worst = np.inf
        for i in range(begin, end):
            shape = true_shape(points, stars, incident[i] // k)
            worst = min(worst, shape)
            if i - begin < 64:
                before[i - begin] = shape
        step = 1.0
        for _ in range(4):
            if slides:
                seats.parameter[v] = start + step * shift
                place_seat(curves, seats, v, points[v], tangent)
            else:
                for c in range(3):
                    points[v, c] = old[c] + step * mean[c]
            fine = True
            if guarded:
                for i in range(begin, end):
                    shape = true_shape(points, stars, incident[i] // k)
                    was = before[i - begin] if i - begin < 64 else np.inf
                    if shape < worst or (was > TOLERANCE and shape <= TOLERANCE):
                        fine = False
                        break
            if fine:
                break
            step *= 0.5
        if not fine:
            for c in range(3):
                points[v, c] = old[c]
            if slides:
                seats.parameter[v] = start
        elif size > 0.0:
            moved = 0.0
            for c in range(3):
                moved += abs(points[v, c] - old[c])
            farthest = max(farthest, moved / size)
    return farthest


def stars_of(part: MovablePart) -> Stars:
    """The elements of `part`, by vertex."""
    corners = part.elements.ravel()
    incident = np.argsort(corners, kind="stable")
    first = np.searchsorted(corners[incident], np.arange(len(part.vertices) + 1))
    return Stars(part.elements, first, incident, part.references(), part.curved)


def sweep(part: MovablePart, iterations: int, guarded: bool = True) -> None:
    """Move the vertices of `part` in place by up to `iterations` sweeps."""
    order = np.flatnonzero(part.movable)
    if not len(order):
        return
    stars = stars_of(part)
    for _ in range(iterations):
        moved = move_to_means(part.points, stars, order, part.seats, part.curves, guarded)
        if moved < 1e-4:
            break


def smooth(
    mesh: HalfEdgeMesh, vertices: Iterable[int] | None = None, iterations: int = 20
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions nearer to the means of the neighbours; the mesh itself is not changed.

    Args:
        mesh: the mesh.
        vertices: ids of the vertices that may move; None: all.
        iterations: the most sweeps over these vertices; fewer when they come to rest.

    Returns:
        what :meth:`HalfEdgeMesh.move` takes: ids (n,) of the vertices that have moved, their new
        positions (n, 3), and the parameters (n,) of those on curves. On a surface that is not plane
        vertices move along their tangent plane.
    """
    part = movable_part.chosen(mesh, vertices)
    part.settle()
    sweep(part, iterations)
    return part.changed(mesh)


def average(
    mesh: HalfEdgeMesh, vertices: Iterable[int] | None = None, iterations: int = 100
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Plain averaging, for comparison: as :func:`smooth`, but elements may fold."""
    part = movable_part.chosen(mesh, vertices)
    part.settle()
    sweep(part, iterations, guarded=False)
    return part.changed(mesh)


def relax(
    mesh: HalfEdgeMesh, around: Iterable[int] | None = None, thorough: bool = True
) -> np.ndarray:
    """Smooth after an edit, and untangle where something is inverted; one undo step.

    Args:
        mesh: the mesh; positions are written through :meth:`HalfEdgeMesh.move`.
        around: ids of the vertices that an edit touched; only vertices within two rings of elements
            around them move, and if these do not suffice to untangle, more and more rings, up to
            some thousand elements. None: the whole mesh.
        thorough: False: two rings only. Takes a few milliseconds at most, and may leave
            elements inverted that a larger part could untangle.

    Returns:
        Ids, ascending, of the elements that stay inverted, of those looked at.
    """
    if around is None:
        return _relax_whole(mesh)
    seeds = movable_part.live(mesh, around)
    return _relax_near(mesh, seeds, thorough).inverted() if len(seeds) else seeds


def draw(
    mesh: HalfEdgeMesh, stop: Callable[[], bool] = lambda: False, attempts: int = ALL
) -> np.ndarray:
    """Find positions for a plane mesh whose present ones say little, see
    :func:`meshwright_core.geometry.untangling.untangle_from_sides`.

    stop: polled between attempts. Returns ids, ascending, of the elements that stay inverted.
    """
    part = movable_part.whole(mesh)
    untangle_from_sides(part, stop, attempts)
    _write(mesh, part)
    return part.inverted()


def _relax_near(mesh: HalfEdgeMesh, seeds: np.ndarray, thorough: bool = True) -> MovablePart:
    """Relax around `seeds`, with more and more rings as long as something stays inverted."""
    reach = RINGS
    while True:
        part = movable_part.around(mesh, movable_part.rings(mesh, seeds, reach))
        last = len(part.elements) >= min(LARGEST, mesh.n_elements)
        if _shape(part, tries=3 if last and thorough else 1) or last or not thorough:
            _write(mesh, part)
            return part
        reach *= 2


def _shape(part: MovablePart, tries: int = ALL) -> bool:
    """Give the elements better shapes in place; false if some elements stay inverted without need.

    Averaging unfolds most of what an edit has folded, and is the only method for surfaces that are
    not plane; minimising the energy gives better positions.
    """
    part.settle()
    if part.frame is None or part.folded().any():
        sweep(part, SWEEPS)
    untangle_part(part, tries=tries)
    return not fixable(part).any()


def _write(mesh: HalfEdgeMesh, part: MovablePart) -> None:
    vertices, positions, parameters = part.changed(mesh)
    if len(vertices):
        mesh.move(vertices, positions, parameters)


def _relax_whole(mesh: HalfEdgeMesh) -> np.ndarray:
    part = movable_part.whole(mesh)
    if mesh.n_elements <= WHOLE:
        _shape(part)
        _write(mesh, part)
        return part.inverted()
    # large meshes are tangled in few places: untangle these one by one
    part.settle()
    sweep(part, SWEEPS)
    pending = dict.fromkeys(part.inverted().tolist())
    stuck: set[int] = set()
    with mesh.transaction():
        _write(mesh, part)
        while pending:
            element = next(iter(pending))
            patch = _relax_near(mesh, mesh.corners(np.array([element]))[0])
            for seen in patch.element_ids.tolist():
                pending.pop(seen, None)
                stuck.discard(seen)
            stuck.update(patch.inverted().tolist())
    return np.array(sorted(stuck), np.int64)
