"""The gallery of named domains, and the random polygons of the benchmark.

All shapes are about one to two units across. The curved sides of most are polylines just fine
enough to look round on a coarse mesh; their points are not corners. Those of
:mod:`.curved_shapes` are true curves.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwright_core.domains import curved_shapes
from meshwright_core.domains.airfoils import naca4
from meshwright_core.domains.domain import Domain, Points
from meshwright_core.errors import MeshError


def gallery() -> dict[str, Domain]:
    """Return every named shape, in the order in which a menu should list them."""
    return {name: _named(name) for name in _SHAPES}


def names() -> tuple[str, ...]:
    """Return the names of the gallery's shapes without building them."""
    return tuple(_SHAPES)


def shape(name: str) -> Domain:
    """Return the shape of the gallery that has this name.

    Raises:
        MeshError: there is none; the message names those that are spelt alike.
    """
    if name not in _SHAPES:
        close = difflib.get_close_matches(name.lower().replace("_", "-"), _SHAPES, 3, 0.5)
        hint = (
            f"did you mean {' or '.join(close)}?" if close else f"there are {', '.join(_SHAPES)}."
        )
        raise MeshError(f"There is no shape named {name!r}; {hint}")
    return _named(name)


def random_corners(sides: int, rng: np.random.Generator) -> Points:
    """Return the (sides, 2) corners of a random polygon of the benchmark, counter-clockwise.

    Corner i lies at the angle 2 pi i / sides and the radius 0.5 + 0.5 U(0, 1).

    Raises:
        MeshError: fewer than three sides.
    """
    if sides < 3:
        raise MeshError(f"A polygon needs at least 3 sides, not {sides}.")
    radius = 0.5 + 0.5 * rng.random(sides)
    angle = 2 * np.pi * np.arange(sides) / sides
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def random_polygon(sides: int, rng: np.random.Generator) -> Domain:
    """Return a random polygon of the benchmark as a domain; see `random_corners`."""
    outline = random_corners(sides, rng)
    return Domain(outline, corners=np.ones(sides, bool), name=f"polygon-{sides}")


def _named(name: str) -> Domain:
    domain = _SHAPES[name]()
    domain.name = name
    return domain


def _arc(
    centre: ArrayLike, radius: float, start: float, stop: float, pieces: int, ends: bool = True
) -> Points:
    """Return points on an arc from `start` to `stop` degrees, cut into `pieces` equal pieces."""
    angle = np.radians(np.linspace(start, stop, pieces + 1))
    if not ends:
        angle = angle[1:-1]
    return np.asarray(centre) + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def _circle(centre: ArrayLike, radius: float, pieces: int, start: float = 0.0) -> Points:
    return _arc(centre, radius, start, start + 360.0, pieces)[:-1]


def _box(x0: float, y0: float, x1: float, y1: float) -> Points:
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


def _none(loop: Points) -> NDArray[np.bool_]:
    return np.zeros(len(loop), dtype=bool)


def _around(outline: ArrayLike, *holes: Points) -> Domain:
    """Return a domain whose outline has straight sides and whose holes are round."""
    return Domain(outline, holes, hole_corners=[_none(hole) for hole in holes])


def _square() -> Domain:
    return Domain(_box(-0.7, -0.7, 0.7, 0.7))


def _polygon() -> Domain:
    radius = np.array([0.98, 0.72, 0.95, 0.66, 0.9, 0.97, 0.6, 0.93, 0.7, 0.88])
    angle = 2 * np.pi * np.arange(10) / 10
    return Domain(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))


def _star() -> Domain:
    angle = np.pi / 2 + np.pi * np.arange(10) / 5
    radius = np.where(np.arange(10) % 2 == 0, 1.0, 0.45)
    return Domain(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))


def _l_shape() -> Domain:
    corners = [(0, 0), (1.5, 0), (1.5, 0.75), (0.75, 0.75), (0.75, 1.5), (0, 1.5)]
    return Domain(np.array(corners))


def _t_shape() -> Domain:
    right = np.array([[0.25, 0.0], [0.25, 1.0], [0.8, 1.0], [0.8, 1.5]])
    return Domain(np.vstack([right, right[::-1] * [-1, 1]]))


def _u_shape() -> Domain:
    right = np.array([[0.75, 0.0], [0.75, 1.4], [0.25, 1.4], [0.25, 0.5]])
    return Domain(np.vstack([right, right[::-1] * [-1, 1]]))


def _h_shape() -> Domain:
    right = np.array([[0.25, -0.2], [0.25, -0.75], [0.75, -0.75]])
    right = np.vstack([right, right[::-1] * [1, -1]])
    return Domain(np.vstack([right, -right]))


def _cross() -> Domain:
    corner = np.array([[0.8, -0.27], [0.8, 0.27], [0.27, 0.27]])
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    return Domain(np.vstack([corner @ np.linalg.matrix_power(turn, i) for i in range(4)]))


