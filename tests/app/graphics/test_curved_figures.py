"""Pictures of meshes with curved edges and several regions."""

import numpy as np
import pytest

from meshwright.experiments.block_view import block_view
from meshwright.experiments.mesh_thumbnail import thumbnail
from meshwright.experiments.picture import LIVE
from meshwright.graphics.drawing import Area, Line, Segments, Square, Text, svg
from meshwright.graphics.export.film import Film
from meshwright.graphics.mesh_figure import FigureOptions, below_edges, edges, figure, fitted
from meshwright.graphics.theme import THEMES, region_fills, region_swatches
from meshwright_core import HalfEdgeMesh
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.mesh_on_domain import placed
from meshwright_core.geometry import quality
from meshwright_core.geometry.edge_lines import EdgeLines

SIZE = (600, 600)
OPTIONS = FigureOptions(SIZE)


def rings(turns: tuple[float, ...], count: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and quads of concentric rings with these radii, the largest first."""
    angle = 2.0 * np.pi * np.arange(count) / count
    way = np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.concatenate([radius * way for radius in turns])
    i = np.arange(count)
    j = np.roll(i, -1)
    quads = [
        np.column_stack([n + j, n + i, n - count + i, n - count + j])
        for n in range(count, count * len(turns), count)
    ]
    return points, np.concatenate(quads)


def circle(radius: float) -> list[Curve]:
    return [Curve.arc((0, 0), radius, 0.0, 2.0 * np.pi)]


@pytest.fixture
def ring() -> HalfEdgeMesh:
    """Four quads between circles of radius 2 and 1."""
    points, quads = rings((2.0, 1.0), 4)
    return placed(
        HalfEdgeMesh.from_elements(points, quads), Domain.from_curves([circle(2.0), circle(1.0)])
    )


@pytest.fixture
def two() -> HalfEdgeMesh:
    """Steel between radius 3 and 2, copper between 2 and 1."""
    points, quads = rings((3.0, 2.0, 1.0), 8)
    domain = Domain.from_regions(
        [("steel", [circle(3.0), circle(2.0)]), ("copper", [circle(2.0), circle(1.0)])]
    )
    return placed(HalfEdgeMesh.from_elements(points, quads), domain)


def shapes(drawing, kind, **values):
    found = [shape for shape in drawing.shapes if isinstance(shape, kind)]
    return [s for s in found if all(getattr(s, name) == value for name, value in values.items())]


def radii(drawing, mesh, points) -> np.ndarray:
    """Distances from the centre of the plane, in units of the mesh."""
    view = fitted(mesh, OPTIONS)
    x, y = view.to_plane(*np.asarray(points, float).reshape(-1, 2).T)
    return np.hypot(x, y)


def test_boundaries_and_fills_follow_the_curves(ring):
    drawing = figure(ring, OPTIONS)
    pixels = fitted(ring, OPTIONS).pixels
    colours = OPTIONS.palette
    (area,) = shapes(drawing, Area)
    for lines in (area.loops, [s.points for s in shapes(drawing, Line, colour=colours.boundary)]):
        assert len(lines) == 2
        for line, radius in zip(sorted(lines, key=lambda p: np.ptp(p)), (1.0, 2.0), strict=True):
            middles = 0.5 * (line[1:] + line[:-1])
            away = np.abs(radii(drawing, ring, [*line, *middles]) - radius) * pixels
            assert away.max() < 0.1
            assert len(line) < 200
    (lines,) = shapes(drawing, Segments, colour=colours.edge)
    # no chord: what is not on a circle runs from one to the other
    inside = radii(drawing, ring, lines.ends.mean(axis=1))
    assert ((np.abs(inside - 1.5) < 1e-9) | (np.abs(inside - 1) < 0.01) | (inside > 1.99)).all()
    assert drawing.shapes.index(lines) == below_edges(drawing) == 1


def test_zoom_makes_curves_finer_and_not_angular(ring):
    view = fitted(ring, OPTIONS)
    near = view.zoomed(200.0, *view.to_screen(np.array([[2.0, 0.0]]))[0])
    for viewport, most in ((view, 200), (near, 4000)):
        drawing = figure(ring, OPTIONS, None, viewport)
        largest = max(
            shapes(drawing, Line, colour=OPTIONS.palette.boundary), key=lambda s: np.ptp(s.points)
        )
        x, y = viewport.to_plane(*(0.5 * (largest.points[1:] + largest.points[:-1])).T)
        assert (np.abs(np.hypot(x, y) - 2.0) * viewport.pixels).max() < 0.1
        assert len(largest.points) < most


def test_hatching_fills_curved_elements(ring):
    ring.move([0], np.array([[0.4, 0.0, 0.0]]))
    assert len(quality.inverted(ring))
    drawing = figure(ring, OPTIONS)
    lines = shapes(drawing, Segments, colour=OPTIONS.palette.warning)
    assert len(lines) == 2
    lines = EdgeLines(ring, 1e-3)
    count = sum(len(outline) for outline in lines.outlines(quality.inverted(ring)))
    assert count > 4 * len(quality.inverted(ring))


def test_regions_are_tinted_and_named(two):
    drawing = figure(two, OPTIONS)
    colours = OPTIONS.palette
    areas = shapes(drawing, Area)
    assert [area.colour for area in areas] == region_fills(colours, 2)
    assert [len(area.loops) for area in areas] == [2, 2]
    assert below_edges(drawing) == 2
    lines = shapes(drawing, Line, colour=colours.boundary)
    assert len(lines) == 3
    interface = min(lines, key=lambda line: line.width)
    assert np.abs(radii(drawing, two, interface.points) - 2.0).max() < 1e-3
    assert (interface.points[0] == interface.points[-1]).all()
    assert sum(line.width > interface.width for line in lines) == 2
    words = [text.text for text in shapes(drawing, Text)]
    assert "steel" in words and "copper" in words
    squares = [square.colour for square in shapes(drawing, Square)]
    assert squares[-2:] == region_swatches(colours, 2)
    assert ">copper<" in svg(drawing)
    single = figure(two, FigureOptions(SIZE, score=False))
    assert not shapes(single, Text, text="steel")


def test_legend_of_many_regions_is_cut(two):
    from dataclasses import replace

    names = tuple(f"material number {i}" for i in range(30))
    two._take_boundary(replace(two.boundary_info, region_names=names))
    drawing = figure(two, OPTIONS)
    words = [text.text for text in shapes(drawing, Text) if text.text.startswith(("mat", "and"))]
    assert words[0] == names[0]
    assert words[-1] == f"and {30 - len(words) + 1} more"
    assert all(text.at[0] < SIZE[0] for text in shapes(drawing, Text))


def test_regions_have_colours_in_pages_too(two):
    page = thumbnail(two, SIZE, LIVE)
    fills = [area.colour for area in shapes(page, Area)]
    assert len(set(fills)) == 2
    assert all(fill.startswith("color-mix(in srgb,#") and "var(--mw-fill" in fill for fill in fills)


def test_interfaces_between_junctions_are_drawn_once():
    points = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 4, 3], [1, 2, 5, 4]], regions=[1, 0])
    lines = EdgeLines(mesh, 1e-3)
    (line,) = lines.interfaces()
    assert sorted(line.tolist()) == [[1, 0], [1, 1]]
    assert [len(lines.rims(region)) for region in (0, 1, None)] == [1, 1, 1]
    assert sorted(lines.chained(lines.rims(1)[0]).tolist()) == [[0, 0], [0, 1], [1, 0], [1, 1]]


def test_true_edges_are_those_of_a_straight_mesh(star):
    lines = EdgeLines(star, 1e-3)
    once = lines.once()
    assert len(once) == star.n_edges
    assert (lines.ends(once) == edges(star)).all()
    assert (lines.pieces(once) == star.points[edges(star)][:, :, :2]).all()
    assert not lines.curved(once).any()
    for loop, rim in zip(star.boundary_loops(), lines.rims(), strict=True):
        assert set(loop.tolist()) == set(lines.ends(rim)[:, 0].tolist())
    outlines = lines.outlines(star.element_ids()[:3])
    assert np.array_equal(outlines, star.points[star.elements()[:3]][:, :, :2])


def test_true_edges_keep_their_state(ring):
    lines = EdgeLines(ring, 1e-3)
    before = lines.pieces(lines.once())
    h = ring.halfedge(0, 1) if ring.halfedge(0, 1) >= 0 else ring.halfedge(1, 0)
    ring.apply("split", h) if ring.check("split", h) else ring.move([0], ring.points[[1]])
    assert (lines.pieces(lines.once()) == before).all()


def test_films_show_changes_along_curves(ring):
    h = next(h for h in range(16) if ring.check("global_split", h))
    film = Film.of_run(ring, [("global_split", h)], "test")
    moment = film.moment(1)
    ends = np.hypot(*np.moveaxis(moment.added, -1, 0))
    assert len(moment.added) > 8
    assert ((np.abs(ends - 1) < 1e-3) | (np.abs(ends - 2) < 1e-3)).any(axis=1).all()
    gone = np.hypot(*moment.removed.mean(axis=1).T)
    assert len(moment.removed) > 8
    assert ((np.abs(gone - 1) < 1e-2) | (np.abs(gone - 2) < 1e-2)).any()


def test_blocks_follow_curves(ring):
    drawing = block_view(ring).drawing(THEMES["light"])
    polygons = [s for s in drawing.shapes if type(s).__name__ == "Polygon"]
    assert max(len(polygon.points) for polygon in polygons) > 20
