"""The figure of a mesh: a drawing with its score, its place in a history, and the score curve.

Pictures and films consist of figures; the window draws the same things in the same colours.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from meshwright.document import score_series
from meshwright.graphics.colouring import JACOBIAN, TITLES, measure_colours
from meshwright.graphics.drawing import (
    Area,
    Disc,
    Drawing,
    Line,
    Polygon,
    Segments,
    Square,
    Text,
    hatching,
    text_width,
)
from meshwright.graphics.halfedge_arrow import arrow
from meshwright.graphics.markers import PIN, READABLE, Markers, label, markers
from meshwright.graphics.theme import Theme, region_fills, region_swatches, theme
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import ORIGIN, TWIN
from meshwright_core.geometry import quality
from meshwright_core.geometry.edge_curves import curved_edge_polylines
from meshwright_core.geometry.edge_lines import EdgeLines
from meshwright_core.geometry.element_shapes import element_shapes

REFERENCE = 800.0
"""Lines and letters have their nominal size in a figure whose shorter side has these pixels."""
HEAD, FOOT = 64.0, 112.0
"""Nominal height of the text above the mesh, and of the score curve below it."""
MARGIN = 24.0
MOST_INVERTED = 500
"""The most inverted elements that are hatched."""
INTERFACE = 0.7
"""Width of the line between two regions, relative to that of the boundary."""


@dataclass(frozen=True)
class FigureOptions:
    """What a figure shows.

    ``size`` is in pixels. ``numbers`` are those inside the discs of irregular vertices; ``score``
    stands above the mesh, ``curve`` below it; ``changes`` are edges that the last step added and
    removed. ``theme`` and ``colours`` are as for :func:`meshwright.graphics.theme.theme`. ``unit``
    scales lines and letters; 0: in proportion to the size. ``measure`` colours the elements by
    ``"jacobian"`` or ``"shape"``, with a legend; empty: not. ``halfedge`` is drawn as an arrow on
    its side of the edge; -1: none.
    """

    size: tuple[int, int] = (960, 720)
    theme: str = "light"
    numbers: bool = True
    score: bool = True
    curve: bool = True
    changes: bool = True
    colours: str = "vermilion"
    unit: float = 0.0
    measure: str = ""
    halfedge: int = -1

    @property
    def palette(self) -> Theme:
        """The colours themselves."""
        return theme(self.theme, self.colours)


@dataclass(frozen=True)
class HistoryMoment:
    """Where a mesh stands in its history.

    ``title`` and ``detail`` are text; ``added`` and ``removed`` (n, 2, 2) are the ends, in the
    plane, of edges that the last step added and deleted; ``scores`` and ``optima`` (m,) are those
    of all states, ``state`` is the index of the present one.
    """

    title: str = ""
    detail: str = ""
    added: np.ndarray = field(default_factory=lambda: np.empty((0, 2, 2)))
    removed: np.ndarray = field(default_factory=lambda: np.empty((0, 2, 2)))
    scores: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=int))
    optima: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=int))
    state: int = 0


def edges(mesh: HalfEdgeMesh) -> np.ndarray:
    """Every edge once, as vertex ids (n, 2)."""
    both = mesh.arrays.edge[: mesh.k * len(mesh.arrays.element_mark)]
    origin, twin = both[:, ORIGIN].astype(np.int64), both[:, TWIN]
    target = np.roll(origin.reshape(-1, mesh.k), -1, axis=1).ravel()
    once = (origin >= 0) & ((twin < 0) | (twin > np.arange(len(twin))))
    return np.column_stack([origin[once], target[once]])


def fitted(
    mesh: HalfEdgeMesh, options: FigureOptions, moment: HistoryMoment | None = None
) -> Viewport:
    """The viewport that shows the whole mesh between the text and the score curve."""
    width, height = options.size
    unit = _unit(options)
    head = HEAD * unit if options.score else 0.0
    foot = FOOT * unit if _has_curve(options, moment) else 0.0
    room = (width, max(int(height - head - foot), 16))
    places = mesh.points[mesh.vertices()]
    # a curved side may reach far beyond the vertices on it
    curved = curved_edge_polylines(mesh, 1e-3 * float(np.ptp(places, axis=0).max()))[2]
    view = Viewport(size=room).fitted(
        np.vstack([places, curved]), max(MARGIN * unit, 0.06 * min(room))
    )
    x, y = view.centre
    return Viewport((x, y + (head - foot) / (2.0 * view.pixels)), view.pixels, (width, height))


def figure(
    mesh: HalfEdgeMesh,
    options: FigureOptions | None = None,
    moment: HistoryMoment | None = None,
    viewport: Viewport | None = None,
) -> Drawing:
    """Draw the present state of ``mesh``; ``viewport`` None: as :func:`fitted` makes it."""
    options = options or FigureOptions()
    view = viewport or fitted(mesh, options, moment)
    colours, unit = options.palette, _unit(options)
    drawing = Drawing(options.size, colours.background, summary(mesh))
    marks = markers(mesh)
    lines = EdgeLines(mesh, view.tolerance)
    rims = lines.rims()
    width = _edge_width(mesh, lines, view, unit)
    drawing.add(*_fills(lines, rims, view, colours))
    if options.measure:
        drawing.add(*_measured_fills(mesh, lines, view, colours, options.measure))
    if options.changes and moment is not None and len(moment.removed):
        gone = view.to_screen(moment.removed)
        drawing.add(Segments(gone, colours.faint, 1.3 * unit, dash=5.0 * unit))
    drawing.add(edge_lines(lines, view, colours.edge, width))
    if options.changes and moment is not None and len(moment.added):
        drawing.add(Segments(view.to_screen(moment.added), colours.accent, 2.6 * unit))
    _add_inverted(drawing, mesh, lines, view, colours, unit)
    thick = max(2.0 * unit, 1.3 * width)
    for line in lines.interfaces():
        drawing.add(Line(view.to_screen(line), colours.boundary, INTERFACE * thick))
    for rim in rims:
        drawing.add(Line(view.to_screen(_ring(lines.chained(rim))), colours.boundary, thick))
    _add_markers(drawing, marks, view, colours, unit, options.numbers)
    if options.halfedge >= 0:
        corners = mesh.points[mesh.corners(np.array([options.halfedge // mesh.k]))[0], :2]
        tail, neck, point = arrow(view.to_screen(corners) / unit, options.halfedge % mesh.k)
        shaft = Line(unit * np.array([tail, neck]), colours.arrow, 2.6 * unit)
        drawing.add(shaft, Polygon(unit * point, colours.arrow))
    if options.score:
        _add_head(drawing, mesh, moment, colours, unit)
        _add_legend(drawing, mesh, moment, colours, unit)
    has_curve = _has_curve(options, moment)
    if options.measure:
        foot = FOOT * unit if has_curve else 0.0
        _add_scale(drawing, options.measure, colours, unit, options.size[1] - foot)
    if moment is not None and has_curve:
        _add_curve(drawing, moment, colours, unit)
    return drawing


def below_edges(drawing: Drawing) -> int:
    """The number of shapes of a figure that lie below the edges: the fills."""
    return next(i for i, shape in enumerate(drawing.shapes) if not isinstance(shape, Area))


def edge_lines(lines: EdgeLines, view: Viewport, colour: str, width: float) -> Segments:
    """All edges, along their curves."""
    return Segments(view.to_screen(lines.pieces(lines.once())), colour, width)


def summary(mesh: HalfEdgeMesh) -> str:
    """``s 8, optimum 5, 24 quads``."""
    return f"s {mesh.score}, optimum {mesh.optimum}, {elements(mesh)}"


def elements(mesh: HalfEdgeMesh) -> str:
    """``24 quads``."""
    noun = "quad" if mesh.k == 4 else "triangle"
    return f"{mesh.n_elements:,} {noun}{'' if mesh.n_elements == 1 else 's'}"


def _unit(options: FigureOptions) -> float:
    return options.unit or min(max(min(options.size) / REFERENCE, 0.45), 6.0)


def _has_curve(options: FigureOptions, moment: HistoryMoment | None) -> bool:
    return options.curve and moment is not None and len(moment.scores) > 1


def _fills(lines: EdgeLines, rims: list[np.ndarray], view: Viewport, colours: Theme) -> list[Area]:
    """The area of the mesh, or those of its regions in different tints."""
    count = lines.region_count
    loops = [rims] if count == 1 else [lines.rims(region) for region in range(count)]
    return [
        Area([view.to_screen(lines.chained(rim)) for rim in around], fill)
        for around, fill in zip(loops, region_fills(colours, count), strict=True)
    ]


def _measured_fills(
    mesh: HalfEdgeMesh, lines: EdgeLines, view: Viewport, colours: Theme, measure: str
) -> list[Area]:
    """The elements in the colours of a measure."""
    values = quality.scaled_jacobian(mesh) if measure == JACOBIAN else element_shapes(mesh)
    fills = ["#" + bytes(one).hex() for one in measure_colours(values, colours)]
    outlines = lines.outlines(mesh.element_ids())
    return [Area([view.to_screen(one)], fill) for one, fill in zip(outlines, fills, strict=True)]


def _add_scale(drawing: Drawing, measure: str, colours: Theme, unit: float, bottom: float) -> None:
    """The scale of a measure in the lower right corner, above ``bottom``."""
    width, height, steps = 150.0 * unit, 8.0 * unit, 30
    left, top = drawing.size[0] - MARGIN * unit - width, bottom - 26.0 * unit
    shades = measure_colours((np.arange(steps) + 0.5) / steps, colours)
    for number, shade in enumerate(shades):
        x, right = (left + (number + add) * width / steps for add in (0, 1))
        corners = [(x, top), (right, top), (right, top + height), (x, top + height)]
        drawing.add(Area([np.array(corners)], "#" + bytes(shade).hex()))
    size, y = 11.0 * unit, top + height + 9.0 * unit
    drawing.add(
        Text(TITLES[measure], (left, top - 9.0 * unit), size, colours.muted),
        Text("0", (left, y), size, colours.muted),
        Text(".5", (left + 0.5 * width, y), size, colours.muted, "middle"),
        Text("1", (left + width, y), size, colours.muted, "right"),
    )


def _ring(points: np.ndarray) -> np.ndarray:
    return np.vstack([points, points[:1]])


def _edge_width(mesh: HalfEdgeMesh, lines: EdgeLines, view: Viewport, unit: float) -> float:
    """Line width of edges in pixels: thinner where edges are short."""
    pairs = lines.ends(lines.once())
    if len(pairs) == 0:
        return unit
    some = mesh.points[pairs[:: max(1, len(pairs) // 2000)], :2]
    typical = float(np.median(np.hypot(*(some[:, 1] - some[:, 0]).T))) * view.pixels
    return min(1.2 * unit, max(0.12 * typical, 0.34))


def _add_inverted(
    drawing: Drawing,
    mesh: HalfEdgeMesh,
    lines: EdgeLines,
    view: Viewport,
    colours: Theme,
    unit: float,
) -> None:
    """Hatch inverted elements, which solvers do not accept."""
    ids = quality.inverted(mesh)[:MOST_INVERTED]
    if len(ids) == 0:
        return
    outlines = [view.to_screen(outline) for outline in lines.outlines(ids)]
    hatches = np.concatenate([hatching(one, 6.0 * unit) for one in outlines])
    rims = np.concatenate([np.stack([one, np.roll(one, -1, 0)], 1) for one in outlines])
    drawing.add(Segments(hatches, colours.warning, 0.9 * unit))
    drawing.add(Segments(rims, colours.warning, 1.5 * unit))


def _add_markers(
    drawing: Drawing, marks: Markers, view: Viewport, colours: Theme, unit: float, numbers: bool
) -> None:
    for x, y in view.to_screen(marks.corner_places).tolist():
        drawing.add(Square((x, y), 3.5 * unit, colours.corner))
    for x, y in view.to_screen(marks.anchor_places).tolist():
        drawing.add(
            Square((x, y), 2.75 * unit, colours.corner),
            Square((x, y), 1.5 * unit, colours.background),
        )
    # radii are those of the window; larger figures have larger discs
    radii = marks.radii(Viewport(view.centre, view.pixels / unit, view.size)) * unit
    places = view.to_screen(marks.places).tolist()
    rows = zip(places, marks.delta.tolist(), radii.tolist(), marks.corners.tolist(), strict=True)
    for (x, y), delta, radius, corner in rows:
        if corner:
            drawing.add(Square((x, y), radius, colours.corner))
        drawing.add(
            Disc((x, y), radius + 1.2 * unit, colours.background),
            Disc((x, y), radius, colours.plus if delta > 0 else colours.minus),
        )
        if numbers and radius >= READABLE * unit:
            drawing.add(Text(label(delta), (x, y), 1.15 * radius, colours.marker_text, "middle"))
    for x, y in view.to_screen(marks.locked_places).tolist():
        drawing.add(Disc((x, y), 12.0 * unit, colours.boundary, 1.5 * unit))
    for x, y in view.to_screen(marks.pinned_places).tolist():
        head = (x + PIN[0] * unit, y - PIN[1] * unit)
        drawing.add(
            Line(np.array([(x, y), head]), colours.boundary, 1.5 * unit),
            Disc(head, PIN[2] * unit, colours.boundary),
        )


def _add_head(
    drawing: Drawing, mesh: HalfEdgeMesh, moment: HistoryMoment | None, colours: Theme, unit: float
) -> None:
    """Two lines of text at the left, score and optimum at the right, as in the paper's figures."""
    left, right = MARGIN * unit, drawing.size[0] - MARGIN * unit
    first, second = 25.0 * unit, 48.0 * unit
    title = moment.title if moment is not None else ""
    detail = moment.detail if moment is not None else ""
    drawing.add(
        Text(title or elements(mesh), (left, first), 19.0 * unit, colours.text, "left", True),
        Text(f"s {mesh.score:,}", (right, first), 22.0 * unit, colours.text, "right", True),
    )
    if detail:
        drawing.add(Text(detail, (left, second), 13.5 * unit, colours.muted))
    solved = mesh.score == mesh.optimum
    words = "at the optimum" if solved else f"optimum {mesh.optimum:,}"
    colour = colours.accent if solved else colours.muted
    drawing.add(Text(words, (right, second), 13.5 * unit, colour, "right", solved))