def _single_notch() -> Domain:
    return Domain(
        [[-0.9, -0.6], [0.9, -0.6], [0.9, 0.6], [0.2, 0.6], [0, -0.1], [-0.2, 0.6], [-0.9, 0.6]]
    )


def _double_notch() -> Domain:
    half = np.array([[-0.9, -0.6], [-0.2, -0.6], [0, -0.15], [0.2, -0.6], [0.9, -0.6]])
    return Domain(np.vstack([half, -half]))


def _square_with_hole() -> Domain:
    return Domain(_box(-0.8, -0.8, 0.8, 0.8), [_box(-0.3, -0.3, 0.3, 0.3)])


def _disc() -> Domain:
    outline = _circle((0, 0), 0.9, 20)
    return Domain(outline, corners=_none(outline))


def _half_disc() -> Domain:
    outline = _arc((0, 0), 0.9, 0, 180, 10)
    corners = _none(outline)
    corners[[0, -1]] = True
    return Domain(outline, corners=corners)


def _annulus() -> Domain:
    outline, hole = _circle((0, 0), 0.9, 20), _circle((0, 0), 0.4, 14)
    return Domain(outline, [hole], corners=_none(outline), hole_corners=[_none(hole)])


def _disc_with_square_hole() -> Domain:
    outline = _circle((0, 0), 0.9, 20, 9.0)
    return Domain(outline, [_box(-0.35, -0.35, 0.35, 0.35)], corners=_none(outline))


def _plate_with_holes() -> Domain:
    holes = [_circle((x, y), 0.17, 10) for x in (-0.55, 0.55) for y in (-0.3, 0.3)]
    return _around(_box(-1, -0.65, 1, 0.65), *holes, _circle((0, 0), 0.22, 12))


def _bracket() -> Domain:
    """An angle bracket: two arms, a fillet between them, rounded ends, a hole in each arm."""
    outline = np.vstack(
        [
            [[0, 0]],
            _arc((1.3, 0.3), 0.3, -90, 90, 6),
            _arc((0.85, 0.85), 0.25, -90, -180, 3),
            _arc((0.3, 1.3), 0.3, 0, 180, 6),
        ]
    )
    holes = [_circle((1.3, 0.3), 0.13, 10), _circle((0.3, 1.3), 0.13, 10)]
    corners = _none(outline)
    corners[0] = True
    return Domain(outline, holes, corners, [_none(hole) for hole in holes])


def _gear() -> Domain:
    """A spur gear of ten teeth on a bore."""
    teeth = 10
    pitch = 360.0 / teeth
    tooth = [(0.72, -0.27), (0.95, -0.15), (0.95, 0.15), (0.72, 0.27)]
    angle = np.radians([(i + at) * pitch for i in range(teeth) for _, at in tooth])
    radius = np.tile([r for r, _ in tooth], teeth)
    outline = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    return _around(outline, _circle((0, 0), 0.3, 12))


def _airfoil() -> Domain:
    wing = naca4("2415", pieces=9, chord=1.0) - [0.5, 0]
    corners = _none(wing)
    corners[0] = True
    return Domain(_box(-1, -0.6, 1, 0.6), [wing], hole_corners=[corners])


def _arch() -> Domain:
    """A semicircular arch on two feet."""
    outer, inner = _arc((0, 0), 1.0, 0, 180, 12), _arc((0, 0), 0.55, 180, 0, 10)
    corners = np.zeros(len(outer) + len(inner), dtype=bool)
    corners[[0, 12, 13, -1]] = True
    return Domain(np.vstack([outer, inner]), corners=corners)


_SHAPES: dict[str, Callable[[], Domain]] = {
    "star": _star,
    "polygon": _polygon,
    "square": _square,
    "l-shape": _l_shape,
    "t-shape": _t_shape,
    "u-shape": _u_shape,
    "h-shape": _h_shape,
    "cross": _cross,
    "single-notch": _single_notch,
    "double-notch": _double_notch,
    "square-with-hole": _square_with_hole,
    "disc-with-square-hole": _disc_with_square_hole,
    "disc": _disc,
    "half-disc": _half_disc,
    "annulus": _annulus,
    "arch": _arch,
    "plate-with-holes": _plate_with_holes,
    "bracket": _bracket,
    "gear": _gear,
    "airfoil": _airfoil,
    "plate-with-round-hole": curved_shapes.plate_with_round_hole,
    "filleted-bracket": curved_shapes.filleted_bracket,
    "duct-bend": curved_shapes.duct_bend,
    "nozzle": curved_shapes.nozzle,
    "pipe": curved_shapes.pipe,
    "airfoil-in-box": curved_shapes.airfoil_in_box,
    "two-materials": curved_shapes.two_materials,
    "plate-with-insert": curved_shapes.plate_with_insert,
    "motor-segment": curved_shapes.motor_segment,
}
