"""GeoJSON, WKT with curves, Triangle's .poly, airfoils, and our own JSON with curves."""

import json
import math

import numpy as np
import pytest

from meshwright_core import MeshError
from meshwright_core.io import drawings


def square(x: float, y: float, size: float) -> list[list[float]]:
    return [[x, y], [x + size, y], [x + size, y + size], [x, y + size], [x, y]]


def feature(geometry, **properties) -> dict:
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def polygon(*rings) -> dict:
    return {"type": "Polygon", "coordinates": list(rings)}


def collection(*features) -> str:
    return json.dumps({"type": "FeatureCollection", "features": list(features)})


def test_features_without_a_place_are_left_out(found):
    text = collection(feature(polygon(square(0, 0, 4))), feature(None))
    report = found("a.geojson", text)
    assert [region.area for region in report.regions] == [16]
    assert report.ignored == ["1 feature without geometry left out"]


def test_features_are_named_regions_that_share_borders(found, tmp_path):
    text = collection(
        feature(polygon(square(0, 0, 4)), name="Steel"),
        # a border that is drawn in two parts
        feature(polygon([[4, 0], [9, 0], [9, 4], [4, 4], [4, 2], [4, 0]]), Material="copper"),
        feature(polygon(square(0, 4, 2)), name="steel"),
    )
    report = found("a.geojson", text)
    assert [(r.name, round(r.area, 9), r.touches) for r in report.regions] == [
        ("copper", 20, (1,)),
        ("Steel 1", 16, (0, 2)),
        ("steel 2", 4, (1,)),
    ]
    domain = drawings.read_domain(tmp_path / "a.geojson")
    assert [region.name for region in domain.regions] == ["copper", "Steel 1", "steel 2"]
    assert len(domain.interfaces) == 2
    assert domain.area == pytest.approx(40)


def test_a_polygon_in_the_hole_of_another_is_an_insert(found):
    text = collection(
        feature(polygon(square(0, 0, 9), square(3, 3, 3)), name="plate"),
        feature(polygon(square(3, 3, 3)), name="insert"),
    )
    report = found("a.geojson", text)
    assert [(r.name, r.area, r.holes) for r in report.regions] == [
        ("plate", 72, 0),
        ("insert", 9, 0),
    ]


@pytest.mark.parametrize(
    ("text", "areas"),
    [
        ("CURVEPOLYGON(COMPOUNDCURVE(CIRCULARSTRING(0 0, 2 2, 4 0), (4 0, 0 0)))", [2 * math.pi]),
        ("MULTISURFACE(((0 0, 4 0, 4 4, 0 4, 0 0)))", [16]),
        ("CURVEPOLYGON(CIRCULARSTRING(1 0, -1 0, 1 0))", [math.pi]),
        ("CURVEPOLYGON(CIRCULARSTRING(2 0, 0 2, -2 0, 0 -2, 2 0), (1 0, 0 1, -1 0, 1 0))",
         [4 * math.pi - 1]),
        ("POLYGON Z ((0 0 1, 4 0 1, 4 4 1, 0 4 1, 0 0 1))", [16]),
        ("POLYGONZM((0 0 1 2, 4 0 1 2, 4 4 1 2, 0 4 1 2, 0 0 1 2))", [16]),
        ("SRID=4326;MULTIPOLYGON M (((0 0 1, 4 0 1, 4 4 1, 0 0 1)), EMPTY)", [8]),
        ("GEOMETRYCOLLECTION(POINT(1 1), POLYGON EMPTY, POLYGON((0 0, 4 0, 4 4, 0 0)))", [8]),
        ("MULTICURVE((0 0, 4 0), CIRCULARSTRING EMPTY, CIRCULARSTRING(4 0, 2 2, 0 0))",
         [2 * math.pi]),
        ("MULTISURFACE(CURVEPOLYGON((0 0, 1 0, 1 1, 0 0)), ((5 5, 7 5, 7 7, 5 5)))", [2, 0.5]),
        ("polygon((0 0,4 0,4 4,0 4,0 0));\nPolygon((9 0,10 0,10 1,9 0))\n", [16, 0.5]),
        ("TIN(((0 0, 4 0, 4 4, 0 0)))", [8]),
    ],
)  # fmt: skip
def test_well_known_text(found, text, areas):
    report = found("a.wkt", text)
    assert [region.area for region in report.regions] == pytest.approx(areas, rel=1e-14)


