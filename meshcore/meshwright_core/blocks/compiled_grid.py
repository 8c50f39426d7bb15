"""Compiled loops over the cells of a block-structured grid: numbering, transfinite interpolation,
transfer of displacements, spacing of layers, faces and quality.

The cells of a block are numbered along its first axis, row by row; its vertices likewise, in one
table `ids` for all blocks. Corners of blocks come first among the vertices of the grid, then those
inside the block edges, then those inside the blocks.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.compilation import bare_kernel, kernel


class Layout(NamedTuple):
    """b blocks of a grid with n vertices and their numbering."""

    sides: np.ndarray
    """(b, 4) int64 the edge of each side."""
    forward: np.ndarray
    """(b, 4) bool whether the edge runs in the direction of the block's axes."""
    corners: np.ndarray
    """(b, 4) int64 the vertices at the corners."""
    shape: np.ndarray
    """(b, 2) int64 cells along the first and the second axis."""
    edge_first: np.ndarray
    """(e + 1,) int64 the first vertex inside each edge, in the edge's direction."""
    block_first: np.ndarray
    """(b + 1,) int64 the first vertex inside each block."""
    start: np.ndarray
    """(b + 1,) int64 where the table of each block begins in `ids`."""
    cell_first: np.ndarray
    """(b + 1,) int64 the first cell of each block."""
    ids: np.ndarray
    """(t,) int64 the vertices of each block: row j from start + j (columns + 1)."""


class Graded(NamedTuple):
    """How the edges are divided."""

    share: np.ndarray
    """(n,) the fraction of its edge at each vertex inside an edge, in the edge's direction."""
    first: np.ndarray
    """(e,) height of the first cell, 0 where it is free."""
    last: np.ndarray
    """(e,) height of the last cell, 0 where it is free."""
    ratio: np.ndarray
    """(e,) growth from cell to cell."""


@bare_kernel
def _side_vertex(layout, b, side, k):
    """Vertex k of a side of a block, counted in the direction of its axis."""
    edge = layout.sides[b, side]
    count = layout.edge_first[edge + 1] - layout.edge_first[edge]
    inside = k - 1 if layout.forward[b, side] else count - k
    return layout.edge_first[edge] + inside


@bare_kernel
def number_vertices(layout):
    """Fill `ids`."""
    for b in range(len(layout.corners)):
        n, m = layout.shape[b, 0], layout.shape[b, 1]
        start, inside = layout.start[b], layout.block_first[b]
        width = n + 1
        for j in range(1, m):
            row = start + j * width
            for i in range(1, n):
                layout.ids[row + i] = inside
                inside += 1
            layout.ids[row] = _side_vertex(layout, b, 3, j)
            layout.ids[row + n] = _side_vertex(layout, b, 1, j)
        for i in range(1, n):
            layout.ids[start + i] = _side_vertex(layout, b, 0, i)
            layout.ids[start + m * width + i] = _side_vertex(layout, b, 2, i)
        layout.ids[start] = layout.corners[b, 0]
        layout.ids[start + n] = layout.corners[b, 1]
        layout.ids[start + m * width + n] = layout.corners[b, 2]
        layout.ids[start + m * width] = layout.corners[b, 3]


@bare_kernel
def fill_cells(layout, cells):
    """Write the corners (c, 4) of all cells, counter-clockwise."""
    for b in range(len(layout.corners)):
        n, m = layout.shape[b, 0], layout.shape[b, 1]
        c = layout.cell_first[b]
        for j in range(m):
            row = layout.start[b] + j * (n + 1)
            for i in range(n):
                cells[c, 0] = layout.ids[row + i]
                cells[c, 1] = layout.ids[row + i + 1]
                cells[c, 2] = layout.ids[row + n + 2 + i]
                cells[c, 3] = layout.ids[row + n + 1 + i]
                c += 1


@bare_kernel
def _side_share(layout, graded, b, side, k, count):
    """The fraction of a side at its vertex k, in the direction of its axis."""
    if k == 0:
        return 0.0
    if k == count:
        return 1.0
    share = graded.share[_side_vertex(layout, b, side, k)]
    return share if layout.forward[b, side] else 1.0 - share


