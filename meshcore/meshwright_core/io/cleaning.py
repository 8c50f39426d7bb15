"""Converts the raw content of a mesh file to points and elements of a manifold mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.components import components
from meshwright_core.errors import MeshError, MixedElementsError
from meshwright_core.io.content import Cells, Content

_MOST_DEGREE = 10_000
_TRIED = 1000
_THIN = 1e-12
"""Width of points on one line, as a share of their length."""
_FARTHEST = 1e100
"""Coordinates beyond this would overflow in areas."""

Elements = NDArray[np.int64]


def refuse_mixed(content: Content) -> None:
    """MixedElementsError if a content holds both triangles and quads."""
    if len(content.cells) > 1:
        raise MixedElementsError(_mixed(content.points, content.cells))


def _mixed(points: NDArray[np.float64], cells: Cells) -> str:
    few = min(cells, key=lambda kind: len(cells[kind]))
    message = (
        f"it mixes {_count(cells, 'triangle')} and {_count(cells, 'quad')}, "
        "but a mesh here has one kind of element: to_quads (--to-quads) makes quads of all"
    )
    corners = cells[few][0]
    if corners.min() >= 0 and corners.max() < len(points):
        x, y = points[corners].mean(axis=0)[:2]
        message += f"; the first {few} lies at ({x:.4g}, {y:.4g})"
    return message


def _count(cells: Cells, kind: str) -> str:
    number = len(cells[kind])
    return f"{number} {kind}" + ("" if number == 1 else "s")


def refuse_strays(points: NDArray[np.float64], elements: Elements) -> None:
    """MeshError if an element has a point that is not in the file, or is not finite."""
    count = len(points)
    stray = ((elements < 0) | (elements >= count)).any(axis=1)
    if stray.any():
        raise MeshError(
            f"element {int(np.argmax(stray))} names a point that is not among the {count} there"
        )
    far = np.logical_not((np.abs(points) < _FARTHEST).all(axis=1))[elements]
    if far.any():
        row = int(np.argmax(far.any(axis=1)))
        point = int(elements[row][np.argmax(far[row])])
        shown = ", ".join(f"{value:g}" for value in points[point])
        raise MeshError(f"point {point}, of element {row}, is at ({shown}), not a finite place")


def refuse_flat(points: NDArray[np.float64], elements: Elements) -> None:
    """MeshError if no element has an area, as where a plane is written without one of its axes."""
    for rows in (elements[:_TRIED], elements):
        a, b = points[rows[:, 2]] - points[rows[:, 0]], points[rows[:, -1]] - points[rows[:, 1]]
        if rows.shape[1] == 3:
            b = points[rows[:, 1]] - points[rows[:, 0]]
        if np.cross(a, b).any():
            return
    used = points[np.unique(elements)]
    widths = np.linalg.svd(used - used[0], compute_uv=False)
    why = ": all its points lie on one line" if widths[1] <= _THIN * widths[0] else ""
    raise MeshError(f"its elements have no area{why}")


def oriented(points: NDArray[np.float64], elements: Elements) -> Elements:
    """Reverse elements so that neighbours agree, and plane meshes run counter-clockwise.

    In each connected part neighbours are made to agree first, across edges of two elements. A
    part that lies in a plane z = const is then turned so that its signed area is positive; any
    other keeps the orientation of most of its elements. Elements that need no turn are returned
    as they are.

    Raises:
        MeshError: a part cannot be oriented (a Moebius strip).
    """
    m = len(elements)
    one, other, agree = _neighbours(elements, len(points))
    weight = np.ones(m)
    if np.ptp(points[:, 2]) <= 1e-12 * max(1.0, float(np.abs(points).max())):
        x, y = points[elements][..., 0], points[elements][..., 1]
        weight = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    if agree.all() and (weight >= 0.0).all():
        return elements.copy()  # most files
    # node e stands for element e as it is, node m + e for e turned round
    cross = np.where(agree, 0, m)
    start = np.concatenate([one, one + m])
    end = np.concatenate([other + cross, other + m - cross])
    _, label = components(start, end, 2 * m)
    same = np.flatnonzero(label[:m] == label[m:])
    if same.size:
        raise MeshError(
            f"its elements cannot be oriented alike (as on a Moebius strip), element {same[0]} "
            "among them"
        )
    # each part appears twice, once turned; the smaller label of the two names the part
    part = np.minimum(label[:m], label[m:])
    turned = label[:m] != part
    total = np.bincount(part, np.where(turned, -weight, weight), minlength=2 * m)
    turned ^= total[part] < 0
    result = elements.copy()
    result[turned] = elements[turned][:, ::-1]
    return result


def _neighbours(elements: Elements, count: int) -> tuple[Elements, Elements, NDArray[np.bool_]]:
    """Return pairs of elements with a common edge, and whether they run along it both ways.

    Edges of three elements and more are left out; the mesh will be refused for them.
    """
    k = elements.shape[1]
    start, end = elements.ravel(), np.roll(elements, -1, axis=1).ravel()
    key = np.minimum(start, end) * count + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    _, first, times = np.unique(key[order], return_index=True, return_counts=True)
    h, g = order[first[times == 2]], order[first[times == 2] + 1]
    return h // k, g // k, start[h] != start[g]


def flags(data: dict[str, NDArray[np.generic]], count: int) -> NDArray[np.bool_] | None:
    """Return the geometric flags among a file's data, None if there are none or they make none."""
    values = _numbers(data, "geometric", count)
    if values is None or not np.isin(values, (0.0, 1.0)).all():
        return None
    return values == 1.0


def desired(data: dict[str, NDArray[np.generic]], count: int) -> NDArray[np.int64] | None:
    """Return the desired degrees among a file's data, None if there are none or they make none."""
    values = _numbers(data, "desired_degree", count)
    if values is None or not ((values >= 1) & (values <= _MOST_DEGREE)).all():
        return None
    whole = np.rint(values)
    return whole.astype(np.int64) if (whole == values).all() else None


def _numbers(
    data: dict[str, NDArray[np.generic]], name: str, count: int
) -> NDArray[np.float64] | None:
    if name not in data:
        return None
    values = np.asarray(data[name])
    if values.size != count or values.dtype.kind not in "biuf":
        return None
    return values.reshape(count).astype(float)
