"""SVG: the cascade of styles, view boxes, symbols, units; what is not drawn is not read."""

import math

import pytest

from meshwright_core import MeshError
from meshwright_core.io.drawings.readers import svg_lengths
from meshwright_core.io.drawings.readers.svg import says_something


def svg(body: str, head: str = "") -> str:
    link = 'xmlns:xlink="http://www.w3.org/1999/xlink"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {link} {head}>{body}</svg>'


RECT = '<rect width="100" height="100"/>'
GUIDE = '<circle id="guide" class="a b" cx="50" cy="50" r="10"/>'


@pytest.mark.parametrize(
    "style",
    [
        "#guide{display:none}",
        "circle{display:none}",
        ".a{display:none} .a{fill:red}",
        ".x,.b{display:none}",
        "svg > circle.a[r='10']{visibility:hidden}",
        ".a{display:inline} #guide{display:none} .b{display:inline}",
        ".a{display:none !important} #guide{display:inline}",
        "circle{fill:none} .b{stroke:none}",
        "@media screen{.a{display:none}}",
        "/* a */ .a /* b */ {display:none;;}",
        "!!{} .a{display:none}",
    ],
)
def test_style_sheets_hide_the_circle(found, style):
    (region,) = found("a.svg", svg(f"<style>{style}</style>{RECT}{GUIDE}")).regions
    assert region.area == 10_000


@pytest.mark.parametrize(
    "style",
    [
        ".a{display:none} #guide{display:inline}",
        ".a{display:none} .a.b{display:inline}",
        "@media print{.a{display:none}}",
        ".c{display:none} g circle{display:none}",
        "circle{fill:none} .b{stroke:red}",
    ],
)
def test_style_sheets_that_leave_the_circle(found, style):
    (region,) = found("a.svg", svg(f"<style>{style}</style>{RECT}{GUIDE}")).regions
    assert region.area == pytest.approx(10_000 - 100 * math.pi)


def test_style_attributes_win_over_sheets_and_those_over_attributes(found):
    circle = '<circle class="a" cx="50" cy="50" r="10" display="none" style="{}"/>'
    sheet = "<style>.a{display:inline}</style>"
    assert found("a.svg", svg(sheet + RECT + circle.format(""))).regions[0].holes == 1
    assert found("a.svg", svg(sheet + RECT + circle.format("display:none"))).regions[0].holes == 0


def test_open_strokes_make_one_outline(found):
    body = (
        "<defs><style>.cls-1,.cls-2{fill:none;stroke:#000;}.cls-2{stroke-width:2px;}</style></defs>"
        '<path class="cls-1" d="M10,10H90V60"/>'
        '<path class="cls-2" d="M90,60A40,15,0,0,1,10,60V10"/>'
    )
    (region,) = found("a.svg", svg(body, 'viewBox="0 0 100 80"')).regions
    assert region.area == pytest.approx(4000 + 300 * math.pi, rel=1e-12)


def box(region) -> list[float]:
    boxes = [side.curve.box for side in region.loops[0]]
    low, high = min(b[0].tolist() for b in boxes), max(b[1].tolist() for b in boxes)
    return [*low, *high]


def test_nested_drawings_have_view_boxes(found):
    inner = '<svg x="10" y="20" width="40" height="20" viewBox="0 0 4 4" {}>{}</svg>'
    rect = '<rect width="4" height="4"/>'
    for aspect, wanted in [
        ("", [20, -40, 40, -20]),
        ('preserveAspectRatio="none"', [10, -40, 50, -20]),
        ('preserveAspectRatio="xMaxYMid"', [30, -40, 50, -20]),
        ('preserveAspectRatio="xMinYMin slice"', [10, -60, 50, -20]),
    ]:
        (region,) = found("a.svg", svg(inner.format(aspect, rect))).regions
        assert box(region) == pytest.approx(wanted)


def test_symbols_are_drawn_where_they_are_used(found):
    body = (
        '<symbol id="s" viewBox="0 0 2 2"><circle cx="1" cy="1" r="1"/></symbol>'
        '<use xlink:href="#s" x="10" y="0" width="20" height="20"/>'
        '<use href="#s" x="40" y="0" width="10" height="10"/>'
    )
    areas = [region.area for region in found("a.svg", svg(body)).regions]
    assert areas == pytest.approx([100 * math.pi, 25 * math.pi])


def test_definitions_markers_and_clips_are_not_drawn(found):
    hidden = "".join(
        f'<{tag}><rect x="200" width="9" height="9"/></{tag}>'
        for tag in ("defs", "clipPath", "mask", "marker", "pattern", "symbol")
    )
    report = found("a.svg", svg(hidden + RECT + "<text>a</text><image/>"))
    assert [region.area for region in report.regions] == [10_000]
    assert report.ignored == ["1 image, 1 text left out"]


def test_arcs_of_circles_stay_arcs_and_curves_splines(found):
    path = '<path d="M0 0A5 5 0 0 1 10 0C12 4 8 8 5 8Q0 8 0 0z"/>'
    (region,) = found("a.svg", svg(path)).regions
    assert sorted(side.curve.kind for side in region.loops[0]) == ["arc", "spline", "spline"]
    scaled = f'<g transform="scale(2 1)">{path}</g>'
    (region,) = found("a.svg", svg(scaled)).regions
    assert sorted(side.curve.kind for side in region.loops[0]) == ["ellipse", "spline", "spline"]


def test_regions_and_sides_are_named_after_ids_that_say_something(found):
    body = f'<g id="Plate">{RECT}</g><circle id="path123" cx="200" cy="0" r="3"/>'
    assert [r.name for r in found("a.svg", svg(body)).regions] == ["Plate", "region 2"]


@pytest.mark.parametrize("name", ["path1234", "g10", "Layer_1", "rect-3", "svg2", "use4", "_x31_"])
def test_ids_that_programs_make_up_say_nothing(name):
    assert not says_something(name)


def test_an_insert_is_told_from_a_hole_by_its_group(found):
    plate = '<path id="plate" fill-rule="evenodd" d="M0 0H9V9H0zM3 3H6V6H3z"/>'
    report = found("a.svg", svg(plate + '<rect id="insert" x="3" y="3" width="3" height="3"/>'))
    assert [(r.name, r.area, r.holes) for r in report.regions] == [
        ("plate", 72, 0),
        ("insert", 9, 0),
    ]
    assert report.regions[0].touches == (1,)
    assert [r.area for r in found("a.svg", svg(plate)).regions] == [72]


def test_entities_that_multiply_are_refused(sentence):
    entities = '<!ENTITY a "<g/>">' + "".join(
        f'<!ENTITY {chr(98 + i)} "{("&" + chr(97 + i) + ";") * 10}">' for i in range(12)
    )
    text = f"<!DOCTYPE svg [{entities}]>" + svg("&m;")
    assert "a.svg" in sentence("a.svg", text)


def test_transforms():
    assert svg_lengths.transform("rotate(90)")[:2, :2].tolist() == [[0, -1], [1, 0]]
    assert svg_lengths.transform("translate(1px, 2px) rotate(180deg)")[:2, 2].tolist() == [1, 2]
    with pytest.raises(MeshError, match="not understood"):
        svg_lengths.transform("rotate(1) and more")
