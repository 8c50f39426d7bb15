"""Geometry files: what each kind may hold becomes a domain; what is bad becomes one sentence."""

import json
import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from meshwright_core import MeshError
from meshwright_core.domains import meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.io import drawings, file_checks


def dxf(*entities: str, sections: str = "") -> str:
    """A DXF file of entities given as ``TYPE code value code value ...``."""
    body = []
    for entity in entities:
        first, *rest = entity.split()
        body += ["0", first, *rest]
    return "\n".join([*sections.split(), "0 SECTION 2 ENTITIES".replace(" ", "\n"), *body]) + (
        "\n0\nENDSEC\n0\nEOF\n"
    )


def line(a: tuple[float, float], b: tuple[float, float], more: str = "") -> str:
    return f"LINE 8 0 10 {a[0]} 20 {a[1]} 11 {b[0]} 21 {b[1]} {more}"


SQUARE = [line((4, 0), (4, 4)), line((0, 0), (4, 0)), line((4, 4), (0, 4)), line((0, 4), (0, 0))]
CIRCLE = "CIRCLE 8 0 10 2 20 2 40 1"


def svg(body: str, head: str = "") -> str:
    return f'<svg xmlns="http://www.w3.org/2000/svg" {head}>{body}</svg>'


SLOT = "M 0 0 H 6 A 2 2 0 0 1 6 4 H 0 Z"
POLYGON = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
HOLE = [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]
GEO = {"type": "Polygon", "coordinates": [POLYGON, HOLE]}
WKT = "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 1 2, 2 2, 2 1, 1 1))"
PLATE = dxf(*SQUARE, CIRCLE)


@pytest.fixture
def opened(tmp_path):
    """Write a file and read the domain in it."""

    def read(name: str, content: str | bytes, **options: float) -> Domain:
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return drawings.read_domain(path, **options)

    return read


@pytest.fixture
def refused(opened):
    """Read a file that is bad; return the sentence."""

    def read(name: str, content: str | bytes) -> str:
        with pytest.raises(MeshError) as error:
            opened(name, content)
        message = str(error.value)
        assert name in message and "\n" not in message and message.endswith(".")
        assert ".." not in message.rpartition("/")[2].replace("...", "")
        return message

    return read


def corners(domain: Domain) -> list[int]:
    return [int(flags.sum()) for flags in domain.loop_corners]


def test_dxf_lines_in_any_order_and_a_circle(opened):
    domain = opened("plate.dxf", PLATE)
    assert domain.name == "plate"
    assert corners(domain) == [4, 0]
    assert [len(loop) for loop in domain.boundary] == [4, 1]
    assert domain.area == pytest.approx(16 - math.pi, rel=1e-14)


def test_dxf_arcs_touch_lines_smoothly_or_at_a_corner(opened):
    rounded = dxf(
        line((0, 0), (4, 0)), line((4, 2), (0, 2)), line((0, 2), (0, 0)),
        "ARC 8 0 10 4 20 1 40 1 50 270 51 90",
    )  # fmt: skip
    assert corners(opened("a.dxf", rounded)) == [2]
    half = dxf(line((-1, 0), (1, 0)), "ARC 8 0 10 0 20 0 40 1 50 0 51 180")
    assert corners(opened("a.dxf", half)) == [2]


def test_dxf_polylines_with_bulges(opened):
    light = "LWPOLYLINE 8 0 90 4 70 1 10 0 20 0 10 4 20 0 42 1 10 4 20 2 10 0 20 2"
    heavy = [
        "POLYLINE 8 0 66 1 70 1", "VERTEX 8 0 10 0 20 0", "VERTEX 8 0 10 4 20 0 42 1",
        "VERTEX 8 0 10 4 20 2", "VERTEX 8 0 10 0 20 2", "SEQEND",
    ]  # fmt: skip
    one, other = opened("a.dxf", dxf(light)), opened("b.dxf", dxf(*heavy))
    for domain in (one, other):
        assert domain.outline[:, 0].max() == pytest.approx(5, abs=1e-3)
        assert corners(domain) == [2]
    assert one.area == pytest.approx(other.area) == pytest.approx(8 + math.pi / 2, rel=1e-14)


