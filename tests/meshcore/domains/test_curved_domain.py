"""Domains between curves: orientation, corners and anchors, regions, JSON, bad loops."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest
from curved_domains import BAR, PLATE, SQUARE, TURN, circle, ring, turned, two_materials

from meshwright_core import MeshError
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain import Domain


def kinds(domain):
    points = domain.sides.graph.points.values()
    return sorted((point.kind, *point.place.tolist()) for point in points)


@pytest.mark.parametrize("way", ["as it is", "turned", "other order"])
def test_plate_with_a_round_hole(way):
    loops = {
        "as it is": PLATE,
        "turned": [turned(loop) for loop in PLATE],
        "other order": PLATE[::-1],
    }[way]
    domain = Domain.from_curves(loops)
    assert domain.area == pytest.approx(1e4 - 400 * math.pi, rel=1e-14)
    assert domain.has_curves
    assert domain.diameter == pytest.approx(100 * math.sqrt(2))
    assert [curve.kind for curve in domain.boundary[0]] == ["line"] * 4
    assert domain.boundary[1][0].data["sweep"] == pytest.approx(-TURN)
    assert len(domain.holes) == 1 and domain.corners.sum() == 4
    assert not domain.hole_corners[0].any()
    assert [domain.optimum(kind) for kind in ("quad", "tri")] == [4, 4]


def test_corners_and_anchors():
    domain = Domain.from_curves([BAR])
    assert kinds(domain) == [
        ("anchor", 60, 0), ("anchor", 60, 40), ("corner", 0, 0), ("corner", 0, 40),
    ]  # fmt: skip
    assert domain.corners.sum() == 2
    assert domain.optimum("quad") == 2


def test_corner_angle_is_larger_beside_curves():
    # the arc ends half a degree off the direction of the lines
    half = math.radians(90.5)
    end = (60 + 20 * math.sin(half), 20 - 20 * math.cos(half))
    curves = [BAR[0], Curve.arc_through((60, 0), end, (60, 40)), *BAR[2:]]
    assert [kind for kind, *_ in kinds(Domain.from_curves([curves]))].count("anchor") == 2
    bent = ring((0, 0), (50, 0.1), (100, 0), (100, 100))
    assert len(kinds(Domain.from_curves([bent]))) == 4
    assert len(kinds(Domain.from_curves([bent], corner_angle=1))) == 3


def test_polyline_that_turns_little_has_no_corners():
    angle = np.linspace(0, math.pi, 31)
    arc = Curve.polyline(np.column_stack([np.cos(angle), np.sin(angle)]))
    loop = [arc, Curve.line((-1, 0), (1, 0))]
    assert len(kinds(Domain.from_curves([loop]))) == 31
    domain = Domain.from_curves([loop], corner_angle=10)
    assert len(kinds(domain)) == 2
    assert domain.has_curves


def test_kink_of_a_spline_is_a_corner():
    spline = Curve.spline(
        [[0, 0], [1, 1], [2, 1], [3, 0], [2, -1], [1, -1], [0, 0]],
        [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2],
        3,
    )
    domain = Domain.from_curves([[spline]])
    assert kinds(domain) == [("corner", 0, 0), ("corner", 3, 0)]


def test_smooth_loop_has_no_geometric_point():
    assert kinds(Domain.from_curves([circle(0, 0, 1)])) == []
    halves = [Curve.arc((0, 0), 1, 0, math.pi), Curve.arc((0, 0), 1, math.pi, math.pi)]
    assert kinds(Domain.from_curves([halves])) == []


def test_small_gaps_are_closed_and_straight_walls_stay_straight():
    gap = 2e-5
    curves = [
        Curve.line((0, 0), (60, 0)),
        Curve.arc((60, 20 + gap), 20, -0.5 * math.pi, math.pi),
        *BAR[2:],
    ]
    domain = Domain.from_curves([curves])
    (loop,) = domain.boundary
    assert all((a.end == b.start).all() for a, b in pairwise([*loop, loop[0]]))
    assert loop[0].start.tolist() == [0, 0] and loop[0].end.tolist() == [60, 0]
    assert loop[2].start.tolist() == [60, 40]
    assert loop[1].kind == "arc"


def test_several_outlines():
    domain = Domain.from_curves([*PLATE, circle(50, 50, 10), circle(200, 0, 5)])
    assert domain.outlines == 3 and len(domain.holes) == 1
    assert domain.area == pytest.approx(1e4 - 400 * math.pi + 125 * math.pi)
    # three discs' worth of Euler characteristic less one hole
    assert domain.optimum("quad") == abs(4 - 4 * 2)
    assert domain.polygon.area == pytest.approx(domain.area, rel=1e-2)


def test_two_materials_share_a_side():
    domain = Domain.from_regions(two_materials())
    (interface,) = domain.interfaces
    assert not interface.closed and (interface.left, interface.right) == (0, 1)
    assert [region.name for region in domain.regions] == ["steel", "copper"]
    assert [region.area for region in domain.regions] == [2000, 2000]
    assert [region.corners for region in domain.regions] == [4, 4]
    assert len(domain.boundary) == 1
    # at the ends of the interface two right angles meet: the degree of a straight side for quads
    assert domain.optimum("quad") == 0
    assert domain.optimum("tri") == abs(4 * 1 + 2 * (4 - 5) - 6)


def test_insert_of_another_material():
    plate = ("plate", PLATE)
    insert = ("insert", [circle(50, 50, 20, 1.0, -TURN)])
    domain = Domain.from_regions([plate, insert])
    (interface,) = domain.interfaces
    assert interface.closed
    assert domain.area == pytest.approx(1e4)
    assert domain.regions[1].area == pytest.approx(400 * math.pi)
    assert [region.holes for region in domain.regions] == [1, 0]
    # the circle of the insert begins elsewhere, so that both are cut; the joints are smooth
    assert len(kinds(domain)) == 4
    # 4 in the disc and 4 around it: at a smooth interface they do not cancel (docs/lower_bound.md)
    assert domain.optimum("quad") == 8


def test_regions_that_share_part_of_a_side():
    tall = ring((0, 0), (50, 0), (50, 100), (0, 100))
    low = ring((50, 20), (80, 20), (80, 60), (50, 60))
    domain = Domain.from_regions([("a", [tall]), ("b", [low])])
    (interface,) = domain.interfaces
    assert sorted(curve.length for curve in interface.curves) == [40]
    junctions = [point for point in domain.sides.graph.points.values() if point.kind == "junction"]
    assert len(junctions) == 2
    for point in junctions:
        assert sorted(angle for _, angle in point.sectors) == pytest.approx([90, 180])
    # six outer corners and two junctions of three quads
    assert domain.optimum("quad") == abs(6 * (3 - 2) + 2 * (3 - 4) - 4)


def test_three_regions_around_an_interior_junction():
    hexagon = [(math.cos(a), math.sin(a)) for a in np.radians(60 * np.arange(6))]
    regions = [
        (str(i), [ring((0, 0), *(hexagon[(2 * i + j) % 6] for j in range(3)))]) for i in range(3)
    ]
    domain = Domain.from_regions(regions)
    assert len(domain.interfaces) == 3
    inner = [p for p in domain.sides.graph.points.values() if not p.boundary]
    assert len(inner) == 1
    assert [angle for _, angle in inner[0].sectors] == pytest.approx([120] * 3)
    # quads: one for each sector of 120 degrees inside; 1 + 1 at the ends of interfaces
    assert domain.optimum("quad") == abs((4 - 3) + 3 * (3 - 3) + 3 * (3 - 2) - 4)


@pytest.mark.parametrize(
    "domain",
    [
        Domain.from_curves(PLATE, name="plate", names=[["a", "", "b", "c"], ["hole"]]),
        Domain.from_curves([BAR], corner_angle=5),
        Domain.from_curves([SQUARE, circle(200, 0, 5)]),
        Domain.from_regions(two_materials()),
    ],
)
def test_json_round_trip(domain):
    content = json.loads(json.dumps(domain.to_json()))
    again = Domain.from_json(content)
    assert again.to_json() == domain.to_json()
    assert again.area == domain.area
    assert kinds(again) == kinds(domain)
    assert [region.name for region in again.regions] == [r.name for r in domain.regions]


def test_json_of_points_and_pieces():
    content = {
        "outline": [[0, 0], [100, 0], [100, 100], [0, 100]],
        "holes": [[{"arc": {"centre": [50, 50], "radius": 20, "sweep": 360}, "name": "bore"}]],
    }
    domain = Domain.from_json(content)
    assert domain.area == pytest.approx(1e4 - 400 * math.pi)
    assert domain.sides.loop_sides[1].pieces[0].name == "bore"


def refusal(function, *arguments):
    with pytest.raises(MeshError) as error:
        function(*arguments)
    message = str(error.value)
    assert "\n" not in message and not message[0].islower() and message.endswith(".")
    return message


@pytest.mark.parametrize(
    ("loops", "expected"),
    [
        ([], ["at least one loop"]),
        ([[]], ["not a list of curves"]),
        ([SQUARE[:3]], ["not closed", "gap of 100", "(0, 100)", "(0, 0)"]),
        ([[Curve.line((0, 0), (1, 0)), Curve.line((1, 0), (0, 0))]], ["no area"]),
        ([SQUARE, circle(80, 50, 20)], ["Loop 1", "touches loop 0", "(100, 50)"]),
        ([SQUARE, circle(80 - 1e-7, 50, 20)], ["Loop 1", "touches loop 0"]),
        ([SQUARE, circle(90, 50, 20)], ["crosses or touches"]),
        # the chords of a coarse circle would not reach the line
        ([SQUARE, circle(80.001, 50, 20, 0.02)], ["crosses or touches"]),
        ([SQUARE, circle(50, 50, 20), circle(50, 50, 20)], ["runs along"]),
        ([[Curve.bezier([(0, 0), (3, 2), (-2, 2), (1, 0)]), Curve.line((1, 0), (0, 0))]],
         ["itself"]),
        ([ring((0, 0), (2, 2), (2, 0), (0, 3))], ["itself", "(1.2, 1.2)"]),
        ([ring((0, 0), (1, 0), (1, 1), (0, 1)), ring((1, 1), (2, 1), (2, 2), (1, 2))],
         ["touch only in the point (1, 1)"]),
    ],
)  # fmt: skip
def test_bad_loops(loops, expected):
    message = refusal(Domain.from_curves, loops)
    assert all(part in message for part in expected), message


def test_near_loops_that_do_not_touch_are_fine():
    for gap in (1e-3, 1e-4, 1e-5):
        Domain.from_curves([SQUARE, circle(80 - gap, 50, 20, 0.01)])


@pytest.mark.parametrize(
    ("regions", "expected"),
    [
        ([("a", [SQUARE]), ("b", [circle(50, 50, 20)])], ["overlap", "a lies in b near (50, 50)"]),
        ([("a", [SQUARE]), ("b", [SQUARE])], ["overlap", "same side"]),
        ([("a", [SQUARE]), ("b", [ring((50, 0), (150, 0), (150, 50), (50, 50))])],
         ["overlap", "same side", "near (75, 0)"]),
        ([("a", [SQUARE]), ("b", [ring((50, 50), (150, 50), (150, 60), (50, 60))])],
         ["crosses or touches"]),
        ([("a", [SQUARE]), ("b", [ring((100, 100), (150, 100), (150, 150))])],
         ["touch only in the point (100, 100)"]),
    ],
)  # fmt: skip
def test_bad_regions(regions, expected):
    message = refusal(Domain.from_regions, regions)
    assert all(part in message for part in expected), message


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ({"outline": [{"line": [[0, 0]]}]}, ["Piece 0 of the outline"]),
        ({"outline": [{"arc": {"centre": [0, 0], "radius": -1, "sweep": 360}}]}, ["radius"]),
        ({"outline": [{"arc": {"centre": [0, 0], "radius": 1, "sweep": 360}, "name": 3}]},
         ["name", "piece 0"]),
        ({"outline": [{"arc": {"centre": [0, 0], "radius": 1, "sweep": 360}}],
          "holes": [[{"arc": {"centre": [3, 0], "radius": 1, "sweep": 360}}]]},
         ["Hole 0", "outside the outline"]),
        ({"outline": [{"arc": {"centre": [0, 0], "radius": 1, "sweep": 360}}],
          "holes": [[{"arc": {"centre": [0, 0], "radius": 2, "sweep": 360}}]]},
         ["The outline lies inside"]),
        ({"regions": 3}, ["regions"]),
        ({"regions": [{"name": "a"}]}, ["Region 0", "outline"]),
        ({"outlines": []}, ["outlines"]),
        ({"outline": [[0, 0], [1, 0], [0, 1]], "corner_angle": "x",
          "holes": [[{"line": [[0, 0], [1, 0]]}]]}, ["corner_angle"]),
    ],
)  # fmt: skip
def test_bad_json(content, expected):
    message = refusal(Domain.from_json, content)
    assert all(part in message for part in expected), message


def test_a_thousand_holes_are_checked_quickly():
    loops = [ring((0, 0), (400, 0), (400, 250), (0, 250))]
    loops += [circle(10 * i + 5, 10 * j + 5, 3) for i in range(40) for j in range(25)]
    domain = Domain.from_curves(loops)
    assert len(domain.holes) == 1000
