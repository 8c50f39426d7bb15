"""Compiled smoothing of a block-structured grid: one vertex at a time to the least energy there.

The energy of a cell's corner with the vectors a and b to the neighbouring corners, and the sizes l
and m that the cell is to have along them, is

    (|a|^2 / l^2 + |b|^2 / m^2) / (2 d),    d = a x b / (l m).

It is 1 where a and b are orthogonal and have the ratio wanted, and grows beyond all bounds where
the corner folds, so that a valid grid stays valid (the shape measure of target-matrix optimisation,
Knupp 2012). As a function of one vertex it is convex where d > 0, so Newton steps with bisection
find its minimum. Where d <= 0, d is replaced by (d + sqrt(d^2 + e^2)) / 2, which unfolds (Garanzha
et al., *Foldover-free maps in 50 lines of code*, 2021).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.compilation import bare_kernel, kernel

POWER = 4
"""Exponent of the energy of a corner in the sum, so that the worst corners count most."""


class Grid(NamedTuple):
    """The cells around each vertex, and what they aim at."""

    cells: np.ndarray
    """(c, 4) int64."""
    first: np.ndarray
    """(n + 1,) int64 where the cells of each vertex begin in `around`."""
    around: np.ndarray
    """(4 c,) int64 cell and corner, as 4 cell + corner."""
    sizes: np.ndarray
    """(c, 2) sizes along the first and the second axis."""
    weights: np.ndarray
    """(n,) weight of the corners at each vertex."""


@bare_kernel
def cells_around(cells, first, around):
    """Fill `first` and `around` of a :class:`Grid`; `first` must be zero."""
    for c in range(len(cells)):
        for k in range(4):
            first[cells[c, k] + 1] += 1
    for v in range(len(first) - 1):
        first[v + 1] += first[v]
    for c in range(len(cells) - 1, -1, -1):
        for k in range(4):
            v = cells[c, k] + 1
            first[v] -= 1
            around[first[v]] = 4 * c + k
    # now first[v + 1] is where v begins: one place further
    for v in range(len(first) - 1):
        first[v] = first[v + 1]
    first[len(first) - 1] = len(around)


@bare_kernel
def _corner(grid, points, c, k, least, out):
    """Energy of corner k of cell c; `out` gets d, its regularised value and the vectors."""
    p, q, r = grid.cells[c, k], grid.cells[c, (k + 1) % 4], grid.cells[c, (k + 3) % 4]
    one, other = grid.sizes[c, k % 2], grid.sizes[c, 1 - k % 2]
    ax, ay = (points[q, 0] - points[p, 0]) / one, (points[q, 1] - points[p, 1]) / one
    bx, by = (points[r, 0] - points[p, 0]) / other, (points[r, 1] - points[p, 1]) / other
    d = ax * by - ay * bx
    shown = d if least <= 0.0 else 0.5 * (d + np.sqrt(d * d + least * least))
    out[0], out[1], out[2], out[3], out[4], out[5] = d, shown, ax, ay, bx, by
    if shown <= 0.0:
        return np.inf
    return 0.5 * (ax * ax + ay * ay + bx * bx + by * by) / shown


@bare_kernel
def _energy(grid, points, v, least, out):
    total = 0.0
    for s in range(grid.first[v], grid.first[v + 1]):
        c, k = grid.around[s] // 4, grid.around[s] % 4
        for turn in range(3):
            corner = (k + turn + turn // 2) % 4  # k, k + 1 and k + 3
            energy = _corner(grid, points, c, corner, least, out)
            total += grid.weights[grid.cells[c, corner]] * energy**POWER
    return total


@bare_kernel
def _slopes(grid, points, v, least, out, found):
    """Write gradient (2) and Hessian (3) of the energy at v, and return the energy.

    The Hessian leaves out the curvature of the regularisation, which can be negative.
    """
    total = 0.0
    for i in range(5):
        found[i] = 0.0
    for s in range(grid.first[v], grid.first[v + 1]):
        c, own = grid.around[s] // 4, grid.around[s] % 4
        for turn in range(3):
            k = own if turn == 0 else ((own + 1) % 4 if turn == 1 else (own + 3) % 4)
            energy = _corner(grid, points, c, k, least, out)
            weight = grid.weights[grid.cells[c, k]]
            total += weight * energy**POWER
            if energy == np.inf:
                continue
            d, shown, ax, ay, bx, by = out[0], out[1], out[2], out[3], out[4], out[5]
            p, q = 1.0 / grid.sizes[c, k % 2], 1.0 / grid.sizes[c, 1 - k % 2]
            # gradients of half the sum of squares (x, y), of d (dx, dy), and its second derivative
            if turn == 0:
                x, y = -(p * ax + q * bx), -(p * ay + q * by)
                dx, dy = -p * by + q * ay, p * bx - q * ax
                second = p * p + q * q
            elif turn == 1:  # v is the previous corner of k
                x, y = q * bx, q * by
                dx, dy = -q * ay, q * ax
                second = q * q
            else:
                x, y = p * ax, p * ay
                dx, dy = p * by, -p * bx
                second = p * p
            rise = 1.0 if least <= 0.0 else shown / np.sqrt(d * d + least * least)
            dx, dy = rise * dx, rise * dy
            gx, gy = (x - energy * dx) / shown, (y - energy * dy) / shown
            # of energy ** POWER: the factor of its first derivative, and of the square of it
            w = weight * POWER * energy ** (POWER - 1)
            w2 = (POWER - 1) / energy
            found[0] += w * gx
            found[1] += w * gy
            found[2] += w * ((second - 2.0 * gx * dx) / shown + w2 * gx * gx)
            found[3] += w * (-(gx * dy + gy * dx) / shown + w2 * gx * gy)
            found[4] += w * ((second - 2.0 * gy * dy) / shown + w2 * gy * gy)
    return total


@kernel
def relax(grid, points, free, low, high, least):
    """Move the vertices from `low` to `high` that are `free` once each; the largest move relative
    to the size of the cells there. `least` > 0 regularises.
    """
    out, found = np.zeros(6), np.zeros(5)
    largest = 0.0
    for v in range(low, high):
        if not free[v]:
            continue
        before = _slopes(grid, points, v, least, out, found)
        if before == np.inf:
            continue
        determinant = found[2] * found[4] - found[3] * found[3]
        if not (determinant > 1e-14 * (found[2] + found[4]) ** 2 and found[2] > 0.0):
            continue
        x = -(found[4] * found[0] - found[3] * found[1]) / determinant
        y = -(found[2] * found[1] - found[3] * found[0]) / determinant
        px, py = points[v, 0], points[v, 1]
        step = 1.0
        moved = False
        for _ in range(12):
            points[v, 0], points[v, 1] = px + step * x, py + step * y
            # at d <= 0 without regularisation the energy is infinite
            if _energy(grid, points, v, least, out) < before:
                moved = True
                break
            step *= 0.5
        if not moved:
            points[v, 0], points[v, 1] = px, py
            continue
        c = grid.around[grid.first[v]] // 4
        size = min(grid.sizes[c, 0], grid.sizes[c, 1])
        largest = max(largest, step * np.hypot(x, y) / size)
    return largest


@bare_kernel
def least_corner(grid, points, low, high):
    """The smallest d of the corners of cells `low` to `high`."""
    worst = np.inf
    for c in range(low, high):
        for k in range(4):
            p, q, r = grid.cells[c, k], grid.cells[c, (k + 1) % 4], grid.cells[c, (k + 3) % 4]
            ax, ay = points[q, 0] - points[p, 0], points[q, 1] - points[p, 1]
            bx, by = points[r, 0] - points[p, 0], points[r, 1] - points[p, 1]
            worst = min(worst, (ax * by - ay * bx) / (grid.sizes[c, 0] * grid.sizes[c, 1]))
    return worst