def test_dxf_ellipses_and_splines(opened):
    ellipse = "ELLIPSE 8 0 10 1 20 2 11 3 21 0 40 0.5 41 0 42 6.283185307179586"
    domain = opened("a.dxf", dxf(ellipse))
    assert domain.area == pytest.approx(4.5 * math.pi, rel=1e-14)
    assert corners(domain) == [0]
    arc = "SPLINE 8 0 70 8 71 2 40 0 40 0 40 0 40 1 40 1 40 1 10 1 20 0 10 1 20 1 10 0 20 1"
    weights = f" 41 1 41 {math.sqrt(0.5)} 41 1"
    quarter = opened("a.dxf", dxf(arc + weights, line((0, 1), (0, 0)), line((0, 0), (1, 0))))
    assert corners(quarter) == [3]
    assert quarter.area == pytest.approx(math.pi / 4, rel=1e-14)
    fitted = "SPLINE 8 0 70 8 71 3 11 1 21 0 11 0 21 1 11 -1 21 0 11 0 21 -1 11 1 21 0"
    assert opened("a.dxf", dxf(fitted)).area == pytest.approx(math.pi, rel=0.05)


def test_dxf_blocks_are_put_in_place(opened):
    blocks = (
        "0 SECTION 2 BLOCKS 0 BLOCK 2 Bolt 10 1 20 0 0 CIRCLE 10 1 20 0 40 0.5 0 ENDBLK 0 ENDSEC"
    )
    insert = "INSERT 8 0 2 bolt 10 1 20 1 70 2 44 2 41 1 42 0.5 50 90"
    domain = opened("a.dxf", dxf(*SQUARE, insert, sections=blocks))
    assert len(domain.holes) == 2
    spans = sorted(tuple(np.ptp(hole, axis=0).round(2)) for hole in domain.holes)
    assert spans == [(0.5, 1.0), (0.5, 1.0)]
    assert sorted(hole.mean(axis=0).round(2).tolist() for hole in domain.holes) == [[1, 1], [1, 3]]
    assert domain.area == pytest.approx(16 - 2 * math.pi / 8, rel=1e-14)


def test_dxf_leaves_out_what_the_drawing_hides_and_what_is_no_curve(opened):
    layers = "0 SECTION 2 TABLES 0 LAYER 2 Off 70 0 62 -7 0 ENDSEC"
    stray = line((9, 9), (10, 10)).replace("8 0 ", "8 OFF ")
    paper = line((9, 9), (10, 10), "67 1")
    words = "TEXT 8 0 10 0 20 0 40 1 1 Hello"
    assert corners(opened("a.dxf", dxf(*SQUARE, stray, paper, words, sections=layers))) == [4]


def test_dxf_drawn_face_down_is_mirrored(opened):
    flipped = "LWPOLYLINE 8 0 90 3 70 1 210 0 220 0 230 -1 10 0 20 0 10 4 20 0 10 4 20 2"
    assert opened("a.dxf", dxf(flipped)).outline[:, 0].min() == -4


def test_gaps_as_small_as_rounding_are_closed_and_lines_drawn_twice_count_once(opened):
    gap = [*SQUARE[:3], line((0, 4), (1e-5, -1e-5)), line((4, 0), (0, 0))]
    domain = opened("a.dxf", dxf(*gap))
    assert len(domain.outline) == 4
    assert corners(domain) == [4]


def test_svg_turns_the_y_axis_up_and_keeps_arcs_round(opened):
    domain = opened("slot.svg", svg(f'<path d="{SLOT}"/><circle cx="6" cy="2" r="1"/>'))
    assert domain.outline[:, 1].max() == pytest.approx(0)
    assert domain.outline[:, 1].min() == pytest.approx(-4)
    assert corners(domain) == [2, 0]
    assert domain.outline[:, 0].max() == pytest.approx(8, abs=0.05)