def test_arcs_of_well_known_text_stay_arcs(found):
    text = "CURVEPOLYGON(COMPOUNDCURVE(CIRCULARSTRING(0 0, 2 2, 4 0), (4 0, 0 0)))"
    (region,) = found("a.wkt", text).regions
    assert sorted(side.curve.kind for side in region.loops[0]) == ["arc", "line"]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("POLYGON((0 0, 4 0, 4 4, 0 4))", "not closed"),
        ("POLYGON((0 0, 4 0, 4 4, 0 0)", "its end"),
        ("POLYGON((0 0, 4 zero, 4 4, 0 0))", "'zero'"),
        ("POLYGON((0 0, 4, 4 4, 0 0))", "a coordinate"),
        ("CIRCULARSTRING(0 0, 1 1)", "2 points"),
        ("HEPTAGON((0 0, 1 1))", "'HEPTAGON'"),
        ("POLYGON((0 0, 4 0, 4 4, 0 0)) extra", "'extra'"),
        ("(" * 5000, "the name of a geometry"),
        ("GEOMETRYCOLLECTION(" * 5000, "nested too deep"),
        ("CURVEPOLYGON(" + "COMPOUNDCURVE(" * 5000, "nested too deep"),
        ("POINT(" * 5000, "its end"),
    ],
)
def test_bad_well_known_text(sentence, text, reason):
    assert reason in sentence("a.wkt", text)


PLATE = """# a plate with a hole, in two parts
8 2 0 0
{base0} 0 0
{base1} 6 0
{base2} 6 3   # a comment
{base3} 0 3
{base4} 1 1
{base5} 2 1
{base6} 2 2
{base7} 1 2
9 1
{base0} {base0} {base1} 1
{base1} {base1} {base2} 7
{base2} {base2} {base3} 1
{base3} {base3} {base0} 1
{base4} {base4} {base5} 0
{base5} {base5} {base6} 0
{base6} {base6} {base7} 0
{base7} {base7} {base4} 0
8 {base3} {base4} 0
1
{base0} 1.5 1.5
1
{base0} 5 1 10 0.1
"""


@pytest.mark.parametrize("base", [0, 1])
def test_triangle_files(found, base):
    text = PLATE.format(**{f"base{i}": i + base for i in range(8)})
    report = found("a.poly", text)
    assert [(r.name, r.area, r.holes) for r in report.regions] == [("attribute 10", 17, 1)]
    (region,) = report.regions
    assert {side.name for side in region.loops[0]} == {"", "marker 7"}
    # the segment from the rim to the hole divides nothing
    assert report.ignored == ["1 line or curve that encloses nothing left out, the first at (0, 3)"]


def test_triangle_keeps_what_is_not_a_hole(found):
    text = "7 2\n1 0 0\n2 9 0\n3 9 9\n4 3 3\n5 5 3\n6 5 4\n7 0 9\n7\n1 1 2\n2 2 3\n3 3 7\n4 7 1\n"
    text += "5 4 5\n6 5 6\n7 6 4\n0\n"
    areas = [region.area for region in found("a.poly", text).regions]
    assert areas == [80, 1]