@bare_kernel
def place_of(layout, graded, b, i, j):
    """The place (u, v) of vertex (i, j) of a block in the unit square: where the lines between
    opposite points of its sides meet (Soni 1985).
    """
    n, m = layout.shape[b, 0], layout.shape[b, 1]
    u0, u2 = _side_share(layout, graded, b, 0, i, n), _side_share(layout, graded, b, 2, i, n)
    v3, v1 = _side_share(layout, graded, b, 3, j, m), _side_share(layout, graded, b, 1, j, m)
    u = (u0 + v3 * (u2 - u0)) / (1.0 - (u2 - u0) * (v1 - v3))
    return u, v3 + u * (v1 - v3)


@bare_kernel
def interpolate(layout, graded, points):
    """Write the points inside the blocks: the transfinite interpolation of their sides (Gordon and
    Hall 1973) at :func:`place_of`.
    """
    ids = layout.ids
    for b in range(len(layout.corners)):
        n, m = layout.shape[b, 0], layout.shape[b, 1]
        start, width = layout.start[b], n + 1
        top = start + m * width
        for j in range(1, m):
            row = start + j * width
            for i in range(1, n):
                u, v = place_of(layout, graded, b, i, j)
                for c in range(points.shape[1]):
                    points[ids[row + i], c] = (
                        (1.0 - u) * points[ids[row], c]
                        + u * points[ids[row + n], c]
                        + (1.0 - v) * (points[ids[start + i], c] - (1.0 - u) * points[ids[start], c]
                                       - u * points[ids[start + n], c])
                        + v * (points[ids[top + i], c] - (1.0 - u) * points[ids[top], c]
                               - u * points[ids[top + n], c])
                    )  # fmt: skip


@bare_kernel
def _weights(x, count, weights):
    """First of four samples 0 ... count around x in [0, count], and their weights: Catmull-Rom's
    cubic, linear beyond the ends.
    """
    k = min(int(x), count - 1)
    t = x - k
    weights[0] = 0.5 * t * (-1.0 + t * (2.0 - t))
    weights[1] = 0.5 * (2.0 + t * t * (-5.0 + 3.0 * t))
    weights[2] = 0.5 * t * (1.0 + t * (4.0 - 3.0 * t))
    weights[3] = 0.5 * t * t * (t - 1.0)
    if k == 0:
        weights[1] += 2.0 * weights[0]
        weights[2] -= weights[0]
        weights[0] = 0.0
    if k == count - 1:
        weights[2] += 2.0 * weights[3]
        weights[1] -= weights[3]
        weights[3] = 0.0
    return k - 1


@kernel
def displace(coarse, moved, layout, graded, points):
    """Add to all points the displacements `moved` (n', 2) of a coarse grid of the same blocks,
    whose vertices are spaced evenly; cubic between them, continuous across the edges.
    """
    across, along = np.zeros(4), np.zeros(4)
    done = np.zeros(len(points), np.bool_)
    for b in range(len(layout.corners)):
        n, m = layout.shape[b, 0], layout.shape[b, 1]
        p, q = coarse.shape[b, 0], coarse.shape[b, 1]
        for j in range(m + 1):
            for i in range(n + 1):
                v = layout.ids[layout.start[b] + j * (n + 1) + i]
                if done[v]:
                    continue
                done[v] = True
                x, y = place_of(layout, graded, b, i, j)
                column = _weights(x * p, p, across)
                lowest = _weights(y * q, q, along)
                for s in range(4):
                    if along[s] == 0.0:
                        continue
                    row = coarse.start[b] + (lowest + s) * (p + 1) + column
                    for r in range(4):
                        if across[r] != 0.0:
                            a = coarse.ids[row + r]
                            points[v, 0] += along[s] * across[r] * moved[a, 0]
                            points[v, 1] += along[s] * across[r] * moved[a, 1]


@bare_kernel
def _length_of(n, height, first, last, ratio, sizes):
    """Write the n sizes for a largest size `height`, and return their sum."""
    total = 0.0
    low, high = first, last
    for i in range(n):
        sizes[i] = height
    if first > 0.0:
        for i in range(n):
            if low >= sizes[i]:
                break
            sizes[i] = low
            low *= ratio
    if last > 0.0:
        for i in range(n - 1, -1, -1):
            if high >= sizes[i]:
                break
            sizes[i] = high
            high *= ratio
    for i in range(n):
        total += sizes[i]
    return total