@pytest.mark.parametrize(
    ("body", "area", "marked"),
    [
        ('<rect x="1" y="1" width="4" height="2"/>', 8, 4),
        ('<rect width="4" height="2" rx="0.5"/>', 8 - 0.25 * (4 - math.pi), 0),
        ('<rect width="4" height="2" rx="2" ry="1"/>', 2 * math.pi, 0),
        ('<ellipse cx="1" cy="1" rx="2" ry="1"/>', 2 * math.pi, 0),
        ('<polygon points="0,0 4,0 4,4"/>', 8, 3),
        ('<polyline points="0 0 4 0 4 4"/>', 8, 3),
        ('<path d="m0 0h4v4h-4z"/>', 16, 4),
        ('<path d="M0,0 4,0 4,4 0,4"/>', 16, 4),
        ('<path d="M0 0C0 2.2 1.8 4 4 4V0z"/>', 12.554, 3),
        ('<path d="M0 0Q2 0 2 2T4 4H0z"/>', 8, 3),
        ('<path d="M0 0c1 0 1 1 2 1s1-1 2-1v-2h-4z"/>', 10, 4),
        ('<path d="M-1 0a1 1 0 11 2 0a1 1 0 01-2 0z"/>', math.pi, 0),
        ('<path d="M-1 0a.5.5 0 1 1 2 0a.5.5 0 0 1-2 0z"/>', math.pi, 0),
        ('<g transform="scale(2) translate(1,1)"><rect width="1" height="1"/></g>', 4, 4),
        ('<rect transform="rotate(30 1 1) skewX(20)" width="2" height="1"/>', 2, 4),
        ('<rect transform="matrix(0 1 -1 0 5 5)" width="2" height="1"/>', 2, 4),
        ('<rect width="10mm" height="1cm"/>', (96 / 2.54) ** 2, 4),
        ('<rect width="50%" height="50%"/>', 50, 4),
        ('<defs><rect id="r" width="2" height="2"/></defs><use href="#r" x="3"/>', 4, 4),
        ('<style>.no{display:none} .yes{fill:red}</style><rect class="no" width="9" height="9"/>'
         '<rect class="yes" width="2" height="2"/>', 4, 4),
        ('<rect width="2" height="2"/><rect x="5" width="9" height="9" fill="none"/>', 4, 4),
        ('<g fill="none" stroke="#000"><path d="M0 0H2V2"/><path d="M0 0V2H2"/></g>', 4, 4),
        ('<g style="fill:none;stroke:black"><line x2="2"/><path d="M0 0V2L2 0"/></g>', 2, 3),
        ('<rect width="2" height="2"/><g display="none"><rect x="9" width="9" height="9"/></g>',
         4, 4),
        ('<rect width="2" height="2"/><clipPath><rect x="9" width="9" height="9"/></clipPath>',
         4, 4),
    ],
)  # fmt: skip
def test_svg_shapes_paths_and_groups(opened, body, area, marked):
    domain = opened("a.svg", svg(body, 'viewBox="0 0 10 20"'))
    assert domain.area == pytest.approx(area, rel=1e-12)
    assert corners(domain) == [marked]


def test_geojson_and_wkt_polygons_with_holes(opened):
    feature = {"type": "Feature", "properties": {}, "geometry": GEO}
    collection = {"type": "FeatureCollection", "features": [feature]}
    for name, content in [
        ("a.geojson", json.dumps(GEO)),
        ("a.geojson", json.dumps(collection)),
        ("a.json", json.dumps(feature)),
        ("a.wkt", WKT),
        ("a.wkt", f"SRID=4326;{WKT}\n"),
        ("a.wkt", WKT.replace("POLYGON", "MULTIPOLYGON (").replace("1))", "1)))")),
        ("a.wkt", "MULTILINESTRING ((4 0, 4 4, 0 4), (0 4, 0 0, 4 0), (1 1, 1 2, 2 2, 2 1, 1 1))"),
    ]:
        domain = opened(name, content)
        assert domain.area == 15
        assert corners(domain) == [4, 4]
        assert domain.name == "a"


def test_json_in_our_own_form(opened):
    own = {"outline": POLYGON, "holes": [HOLE]}
    assert opened("a.json", json.dumps(own)).area == 15
    assert corners(opened("a.json", json.dumps(own), corner_angle=120)) == [0, 0]


def test_corner_angle_and_curve_step(opened):
    angle = 2 * np.pi * np.arange(20) / 20
    ring = np.column_stack([np.cos(angle), np.sin(angle)]).round(6).tolist()
    geo = json.dumps({"type": "Polygon", "coordinates": [[*ring, ring[0]]]})
    assert corners(opened("a.geojson", geo)) == [20]
    assert corners(opened("a.geojson", geo, corner_angle=20)) == [0]
    assert opened("a.dxf", dxf(CIRCLE), curve_step=5.0).curve_step == 5.0
    assert opened("a.dxf", dxf(CIRCLE)).curve_step is None


def test_domains_from_files_can_be_meshed(opened):
    for name, content in [("a.dxf", PLATE), ("a.svg", svg(f'<path d="{SLOT}"/>')), ("a.wkt", WKT)]:
        for kind in ("tri", "quad"):
            mesh = meshing.mesh_domain(opened(name, content), kind)
            mesh.validate()
            assert mesh.n_elements > 10