def test_vertices_in_a_node_file(found, tmp_path):
    (tmp_path / "a.node").write_text("3 2 1 0\n1 0 0 9.5\n2 4 0 9.5\n3 0 4 9.5\n")
    text = "0 2 1 0\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n"
    assert found("a.poly", text).regions[0].area == 8


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("3 3 0\n", "3 dimensions"),
        ("2 2\n1 0 0\n", "cut off: vertex 2 of 2"),
        ("1 2\n1 0 zero\n", "line 2: 'zero'"),
        ("1 2\n1 0 0\n1\n1 1 2\n0\n", "line 4: there is no vertex 2"),
        ("99999999999 2\n", "no number of things"),
        ("0 2\n1\n", "a.node beside it"),
    ],
)
def test_bad_triangle_files(sentence, text, reason):
    assert reason in sentence("a.poly", text)


def naca(count: int, blunt: bool) -> tuple[np.ndarray, np.ndarray]:
    """Upper and lower side of a NACA 0012 from the leading edge."""
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, count)))
    last = -0.1015 if blunt else -0.1036
    y = 0.6 * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 + last * x**4)
    return np.column_stack([x, y]), np.column_stack([x, -y])


def rows(points: np.ndarray) -> str:
    return "".join(f" {x:.6f}  {y:.6f}\n" for x, y in points)


@pytest.mark.parametrize(("blunt", "corners"), [(False, 1), (True, 2)])
def test_airfoils_in_both_orders(found, blunt, corners):
    over, under = naca(60, blunt)
    selig = "NACA 0012\n" + rows(np.vstack([over[::-1], under[1:]]))
    lednicer = f"NACA 0012\n 60.  60.\n\n{rows(over)}\n{rows(under)}"
    exact = 2 * np.trapezoid(over[:, 1], over[:, 0])
    for text in (selig, lednicer):
        (region,) = found("a.dat", text).regions
        assert region.area == pytest.approx(exact, rel=2e-3)
        assert region.corners == corners
        kinds = [side.curve.kind for side in region.loops[0]]
        assert sorted(kinds) == (["line", "spline"] if blunt else ["spline"])


def test_tecplot_files_are_not_airfoils(tmp_path):
    path = tmp_path / "a.dat"
    path.write_text('VARIABLES = "X", "Y"\nZONE N=3, E=1, F=FEPOINT\n0 0\n1 0\n0 1\n')
    assert not drawings.is_geometry(path)
    path.write_text("NACA\n1 0\n0 0.1\n0 -0.1\n1 0\n")
    assert drawings.is_geometry(path)
    assert not drawings.is_geometry(tmp_path / "none.dat")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("name\n1 0\n0 1\nx y\n", "line 4: 'x y'"),
        ("name\n1 0\n0 1\n", "2 points"),
        ("name\n 3. 4.\n0 0\n1 0\n0 1\n1 1\n", "states 3 and 4 points, but has 4"),
    ],
)
def test_bad_airfoils(sentence, text, reason):
    assert reason in sentence("a.dat", text)


def test_our_own_json_with_curves_and_regions(found, tmp_path):
    arc = {"arc": {"centre": [0, 0], "radius": 2, "start": 0, "sweep": 180}, "name": "round"}
    half = {"name": "upper", "outline": [arc, {"line": [[-2, 0], [2, 0]]}]}
    below = {"name": "lower", "outline": [[-2, 0], [-2, -1], [2, -1], [2, 0]]}
    report = found("a.json", json.dumps({"regions": [half, below]}))
    assert [(r.name, r.touches) for r in report.regions] == [("upper", (1,)), ("lower", (0,))]
    assert report.regions[0].area == pytest.approx(2 * math.pi)
    assert {side.name for side in report.regions[0].loops[0]} == {"round", ""}
    domain = drawings.read_domain(tmp_path / "a.json", region="lower")
    assert domain.area == 4


def test_bad_json_of_ours(sentence):
    assert "line" in sentence("a.json", json.dumps({"outline": [{"line": [[0, 0]]}]}))
    assert "outline" in sentence("a.json", "[1]")


def test_names_of_fits(tmp_path):
    with pytest.raises(MeshError, match="arcs or splines"):
        drawings.read_domain(tmp_path / "a.dxf", fit="waves")
