"""Twenty parts for block grids: straight, curved, with holes, of two regions, and flows.

Their sides have names. The five first are the tutorial cases of block-structured meshing; each
says how many blocks its tutorial uses.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from meshwright_core.curves.curve import Curve
from meshwright_core.domains import gallery
from meshwright_core.domains.airfoils import airfoil_curves
from meshwright_core.domains.curved_shapes import HALF, QUARTER, box, circle, polygon
from meshwright_core.domains.domain import Domain

TUTORIAL_BLOCKS = {
    "backward-facing step": 3,
    "cylinder in a channel": 8,
    "airfoil with a wake": 6,
    "T-junction": 4,
    "nozzle": 1,
}
"""Blocks that the usual hand-made grids of these cases have: a step is cut into three rectangles; a
ring of four around the cylinder and four more blocks of the channel; a C-grid of six blocks; a
T-junction of four rectangles; a nozzle of one."""


def _named(loops: list[list[Curve]], names: list[list[str]]) -> Domain:
    return Domain.from_curves(loops, names=names)


def _step() -> Domain:
    outline = polygon([(0, 0.5), (1, 0.5), (1, 0), (4, 0), (4, 1.5), (0, 1.5)])
    return _named([outline], [["bottom", "bottom", "bottom", "outlet", "top", "inlet"]])


def _cylinder() -> Domain:
    names = [["bottom", "outlet", "top", "inlet"], ["cylinder"]]
    return _named([box(-1, -1, 3, 1), circle(0, 0, 0.25)], names)


def _airfoil() -> Domain:
    wing = airfoil_curves("0012")
    far = [
        Curve.line((-1, -2), (3, -2)), Curve.line((3, -2), (3, 2)), Curve.line((3, 2), (-1, 2)),
        Curve.arc((-1, 0), 2, QUARTER, HALF),
    ]  # fmt: skip
    return _named([far, wing], [["far", "outlet", "far", "inlet"], ["wing"] * len(wing)])


def _junction() -> Domain:
    outline = polygon([(0, 0), (3, 0), (3, 1), (2, 1), (2, 2.5), (1, 2.5), (1, 1), (0, 1)])
    names = ["wall", "outlet", "wall", "wall", "branch", "wall", "wall", "inlet"]
    return _named([outline], [names])


def _nozzle() -> Domain:
    wall = Curve.through([(3, 0.8), (2.2, 0.62), (1.6, 0.42), (1.2, 0.4), (0.7, 0.58), (0, 0.7)])
    outline = [Curve.line((0, 0), (3, 0)), Curve.line((3, 0), (3, 0.8)), wall]
    outline.append(Curve.line((0, 0.7), (0, 0)))
    return _named([outline], [["axis", "outlet", "wall", "inlet"]])


def _two_layers() -> Domain:
    return Domain.from_regions([
        ("steel", [box(0, 0, 2, 0.5)]), ("copper", [box(0, 0.5, 2, 1)]),
    ])  # fmt: skip


def _inlay() -> Domain:
    plate = [box(-1, -1, 1, 1), circle(0, 0, 0.4)]
    return Domain.from_regions([("plate", plate), ("inlay", [circle(0, 0, 0.4)])])


def _plate_with_holes() -> Domain:
    loops = [box(0, 0, 3, 1), *(circle(x, 0.5, 0.22) for x in (0.5, 1.5, 2.5))]
    names = [["bottom", "right", "top", "left"], *([f"bolt_{i}"] for i in (1, 2, 3))]
    return _named(loops, names)


def _slot() -> Domain:
    arc, line = Curve.arc, Curve.line
    slot = [
        line((-0.4, -0.2), (0.4, -0.2)), arc((0.4, 0), 0.2, -QUARTER, HALF),
        line((0.4, 0.2), (-0.4, 0.2)), arc((-0.4, 0), 0.2, QUARTER, HALF),
    ]  # fmt: skip
    return _named([box(-1, -0.6, 1, 0.6), slot], [["outside"] * 4, ["slot"] * 4])


def _quarter_ring() -> Domain:
    outline = [
        Curve.line((0.5, 0), (1, 0)), Curve.arc((0, 0), 1, 0, QUARTER),
        Curve.line((0, 1), (0, 0.5)), Curve.arc((0, 0), 0.5, QUARTER, -QUARTER),
    ]  # fmt: skip
    return _named([outline], [["start", "outer", "end", "inner"]])


def _bump() -> Domain:
    bump = Curve.arc_through((1, 0), (1.5, 0.1), (2, 0))
    outline = [Curve.line((0, 0), (1, 0)), bump, Curve.line((2, 0), (3, 0))]
    outline += polygon([(3, 0), (3, 1), (0, 1), (0, 0)])[:3]
    return _named([outline], [["bottom", "bump", "bottom", "outlet", "top", "inlet"]])


def _disc() -> Domain:
    return _named([circle(0, 0, 1)], [["rim"]])


def _trapezium() -> Domain:
    return _named(
        [polygon([(0, 0), (3, 0), (2.2, 1), (0.4, 1)])], [["base", "side", "top", "side"]]
    )


def _wedge_flow() -> Domain:
    rise = math.tan(math.radians(15.0))
    outline = polygon([(0, 0), (1, 0), (2.5, 1.5 * rise), (2.5, 1.5), (0, 1.5)])
    return _named([outline], [["symmetry", "wedge", "outlet", "top", "inlet"]])


PARTS: dict[str, Callable[[], Domain]] = {
    "backward-facing step": _step,
    "cylinder in a channel": _cylinder,
    "airfoil with a wake": _airfoil,
    "T-junction": _junction,
    "nozzle": _nozzle,
    "two layers": _two_layers,
    "inlay": _inlay,
    "plate with three holes": _plate_with_holes,
    "plate with a slot": _slot,
    "quarter ring": _quarter_ring,
    "bump in a channel": _bump,
    "disc": _disc,
    "trapezium": _trapezium,
    "compression ramp": _wedge_flow,
    **{
        name: (lambda name=name: gallery.shape(name))  # type: ignore[misc]
        for name in ("l-shape", "cross", "star", "plate-with-round-hole", "duct-bend", "pipe")
    },
}
"""Each makes a new domain."""


def block_parts() -> dict[str, Domain]:
    """The twenty parts by name."""
    found = {}
    for name, make in PARTS.items():
        domain = make()
        domain.name = name
        found[name] = domain
    return found
