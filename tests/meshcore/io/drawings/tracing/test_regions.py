"""Tracing: ends, doubles, overlaps, crossings and gaps; regions, their nesting and their names."""

import math

import numpy as np
import pytest

from meshwright_core import MeshError
from meshwright_core.curves.curve import Curve
from meshwright_core.io.drawings.domains import domain_of
from meshwright_core.io.drawings.drawn import Drawing
from meshwright_core.io.drawings.tracing.regions import traced

TURN = 2 * math.pi


def line(*points) -> Curve:
    return Curve.polyline(points)


def circle(x: float, y: float, radius: float, start: float = 0.0) -> Curve:
    return Curve.arc((x, y), radius, start, TURN)


def box(x: float, y: float, w: float, h: float) -> Curve:
    return line((x, y), (x + w, y), (x + w, y + h), (x, y + h), (x, y))


def drawing(*curves: Curve, **layers: Curve) -> Drawing:
    made = Drawing()
    for curve in curves:
        made.add(curve)
    for layer, curve in layers.items():
        made.add(curve, layer.rstrip("_"), layer.rstrip("_"))
    return made


def areas(report) -> list[float]:
    return [region.area for region in report.regions]


def test_islands_in_holes_are_regions():
    report = traced(drawing(box(0, 0, 20, 20), circle(10, 10, 8), circle(10, 10, 3)))
    assert [(r.area, r.holes) for r in report.regions] == [
        (pytest.approx(400 - 64 * math.pi), 1),
        (pytest.approx(9 * math.pi), 0),
    ]
    with pytest.raises(MeshError, match=r"2 separate outlines.*--region"):
        report.chosen()
    assert len(report.chosen("all")) == 2
    assert report.chosen("2") == [report.regions[1]]


def test_a_loop_on_two_layers_separates_two_regions():
    made = drawing(plate=box(0, 0, 9, 9), plate_=circle(4, 4, 2), insert=circle(4, 4, 2, 1.0))
    report = traced(made)
    assert [(r.name, r.holes, r.touches) for r in report.regions] == [
        ("plate", 0, (1,)),
        ("insert", 0, (0,)),
    ]
    assert report.repairs == []
    domain = domain_of(report.chosen(), "both", 0.01)
    assert [region.name for region in domain.regions] == ["plate", "insert"]
    assert domain.area == pytest.approx(81)
    same = traced(drawing(box(0, 0, 9, 9), circle(4, 4, 2), circle(4, 4, 2, 1.0)))
    assert [r.holes for r in same.regions] == [1]
    assert "drawn more than once" in same.repairs[0]


def test_a_motor_segment_of_three_regions():
    rays = [line((math.cos(a), math.sin(a)), (4 * math.cos(a), 4 * math.sin(a))) for a in (0, 1)]
    arcs = [Curve.arc((0, 0), r, 0, 1) for r in (1, 2, 2.5, 4)]
    report = traced(drawing(*arcs, *rays))
    assert areas(report) == pytest.approx([0.5 * (16 - 6.25), 1.5, 0.5 * (6.25 - 4)])
    assert [r.touches for r in report.regions] == [(2,), (2,), (0, 1)]
    domain = domain_of(report.chosen(), "segment", 0.01)
    assert domain.area == pytest.approx(7.5)
    assert len(domain.interfaces) == 2


def test_a_line_that_ends_on_others_divides():
    report = traced(drawing(box(0, 0, 6, 4), line((2, 0), (2, 4)), line((2, 1), (6, 1))))
    assert areas(report) == pytest.approx([12, 8, 4])
    report = traced(drawing(circle(0, 0, 1), line((0, -1), (0, 1))))
    assert areas(report) == pytest.approx([math.pi / 2, math.pi / 2])


def test_arcs_and_their_tangents_are_told_apart_at_a_node():
    made = drawing(
        line((0, 0), (4, 0)), Curve.arc((0, 1), 1, -math.pi / 2, math.pi / 2),
        Curve.arc((0, 2), 2, -math.pi / 2, math.pi / 2), line((1, 1), (1, 3)),
        line((2, 2), (2, 3)), line((1, 3), (2, 3)), line((4, 0), (4, 3)), line((4, 3), (2, 3)),
    )  # fmt: skip
    report = traced(made)
    assert sum(areas(report)) == pytest.approx(4 * 3 - 1 * 3 + (1 - math.pi / 4))
    assert len(report.regions) == 2


