"""Fills of elements by a measure, a block or a chord; the same in the window, pictures and pages.

The scale of a measure runs from the plain fill, where an element is good, to a strong violet: in
lightness it changes in one direction only, so that colour-blind people and grey prints keep the
order, and it is none of the colours of irregular vertices.
"""

from __future__ import annotations

import colorsys

import numpy as np

from meshwright.graphics.theme import Theme
from meshwright_core import HalfEdgeMesh

PLAIN, BLOCK, CHORD, JACOBIAN, SHAPE = "plain", "block", "chord", "jacobian", "shape"
TITLES = {
    PLAIN: "Nothing",
    BLOCK: "Block",
    CHORD: "Chord",
    JACOBIAN: "Scaled Jacobian",
    SHAPE: "Shape",
}
"""What elements can be coloured by."""
MEASURES = (JACOBIAN, SHAPE)
COLOUR_BY = "view/colour"
"""The setting of what elements are coloured by."""

STOPS = (0.0, 0.3, 0.6, 1.0)
"""Values of a measure at which the colours of :func:`scale` stand; linear in between."""
SCALES = {
    "light": ("#4a1a6e", "#8e63b4", "#c7b4dc", ""),
    "dark": ("#ecd2ff", "#a47bcb", "#523f66", ""),
}
"""The colours at :data:`STOPS` by theme; the last one is the theme's plain fill."""

HUES = ("#0f8b8d", "#c58b2a", "#7a5bb5", "#5b8c3a", "#b5577a", "#4a78b8", "#8a6f4e")
"""Hues of blocks and chords. Neighbouring blocks get different ones."""
_GOLDEN = 0.61803398875
"""Turns between consecutive hues of many chords: the golden section spreads them evenly."""
BLOCK_SHARE = 0.3
"""Share of the hue in the fill of a block."""


def named(colour: str) -> str:
    """A title of :data:`TITLES` within a sentence: ``scaled Jacobian``."""
    title = TITLES[colour]
    return title[:1].lower() + title[1:]


def scale(theme: Theme) -> list[str]:
    """The colours at :data:`STOPS`."""
    return [colour or theme.fill for colour in SCALES[theme.name]]


def measure_colours(values: np.ndarray, theme: Theme) -> np.ndarray:
    """(n, 3) uint8 colours of the values (n,) of a measure; plain where there is none (nan)."""
    stops = np.array([_rgb(colour) for colour in scale(theme)])
    known = np.nan_to_num(values, nan=1.0)
    parts = [np.interp(known, STOPS, stops[:, channel]) for channel in range(3)]
    found: np.ndarray = np.rint(np.stack(parts, axis=-1)).astype(np.uint8)
    return found


def block_colours(mesh: HalfEdgeMesh, theme: Theme) -> tuple[np.ndarray, int]:
    """(m, 3) uint8 colours of the elements of a quad mesh by their blocks, and how many those are.

    Blocks that share an edge get different colours, as long as the hues suffice.
    """
    from meshwright_core.analysis.blocks import block_of  # brings in parts of scipy
    from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN, TWIN

    block = block_of(mesh)
    count = int(block.max()) + 1 if len(block) else 0
    slots = int(mesh.arrays.counters[ELEMENT_SLOTS])
    number = np.full(slots, -1)
    number[mesh.element_ids()] = block
    edge = mesh.arrays.edge[: 4 * slots]
    inside = np.flatnonzero((edge[:, ORIGIN] >= 0) & (edge[:, TWIN] >= 0))
    pairs = np.column_stack([number[inside // 4], number[edge[inside, TWIN] // 4]])
    pairs = np.unique(pairs[pairs[:, 0] != pairs[:, 1]], axis=0)
    hue = np.zeros(count, np.int64)
    starts = np.searchsorted(pairs[:, 0], np.arange(count + 1))
    given = np.zeros(count, bool)
    for one in range(count):
        near = pairs[starts[one] : starts[one + 1], 1]
        taken = set(hue[near[given[near]]].tolist())
        hue[one] = next((h for h in range(len(HUES)) if h not in taken), one % len(HUES))
        given[one] = True
    palette = np.array([mixed(theme.fill, colour, BLOCK_SHARE) for colour in HUES], np.uint8)
    return palette[hue[block]], count


def chord_lines(mesh: HalfEdgeMesh) -> tuple[np.ndarray, np.ndarray]:
    """The chords of a quad mesh as segments through the middles of their elements' sides.

    Returns the ends (2 m, 2, 2) in the plane, and the chord (2 m,) of each, counted from 0.
    """
    from meshwright_core.analysis.element_division import chords

    points = mesh.points[mesh.elements()][..., :2]
    middles = 0.5 * (points + np.roll(points, -1, axis=1))
    ends = np.concatenate([middles[:, [0, 2]], middles[:, [1, 3]]])
    return ends, chords(mesh).T.ravel()


def mixed(one: str, other: str, share: float) -> tuple[int, int, int]:
    """A colour ``share`` of the way from one to another."""
    a, b = _rgb(one), _rgb(other)
    red, green, blue = (round(x + share * (y - x)) for x, y in zip(a, b, strict=True))
    return red, green, blue


def _rgb(colour: str) -> tuple[int, int, int]:
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue


def chord_colours(count: int, theme: Theme) -> list[str]:
    """A colour for each of so many chords: first :data:`HUES`, then further hues in turn."""
    light = 0.42 if theme.name == "light" else 0.6
    found = []
    for number in range(count):
        if number < len(HUES):
            red, green, blue = (part / 255.0 for part in _rgb(HUES[number]))
            hue, _, strength = colorsys.rgb_to_hls(red, green, blue)
        else:
            hue, strength = (number * _GOLDEN) % 1.0, 0.5
        parts = colorsys.hls_to_rgb(hue, light, min(strength + 0.1, 0.75))
        found.append("#" + "".join(f"{round(255 * part):02x}" for part in parts))
    return found