@bare_kernel
def grade(length, first, last, ratio, sizes):
    """Write the sizes (n,) of the cells on a line of this length.

    Cells grow by `ratio` from the heights `first` and `last`, where these are above 0, up to one
    size between, which makes the sum right. With too few cells for that ratio the growth is faster,
    with too many all are equal.
    """
    n = len(sizes)
    even = length / n
    if first >= even:
        first = 0.0
    if last >= even:
        last = 0.0
    if first <= 0.0 and last <= 0.0:
        for i in range(n):
            sizes[i] = even
        return
    if _length_of(n, length, first, last, ratio, sizes) >= length:
        low, high = even, length
        for _ in range(80):
            middle = 0.5 * (low + high)
            if _length_of(n, middle, first, last, ratio, sizes) < length:
                low = middle
            else:
                high = middle
        total = _length_of(n, high, first, last, ratio, sizes)
    else:
        # the fastest growth that two layers which meet can need is that of one of them
        low, high = ratio, 2.0 * ratio
        while _length_of(n, length, first, last, high, sizes) < length and high < 1e12:
            low, high = high, 2.0 * high
        for _ in range(80):
            middle = 0.5 * (low + high)
            if _length_of(n, length, first, last, middle, sizes) < length:
                low = middle
            else:
                high = middle
        total = _length_of(n, length, first, last, high, sizes)
    for i in range(n):
        sizes[i] *= length / total


@kernel
def grade_edges(lengths, counts, graded, first_place, shares):
    """Write the fractions at the vertices inside all edges; `first_place` (e,) where they begin."""
    for e in range(len(lengths)):
        sizes = np.zeros(counts[e])
        grade(lengths[e], graded.first[e], graded.last[e], graded.ratio[e], sizes)
        total = 0.0
        for i in range(counts[e] - 1):
            total += sizes[i]
            shares[first_place[e] + i] = total / lengths[e]


@kernel
def _space_line(at, heights, sizes, moved):
    """Move the points (n + 1, 2) of a line along it so that its cells have the sizes of
    :func:`grade`; `moved` (n + 1, 2) gets them.
    """
    n = len(at) - 1
    arc = np.zeros(n + 1)
    for i in range(n):
        arc[i + 1] = arc[i] + np.hypot(at[i + 1, 0] - at[i, 0], at[i + 1, 1] - at[i, 1])
    grade(arc[n], heights[0], heights[1], heights[2], sizes)
    k, s = 0, 0.0
    for i in range(1, n):
        s += sizes[i - 1]
        while k < n - 1 and arc[k + 1] < s:
            k += 1
        step = arc[k + 1] - arc[k]
        t = (s - arc[k]) / step if step > 0.0 else 0.0
        for c in range(2):
            moved[i, c] = (1.0 - t) * at[k, c] + t * at[k + 1, c]


@kernel
def space_layers(layout, graded, free, points):
    """Space the lines of all graded blocks anew, inside the blocks and on the edges that are
    `free` (e,), so that the heights of their first and last cells are those wanted.
    """
    done = np.zeros(len(points), np.bool_)
    heights = np.zeros(3)
    for b in range(len(layout.corners)):
        n, m = layout.shape[b, 0], layout.shape[b, 1]
        for axis in range(2):
            one, other = layout.sides[b, axis], layout.sides[b, (axis + 2) % 4]
            if axis == 1:
                one, other = layout.sides[b, 3], layout.sides[b, 1]
            first, last = graded.first[one], graded.last[one]
            if first <= 0.0 and last <= 0.0:
                continue
            forward = layout.forward[b, 0 if axis == 0 else 3]
            heights[0], heights[1] = (first, last) if forward else (last, first)
            heights[2] = graded.ratio[one]
            count, lines = (n, m) if axis == 0 else (m, n)
            step, stride = (1, n + 1) if axis == 0 else (n + 1, 1)
            at, moved, sizes = np.zeros((count + 1, 2)), np.zeros((count + 1, 2)), np.zeros(count)
            for line in range(lines + 1):
                if (line == 0 and not free[one]) or (line == lines and not free[other]):
                    continue
                begin = layout.start[b] + line * stride
                # an edge between two blocks is spaced once
                if count > 1 and done[layout.ids[begin + step]] and (line == 0 or line == lines):
                    continue
                for i in range(count + 1):
                    v = layout.ids[begin + i * step]
                    at[i, 0], at[i, 1] = points[v, 0], points[v, 1]
                _space_line(at, heights, sizes, moved)
                for i in range(1, count):
                    v = layout.ids[begin + i * step]
                    points[v, 0], points[v, 1] = moved[i, 0], moved[i, 1]
                    if line == 0 or line == lines:
                        done[v] = True