def _add_legend(
    drawing: Drawing, mesh: HalfEdgeMesh, moment: HistoryMoment | None, colours: Theme, unit: float
) -> None:
    """The names of several regions, each beside its colour, in the second line of the head."""
    names = mesh.region_names
    if len(names) < 2:
        return
    size, y, gap = 13.5 * unit, 48.0 * unit, 16.0 * unit
    left = MARGIN * unit
    if moment is not None and moment.detail:
        left += text_width(moment.detail, size) + 1.5 * gap
    room = drawing.size[0] - (MARGIN + 150.0) * unit
    swatches = region_swatches(colours, len(names))
    for number, (name, swatch) in enumerate(zip(names, swatches, strict=True), start=1):
        words = name or f"region {number}"
        width = 17.0 * unit + text_width(words, size)
        last = number == len(names)
        if left + width + (0.0 if last else 5.0 * gap) > room:
            words = f"and {len(names) - number + 1:,} more"
            drawing.add(Text(words, (left, y), size, colours.muted))
            return
        half = 5.0 * unit
        drawing.add(
            Square((left + half, y), half, swatch),
            Text(words, (left + 17.0 * unit, y), size, colours.muted),
        )
        left += width + gap


def _add_curve(drawing: Drawing, moment: HistoryMoment, colours: Theme, unit: float) -> None:
    """Score against states: in the accent colour up to the present state, pale after it."""
    width, height = drawing.size
    left, right = (MARGIN + 40.0) * unit, width - (MARGIN + 4.0) * unit
    top = height - (FOOT - 18.0) * unit
    box = score_series.frame(
        moment.scores, moment.optima, left, top, right - left, (FOOT - 46.0) * unit
    )
    goal = float(box.y(moment.optima[moment.state]))
    level = np.array([[[left, goal], [right, goal]]])
    drawing.add(Segments(level, colours.muted, 1.0 * unit, dash=4.0 * unit))
    if box.broken:
        drawing.add(Segments(score_series.break_mark(box, unit), colours.muted, 1.2 * unit))
    size = 11.5 * unit
    labels = {float(box.y(moment.scores[0])): f"{moment.scores[0]:,}"}
    labels[goal] = f"{moment.optima[moment.state]:,}"
    for y, text in labels.items():
        drawing.add(Text(text, (left - 10.0 * unit, y), size, colours.muted, "right"))
    x = float(box.x(moment.state))
    line = score_series.steps(moment.scores, box)
    drawing.add(Line(line, colours.faint, 1.2 * unit))
    done = line[line[:, 0] <= x + 1e-6]
    here = (x, float(box.y(moment.scores[moment.state])))
    # the step to the present state ends at the next point, which has the same x
    done = np.vstack([done[: np.searchsorted(done[:, 0], x)], _ascent(line, x), [here]])
    drawing.add(
        Line(done, colours.accent, 2.0 * unit),
        Disc(here, 6.0 * unit, colours.background),
        Disc(here, 4.5 * unit, colours.accent),
    )
    drawing.add(Text("score", (left, height - 14.0 * unit), size, colours.muted))
    last = len(moment.scores) - 1
    words = f"step {moment.state:,} of {last:,}"
    drawing.add(Text(words, (right, height - 14.0 * unit), size, colours.muted, "right"))


def _ascent(line: np.ndarray, x: float) -> np.ndarray:
    """The first point of ``line`` at ``x``, at the score of the state before; none at the start."""
    at = np.flatnonzero(np.abs(line[:, 0] - x) < 1e-6)
    return line[at[:1]]