@pytest.mark.parametrize("noise", [0.0, 1e-9, 3e-6])
def test_ends_that_all_but_meet_are_joined(noise):
    rng = np.random.default_rng(1)
    corners = np.array([(0, 0), (4, 0), (4, 2), (0, 2)], float)
    curves = [
        line(a + noise * rng.standard_normal(2), b + noise * rng.standard_normal(2))
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    report = traced(drawing(*curves))
    assert areas(report) == pytest.approx([8], abs=1e-4)
    assert bool(report.repairs) == (noise > 1e-7)


def test_gaps_are_closed_at_the_corner_and_told():
    made = drawing(line((0.003, 0), (4, 0)), line((4, 0), (4, 4), (0, 4)), line((0, 4), (0, 0.002)))
    report = traced(made)
    assert areas(report) == [16]
    assert report.repairs == ["a gap of 0.00361 closed at (0.0015, 0.001)"]
    with pytest.raises(MeshError, match=r"open: a line ends at \(.*\).*is 0.00360555 away"):
        traced(made, gap=0.0)


def test_wide_gaps_are_closed_where_that_is_asked_for():
    made = drawing(line((0, 0), (4, 0), (4, 4), (0, 4), (0, 0.2)))
    with pytest.raises(MeshError, match=r"is 0\.2 away"):
        traced(made)
    report = traced(made, gap=0.3)
    assert areas(report) == pytest.approx([16])
    assert report.repairs == ["a gap of 0.2 closed at (0, 0.1)"]


def test_an_arc_that_all_but_closes_is_closed():
    made = drawing(box(0, 0, 9, 9), Curve.arc((4, 4), 2, 0.001, TURN - 0.002))
    report = traced(made)
    assert [r.holes for r in report.regions] == [1]
    assert areas(report) == pytest.approx([81 - 4 * math.pi], rel=1e-12)


def test_ends_drawn_too_far_or_not_far_enough_are_put_on_the_next_curve():
    made = drawing(box(0, 0, 6, 4), line((2, -0.004), (2, 3.998)))
    report = traced(made)
    assert areas(report) == pytest.approx([16, 8])
    assert len(report.repairs) == 2 and all("drawn to the next curve" in r for r in report.repairs)


def test_lines_drawn_too_far_are_cut_where_nothing_is_closed_otherwise():
    made = drawing(
        line((-1, 0), (5, 0)), line((4, -1), (4, 5)), line((5, 4), (-1, 4)), line((0, 5), (0, -1))
    )
    report = traced(made)
    assert areas(report) == pytest.approx([16])
    assert "split where they cross" in report.repairs[0]


def test_overlaps_on_a_line_and_on_a_circle_count_once():
    made = drawing(
        line((0, 0), (3, 0)), line((2, 0), (4, 0)), line((4, 0), (4, 4)), line((4, 4), (0, 4)),
        line((0, 4), (0, 0)), Curve.arc((2, 2), 1, 0, 4), Curve.arc((2, 2), 1, 3, 4),
    )  # fmt: skip
    report = traced(made)
    assert areas(report) == pytest.approx([16 - math.pi])
    assert report.repairs == [
        "3 lines and curves drawn more than once count once, the first at (2, 0)"
    ]


def test_hairs_and_stray_lines_are_left_out():
    made = drawing(
        box(0, 0, 4, 4), line((4, 4), (4.002, 4.003)), line((1, 1), (2, 2)), line((-3, 2), (7, 2)),
        line((2, 2), (2.000001, 2.000001)),
    )  # fmt: skip
    report = traced(made)
    assert areas(report) == [16]
    assert any("loose end of length" in sentence for sentence in report.repairs)
    assert "that enclose nothing left out" in report.ignored[0]


def test_an_open_outline_around_closed_holes_is_not_overlooked():
    made = drawing(line((0, 0), (9, 0), (9, 9), (0, 9), (0, 1)), circle(4, 4, 2))
    report = traced(made)
    assert areas(report) == pytest.approx([4 * math.pi])
    assert "(0, 1)" in report.serious and "is 1 away" in report.serious
    with pytest.raises(MeshError, match="the outline is open"):
        report.chosen()
    assert len(report.chosen("1")) == 1


def test_an_open_hole_is_told():
    made = drawing(box(0, 0, 9, 9), line((3, 3), (6, 3), (6, 6), (3, 6), (3, 3.5)))
    report = traced(made)
    assert areas(report) == [81] and not report.serious
    assert report.open_outlines[0].startswith("an inner outline is open: a line ends at (3, 3")


def test_boundaries_that_cross_are_refused_with_the_place():
    report = traced(drawing(box(0, 0, 4, 4), circle(4, 2, 1)))
    with pytest.raises(MeshError, match=r"crosses another line or curve at \(4, [13]\)"):
        report.chosen("1")
    bow = traced(drawing(line((0, 0), (4, 4), (4, 1), (0, 4), (0, 0))))
    with pytest.raises(MeshError, match="crosses itself"):
        bow.chosen()


def test_smooth_neighbours_do_not_cross():
    made = drawing(
        line((0, 0), (4, 0)), Curve.arc((4, 1), 1, -math.pi / 2, math.pi), line((4, 2), (0, 2)),
        Curve.arc((0, 1), 1, math.pi / 2, math.pi),
    )  # fmt: skip
    (region,) = traced(made).regions
    assert region.crossing == "" and region.corners == 0
    assert region.area == pytest.approx(8 + math.pi)


def test_borders_that_two_polylines_share_for_a_part():
    one = line((0, 0), (4, 0), (4, 1), (4.5, 2), (4, 3), (4, 4), (0, 4), (0, 0))
    two = line((4, 3), (4.5, 2), (4, 1), (9, 1), (9, 3), (4, 3))
    report = traced(drawing(one, two))
    assert areas(report) == pytest.approx([16.5, 9.5])
    assert report.regions[0].touches == (1,)


def test_names_of_layers():
    report = traced(drawing(cut=box(0, 0, 4, 4), cut_=box(9, 0, 2, 2), other=box(20, 0, 1, 1)))
    assert [r.name for r in report.regions] == ["cut 1", "cut 2", "other"]
    assert [r.layer for r in report.regions] == ["cut", "cut", "other"]
    assert [r.name for r in report.chosen("cut 1, other")] == ["cut 1", "other"]
    with pytest.raises(
        MeshError, match=r"no region 'lid'; the drawing has 'cut 1' \(1\), 'cut 2' \(2\)"
    ):
        report.chosen("lid")


def test_layers_can_be_chosen():
    made = drawing(frame=box(-5, -5, 30, 30), part=box(0, 0, 4, 4))
    assert areas(traced(made)) == [900 - 16]
    assert areas(traced(made, layers=["Part"])) == [16]
    with pytest.raises(MeshError, match="nothing on the layer lid, but on frame, part"):
        traced(made, layers=["lid"])


def test_corners_are_counted_by_the_corner_angle():
    ring = [(math.cos(a), math.sin(a)) for a in np.linspace(0, TURN, 21)]
    made = drawing(line(*ring[:-1], ring[0]))
    assert traced(made).regions[0].corners == 20
    assert traced(made, corner_angle=20).regions[0].corners == 0


def test_areas_are_exact_with_curves_of_all_kinds():
    made = drawing(
        Curve.ellipse((0, 0), (3, 0), (0, 2), 0, math.pi),
        Curve.bezier([(-3, 0), (-3, -4), (3, -4), (3, 0)]),
    )
    assert areas(traced(made)) == pytest.approx([3 * math.pi + 14.4], rel=1e-13)


def test_json_of_the_report():
    content = traced(drawing(plate=box(0, 0, 4, 4))).to_json()
    assert content["regions"] == [
        {"name": "plate", "area": 16, "holes": 0, "corners": 4, "layer": "plate", "touches": []}
    ]
    assert content["repairs"] == content["ignored"] == content["open"] == []