@bare_kernel
def _cell_beside(layout, b, side, k):
    """The cell of a block at the part k of one of its sides, counted along the edge."""
    n, m = layout.shape[b, 0], layout.shape[b, 1]
    count = n if side % 2 == 0 else m
    at = k if layout.forward[b, side] else count - 1 - k
    i, j = at, 0
    if side == 1:
        i, j = n - 1, at
    elif side == 2:
        i, j = at, m - 1
    elif side == 3:
        i, j = 0, at
    return layout.cell_first[b] + j * n + i


@bare_kernel
def fill_faces(layout, owners, faces):
    """Write the inner faces (f, 4): cell, other cell, and the two vertices between them.

    `owners` (e, 4): block and side on one side of each edge, and on the other; -1 on the boundary.
    """
    f = 0
    for b in range(len(layout.corners)):
        n, m = layout.shape[b, 0], layout.shape[b, 1]
        for j in range(m):
            for i in range(n):
                c = layout.cell_first[b] + j * n + i
                v = layout.start[b] + j * (n + 1) + i
                if i + 1 < n:
                    faces[f, 0], faces[f, 1] = c, c + 1
                    faces[f, 2], faces[f, 3] = layout.ids[v + 1], layout.ids[v + n + 2]
                    f += 1
                if j + 1 < m:
                    faces[f, 0], faces[f, 1] = c, c + n
                    faces[f, 2], faces[f, 3] = layout.ids[v + n + 2], layout.ids[v + n + 1]
                    f += 1
    for e in range(len(owners)):
        if owners[e, 2] < 0:
            continue
        b, side = owners[e, 0], owners[e, 1]
        count = layout.shape[b, side % 2]
        for k in range(count):
            faces[f, 0] = _cell_beside(layout, b, side, k)
            faces[f, 1] = _cell_beside(layout, owners[e, 2], owners[e, 3], k)
            at = k if layout.forward[b, side] else count - 1 - k
            first, step = layout.start[b], 1
            n = layout.shape[b, 0]
            if side == 1:
                first, step = first + n, n + 1
            elif side == 2:
                first += layout.shape[b, 1] * (n + 1)
            elif side == 3:
                step = n + 1
            faces[f, 2] = layout.ids[first + at * step]
            faces[f, 3] = layout.ids[first + (at + 1) * step]
            f += 1
    return f


@bare_kernel
def measure_cells(points, cells, sine, aspect, area):
    """Write for each cell the smallest sine of a corner, negative where folded, the ratio of its
    longest to its shortest side, and its area; points (n, 2).
    """
    for c in range(len(cells)):
        worst, longest, shortest, twice = np.inf, 0.0, np.inf, 0.0
        for k in range(4):
            p, q, r = cells[c, k], cells[c, (k + 1) % 4], cells[c, (k + 3) % 4]
            ax, ay = points[q, 0] - points[p, 0], points[q, 1] - points[p, 1]
            bx, by = points[r, 0] - points[p, 0], points[r, 1] - points[p, 1]
            size, other = np.hypot(ax, ay), np.hypot(bx, by)
            product = size * other
            worst = min(worst, (ax * by - ay * bx) / product if product > 0.0 else 0.0)
            longest, shortest = max(longest, size), min(shortest, size)
            twice += points[p, 0] * points[q, 1] - points[p, 1] * points[q, 0]
        sine[c], area[c] = worst, 0.5 * twice
        aspect[c] = longest / shortest if shortest > 0.0 else np.inf


@bare_kernel
def measure_faces(points, cells, faces, area, angle, growth):
    """Write for each inner face the angle in radians between its normal and the line between the
    centres of its cells, and the ratio of the larger to the smaller of their areas.
    """
    for f in range(len(faces)):
        x, y = 0.0, 0.0
        for k in range(4):
            x += 0.25 * (points[cells[faces[f, 1], k], 0] - points[cells[faces[f, 0], k], 0])
            y += 0.25 * (points[cells[faces[f, 1], k], 1] - points[cells[faces[f, 0], k], 1])
        dx = points[faces[f, 3], 0] - points[faces[f, 2], 0]
        dy = points[faces[f, 3], 1] - points[faces[f, 2], 1]
        product = np.hypot(x, y) * np.hypot(dx, dy)
        cosine = abs(x * dy - y * dx) / product if product > 0.0 else 0.0
        angle[f] = np.arccos(min(cosine, 1.0))
        one, other = abs(area[faces[f, 0]]), abs(area[faces[f, 1]])
        low = min(one, other)
        growth[f] = max(one, other) / low if low > 0.0 else np.inf
