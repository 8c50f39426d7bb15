"""The tools of the drawing page without a window: arcs, circles, rectangles, typed dimensions."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshwright.sources import arc_edges
from meshwright.sources.drawing_tools import Pencil, polar, span
from meshwright.sources.polygon_sketch import Sketch
from meshwright_core import MeshError
from meshwright_core.curves.curve import Curve
from meshwright_core.domains import meshing
from meshwright_core.domains.domain import Domain

SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
places = st.tuples(st.floats(-5, 5), st.floats(-5, 5))


@pytest.fixture
def pencil() -> Pencil:
    return Pencil(Sketch())


def draw(pencil: Pencil, tool: str, *given: tuple[float, float]) -> str:
    pencil.tool = tool
    said = ""
    for place in given:
        said = pencil.click(place)
    return said


def domain(pencil: Pencil) -> Domain:
    return Domain.from_json(pencil.sketch.domain(), 1.0)


@given(places, places, st.floats(-4, 4).filter(lambda b: abs(b) > 1e-3))
def test_arcs_agree_with_those_of_drawings(a, b, bulge):
    if math.dist(a, b) < 1e-3:
        return
    curve = Curve.arc_by_bulge(a, b, bulge)
    points = arc_edges.points_of(a, b, bulge)
    _, apart = curve.project(np.array(points))
    assert apart.max() < 1e-9 * max(curve.length, 1.0)
    middle = points[len(points) // 2]
    assert arc_edges.bulge_through(a, middle, b) == pytest.approx(bulge, rel=1e-6)
    share = arc_edges.share_at(a, b, bulge, middle)
    assert share == pytest.approx((len(points) // 2) / (len(points) - 1), abs=1e-6)
    radius = arc_edges.circle_of(a, b, bulge)[1]
    again = arc_edges.bulge_of_radius(a, b, radius, bulge < 0, abs(bulge) > 1)
    assert again == pytest.approx(bulge, rel=1e-3, abs=1e-6)


def test_a_plate_with_three_round_holes(pencil):
    draw(pencil, "rectangle", (0, 0), (8, 4))
    for x in (2.0, 4.0, 6.0):
        draw(pencil, "circle", (x, 2.0), (x + 0.5, 2.0))
    assert pencil.sketch.complete
    made = domain(pencil)
    assert made.area == pytest.approx(32.0 - 3 * math.pi * 0.25, rel=1e-12)
    assert [len(curves) for curves in made.boundary] == [4, 2, 2, 2]
    mesh = meshing.mesh_domain(made, "quad")
    mesh.validate()
    assert mesh.off_curve().max() < 1e-12
    assert mesh.geometric().sum() == 4  # circles have no corners


def test_a_slot_of_lines_and_arcs(pencil):
    draw(pencil, "line", (0, 0), (2, 0))
    draw(pencil, "arc", (2, 1), (2.5, 0.5))
    draw(pencil, "line", (0, 1))
    draw(pencil, "arc", (0, 0), (-0.5, 0.5))
    assert not pencil.sketch.open
    assert domain(pencil).area == pytest.approx(2.0 + math.pi / 4, rel=1e-12)
    pencil.sketch.undo()
    assert pencil.sketch.open


def test_tools_say_why_a_place_cannot_be_used(pencil):
    draw(pencil, "line", (0, 0), (1, 0))
    assert draw(pencil, "circle", (5, 5)).startswith("Close the outline first")
    assert draw(pencil, "arc", (1, 0)) == "An arc ends at another point than it begins."
    pencil.sketch.clear()
    draw(pencil, "rectangle", (0, 0))
    assert pencil.click((0, 3)) == "Nothing is drawn between two equal points."
    assert pencil.begun and pencil.cancel() and not pencil.begun
    draw(pencil, "rectangle", (0, 0), (1, 1))
    assert "press Add hole" in draw(pencil, "line", (5, 5))


@pytest.mark.parametrize(
    ("tool", "before", "typed", "mouse", "expected"),
    [
        ("line", [], "1,5 2", None, (1.5, 2.0)),
        ("line", [(1, 1)], "2", (1, 4), (1.0, 3.0)),
        ("line", [(1, 1)], "2<30", None, (1 + math.sqrt(3), 2.0)),
        ("line", [(1, 1)], "\u22120.5; 2", None, (0.5, 3.0)),
        ("rectangle", [(1, 1)], "3x2", (0, 5), (-2.0, 3.0)),
        ("circle", [(1, 1)], "0.25", None, (1.25, 1.0)),
        ("circle", [], "3 4", None, (3.0, 4.0)),
    ],
)
def test_typed_dimensions_give_a_place(pencil, tool, before, typed, mouse, expected):
    draw(pencil, tool, *before)
    assert pencil.place_of(typed, mouse) == pytest.approx(expected)


def test_typed_radius_of_an_arc(pencil):
    draw(pencil, "line", (0, 0))
    draw(pencil, "arc", (2, 0))
    place = pencil.place_of("1.25", (1, -0.2))
    assert pencil.click(place) == ""
    loop = pencil.sketch.loops[0]
    (x, y), radius = arc_edges.circle_of(*loop.ends(0), loop.bulge(0))
    assert (x, y, radius) == pytest.approx((1.0, 0.75, 1.25))
    assert 0 < loop.bulge(0) < 1


@pytest.mark.parametrize(
    ("tool", "before", "typed", "words"),
    [
        ("line", [(0, 0)], "2", "Move the mouse"),
        ("line", [], "2", "is no point"),
        ("line", [(0, 0)], "2 3 4", "cannot be read"),
        ("circle", [(0, 0)], "-1", "is no radius"),
        ("arc", [(0, 0), (4, 0)], "1", "less than half of the chord"),
        ("measure", [(0, 0)], "1", "takes no dimensions"),
        ("rectangle", [(0, 0)], "5", "width height"),
    ],
)
def test_typed_dimensions_that_mean_nothing_are_refused(pencil, tool, before, typed, words):
    draw(pencil, tool, *before)
    with pytest.raises(MeshError, match=words):
        pencil.place_of(typed, None)


def test_measuring_shows_distance_and_direction(pencil):
    draw(pencil, "measure", (0, 0), (3, 4))
    assert pencil.draft((9, 9)).text == "5 < 53.13\u00b0   \u0394x 3, \u0394y 4"
    assert pencil.sketch.empty
    assert polar((0, 0), (-1, 0)) == "1 < 180\u00b0"
    assert span((0, 0), (-1, 0)).endswith("\u0394x \u22121, \u0394y 0")
    pencil.click((1, 1))
    assert pencil.places == ((1, 1),)


def test_edits_keep_arcs(pencil):
    draw(pencil, "circle", (0, 0), (1, 0))
    sketch = pencil.sketch
    area = domain(pencil).area
    sketch.insert(0, 1, (0.0, -1.0))
    assert len(sketch.loops[0].corners) == 3
    assert domain(pencil).area == pytest.approx(area, rel=1e-9)
    sketch.remove(0, 1)
    assert domain(pencil).area == pytest.approx(area, rel=1e-9)
    sketch.scale_circle(0, 2.0)
    assert domain(pencil).area == pytest.approx(4 * area, rel=1e-9)
    sketch.remove(0, 1)
    assert sketch.open and len(sketch.loops[0].corners) == 1


def test_problems_of_arcs_are_found(pencil):
    draw(pencil, "rectangle", (0, 0), (4, 4))
    draw(pencil, "circle", (3.5, 2), (3.5, 2.8))
    assert "crosses or touches the outline" in pencil.sketch.words
    assert set(pencil.sketch.problem.edges) <= {(0, 1), (1, 0), (1, 1)}
    pencil.sketch.undo()
    draw(pencil, "circle", (6, 2), (6, 2.5))
    assert "outside the outline" in pencil.sketch.words


def test_a_sketch_is_kept_as_json(pencil):
    draw(pencil, "rectangle", (0, 0), (4, 4))
    draw(pencil, "circle", (2, 2), (2, 3))
    other = Sketch()
    other.put_json(pencil.sketch.to_json())
    assert other.loops == pencil.sketch.loops
    with pytest.raises(ValueError, match="no drawing"):
        other.put_json([{"corners": 3}])
    assert other.loops == pencil.sketch.loops