BAD = {
    "empty.dxf": ("", "empty"),
    "words.dxf": ("This is a letter, not a drawing.\n", "line 1: 'This is a letter,...'"),
    "binary.dxf": (b"AutoCAD Binary DXF\r\n\x1a\x00", "binary DXF"),
    "section.dxf": ("0\nSECTION\n2\nHEADER\n0\nENDSEC\n0\nEOF\n", "no section ENTITIES"),
    "nothing.dxf": (dxf(), "no lines or curves"),
    "solid.dxf": (dxf("3DSOLID 8 0"), "only 3DSOLID"),
    "open.dxf": (dxf(*SQUARE[:3]), "open: a line ends at (0, 4)|open: a line ends at (0, 0)"),
    "branch.dxf": (dxf(*SQUARE[:3], line((0, 0), (2, 2))), "open: a line ends"),
    "two.dxf": (dxf(*SQUARE, CIRCLE.replace("10 2", "10 9")), "2 separate outlines"),
    "cross.dxf": (dxf(*SQUARE, CIRCLE.replace("10 2", "10 4")), "crosses"),
    "number.dxf": (dxf(line((0, 0), (4, "x"))), "in the LINE 'x' is no number (group code 21)"),
    "missing.dxf": (dxf("CIRCLE 8 0 10 1 40 3"), "in the CIRCLE a number is missing"),
    "nan.dxf": (dxf(line((0, 0), (4, "nan"))), "'nan' is no number"),
    "radius.dxf": (dxf(CIRCLE.replace("40 1", "40 -1")), "radius -1"),
    "block.dxf": (dxf("INSERT 8 0 2 Nut 10 0 20 0"), "no block named 'Nut'"),
    "loop.dxf": (
        dxf("INSERT 8 0 2 A 10 0 20 0", sections="0 SECTION 2 BLOCKS 0 BLOCK 2 A 0 INSERT 2 A 10 1 "
            "20 1 0 ENDBLK 0 ENDSEC"),
        "nested more than 8 deep",
    ),
    "bomb.dxf": (dxf("INSERT 8 0 2 A 10 0 20 0 70 30000 71 30000", sections="0 SECTION 2 BLOCKS 0 "
                     "BLOCK 2 A 0 CIRCLE 10 0 20 0 40 1 0 ENDBLK 0 ENDSEC"), "more than 100,000"),
    "tilted.dxf": (dxf(CIRCLE + " 210 1 220 0 230 0"), "does not lie in the plane"),
    "spline.dxf": (dxf("SPLINE 8 0 71 3 40 0 10 1 20 1 10 2 20 2"), "removed SPLINE"),
    "empty.svg": ("", "empty"),
    "words.svg": ("This is a letter.\n", "not XML"),
    "html.svg": ("<html><body/></html>", "not SVG"),
    "nothing.svg": (svg("<text>Hello</text>"), "no shapes or paths"),
    "hidden.svg": (svg('<rect width="3" height="3" fill="none"/>'), "no shapes or paths"),
    "path.svg": (svg('<path d="M 0 0 L 4 four"/>'), "'four' where a number was expected"),
    "first.svg": (svg('<path d="L 4 4"/>'), "begins with 'L'"),
    "flag.svg": (svg('<path d="M0 0A1 1 0 2 0 4 4"/>'), "0 or 1 was expected"),
    "length.svg": (svg('<rect width="3ells" height="3"/>'), "'3ells', which is no length"),
    "points.svg": (svg('<polygon points="0 0 1"/>'), "not pairs of numbers"),
    "turn.svg": (svg('<g transform="spin(3)"><rect/></g>'), "spin(3) is not known"),
    "use.svg": (svg('<use href="#nobody"/>'), "'#nobody', which is not there"),
    "self.svg": (svg('<g id="a"><use href="#a"/></g>'), "nested too deep"),
    "two.svg": (svg('<rect width="3" height="3"/><rect x="5" width="3" height="3"/>'), "separate"),
    "bow.svg": (svg('<path d="M0 0L2 2L2 0L0 2z"/>'), "crosses"),
    "open.svg": (svg('<path fill="none" stroke="red" d="M0 0L2 2L2 0"/>'), "open: a line ends"),
    "empty.geojson": ("", "empty"),
    "words.geojson": ("A letter", "this is not JSON"),
    "list.geojson": ("[1, 2]", "not a GeoJSON"),
    "type.geojson": ('{"type": "Nonsense"}', "not a GeoJSON"),
    "point.geojson": ('{"type": "Polygon", "coordinates": [[[0, 0], [1]]]}', "not sound GeoJSON"),
    "deep.geojson": ("[" * 100_000, "too deep"),
    "two.geojson": (
        json.dumps({"type": "MultiPolygon", "coordinates": [[POLYGON], [[[9, 9], [10, 9], [9, 10],
                                                                         [9, 9]]]]}),
        "2 separate outlines",
    ),
    "empty.wkt": ("", "empty"),
    "words.wkt": ("A letter", "not sound WKT"),
    "point.wkt": ("POINT (1 2)", "no lines or curves"),
    "none.wkt": ("POLYGON EMPTY", "no lines or curves"),
    "bow.wkt": ("POLYGON ((0 0, 1 1, 1 0, 0 1, 0 0))", "crosses"),
    "island.wkt": (
        "MULTIPOLYGON (((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 8 1, 8 8, 1 8, 1 1)), "
        "((3 3, 4 3, 4 4, 3 3)))",
        "2 separate outlines",
    ),
    "flat.wkt": ("POLYGON ((0 0, 1 0, 2 0, 0 0))", ""),
    "bytes.wkt": (b"\xff\xfe\x00\x01", "not a text file"),
    "ending.xyz": ("1 2 3", "ends in one of .dxf .svg .geojson .wkt .json .poly"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_file_is_refused_in_one_sentence(refused, name):
    content, reason = BAD[name]
    message = refused(name, content)
    assert any(part in message for part in reason.split("|")), message


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(MeshError, match="no such file"):
        drawings.read_domain(tmp_path / "missing.dxf")
    (tmp_path / "folder.svg").mkdir()
    with pytest.raises(MeshError, match="a folder"):
        drawings.read_domain(tmp_path / "folder.svg")
    with pytest.raises(MeshError, match="no name for a file"):
        drawings.read_domain("a\0.dxf")


def test_an_error_of_a_reader_does_not_blame_the_name_of_the_file(tmp_path):
    said = r"part\.dxf: it cannot be read \(Numbers are odd\)"
    with pytest.raises(MeshError, match=said), file_checks.naming(tmp_path / "part.dxf"):
        raise ValueError("numbers are odd.")


def test_a_circle_of_no_radius_is_a_point(opened):
    domain = opened("points.dxf", dxf(*SQUARE, "CIRCLE 8 0 10 2 20 2 40 0", CIRCLE))
    assert domain.area == pytest.approx(16 - math.pi)


@pytest.mark.parametrize("second", ["bowed", "straight"])
def test_two_sides_that_hardly_turn_enclose_a_shape(opened, second):
    a, b = (0.0, 0.0), (100.0, 0.0)
    far, near = 50 / math.sin(0.02), 0.02
    arc = f"ARC 8 0 10 50 20 {-far * math.cos(near)} 40 {far} 50 {90 - math.degrees(near)} 51"
    arc += f" {90 + math.degrees(near)}"
    other = line(a, b)
    if second == "bowed":
        other = f"ARC 8 0 10 50 20 {far * math.cos(near)} 40 {far} 50 {270 - math.degrees(near)}"
        other += f" 51 {270 + math.degrees(near)}"
    domain = opened("lens.dxf", dxf(arc, other))
    half = far**2 * (near - math.sin(near) * math.cos(near))
    assert domain.area == pytest.approx(half * (2 if second == "bowed" else 1), rel=1e-9)
    assert domain.optimum("quad") == 2


def test_a_hole_that_touches_the_outline_from_inside_is_no_overlap(opened):
    touching = dxf("CIRCLE 8 0 10 0 20 0 40 10", "CIRCLE 8 0 10 1 20 0 40 9")
    with pytest.raises(MeshError, match=r"near to each other|touch"):
        meshing.mesh_domain(opened("touching.dxf", touching), "quad")
    assert opened("touching.dxf", touching, region="1").area == pytest.approx(81 * math.pi)


def test_too_much_is_refused(refused):
    many = ", ".join(f"{i} {i % 2}" for i in range(100_001))
    assert "100,000 are the most" in refused("a.wkt", f"LINESTRING ({many})")


SOUND = {
    "a.dxf": dxf(*SQUARE, CIRCLE, "LWPOLYLINE 8 0 90 2 70 1 10 1 20 1 42 0.5 10 3 20 1"),
    "a.svg": svg(f'<g transform="scale(2)"><path d="{SLOT}"/><circle cx="5" cy="2" r="1"/></g>'),
    "a.geojson": json.dumps({"type": "Feature", "geometry": GEO, "properties": None}),
    "a.wkt": WKT,
}


@pytest.mark.parametrize("name", SOUND)
@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_damaged_files_give_a_domain_or_a_mesh_error(opened, name, data):
    content = bytearray(SOUND[name].encode())
    cut = data.draw(st.integers(1, len(content)))
    content = content[:cut]
    for _ in range(data.draw(st.integers(0, 4))):
        place = data.draw(st.integers(0, len(content) - 1))
        content[place] = data.draw(st.sampled_from(b'0123456789-.eE \n<>"MACZz\xff\x00'))
    try:
        opened(name, bytes(content))
    except MeshError as error:
        assert "\n" not in str(error)
