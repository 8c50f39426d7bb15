"""DXF: code pages, layers, what is left out, what is repaired, files that try to do harm."""

import math

import ezdxf
import pytest
from drawing_files import rounded, saved

LINES = "0\nSECTION\n2\nENTITIES\n{}\n0\nENDSEC\n0\nEOF\n"
HEAD = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$DWGCODEPAGE\n3\nANSI_1252\n0\nENDSEC\n"


def tags(text: str) -> str:
    return text.replace(" ", "\n")


SQUARE = tags(
    "0 LWPOLYLINE 8 {layer} 100 AcDbEntity 100 AcDbPolyline 90 4 70 1 "
    "10 -10.0 20 -10.0 10 10.0 20 -10.0 10 10.0 20 10.0 10 -10.0 20 10.0"
)


def block(name: str, radius: float) -> str:
    return tags(
        f"0 BLOCK 8 0 2 {name} 70 0 10 0.0 20 0.0 30 0.0 3 {name} "
        f"0 CIRCLE 8 0 10 0.0 20 0.0 40 {radius} 0 ENDBLK 8 0"
    )


def test_names_of_blocks_are_in_the_code_page(found):
    blocks = tags("0 SECTION 2 BLOCKS ") + block("TÜR", 1) + "\n" + block("TÖR", 3)
    insert = tags("0 INSERT 8 0 2 TÜR 10 0.0 20 0.0 30 0.0")
    text = HEAD + blocks + "\n0\nENDSEC\n" + LINES.format(SQUARE.format(layer="0") + "\n" + insert)
    (region,) = found("blocks.dxf", text.encode("cp1252")).regions
    assert region.area == pytest.approx(400 - math.pi)


def test_names_of_layers_are_in_the_code_page(found):
    layer = "0 LAYER 2 {} 70 0 62 {} 6 CONTINUOUS "
    table = "0 SECTION 2 TABLES 0 TABLE 2 LAYER 70 3 " + layer.format("HÜLLE", 7)
    table += layer.format("HÖLLE", -7) + "0 ENDTAB 0 ENDSEC "
    circle = "\n" + tags("0 CIRCLE 8 HÖLLE 10 0.0 20 0.0 40 2.0")
    text = HEAD + tags(table) + LINES.format(SQUARE.format(layer="HÜLLE") + circle)
    report = found("layers.dxf", text.encode("cp1252"))
    assert [(r.name, r.area, r.layer) for r in report.regions] == [("HÜLLE", 400, "HÜLLE")]
    assert report.ignored == ["1 hidden entity left out"]


def test_text_without_a_version_is_taken_for_utf_8_if_it_is(found):
    text = LINES.format(SQUARE.format(layer="Löcher"))
    assert found("a.dxf", text).regions[0].name == "Löcher"
    assert found("a.dxf", text.encode("cp1252")).regions[0].name == "Löcher"


def test_frozen_layers_defpoints_and_centre_lines_are_left_out(found):
    document = ezdxf.new("R2010", setup=True)
    space = document.modelspace()
    area = rounded(space, 0, 0, 20, 10, 2, layer="Plate")
    document.layers.add("Frozen").freeze()
    space.add_circle((10, 5), 1, dxfattribs={"layer": "Frozen"})
    space.add_circle((10, 5), 2, dxfattribs={"layer": "Defpoints"})
    space.add_circle((10, 5), 3, dxfattribs={"linetype": "CENTER"})
    document.layers.add("Axes", linetype="DASHDOT")
    space.add_circle((10, 5), 4, dxfattribs={"layer": "Axes"})
    report = found("a.dxf", saved(document))
    assert [(r.name, r.holes) for r in report.regions] == [("Plate", 0)]
    assert report.regions[0].area == pytest.approx(area)
    assert report.ignored == ["1 CIRCLE, 2 centre line, 1 hidden entity left out"]


def test_sides_are_named_after_layers_and_entities_of_layer_0_after_their_insert(found):
    document = ezdxf.new("R2010")
    part = document.blocks.new("part")
    part.add_lwpolyline([(0, 0), (4, 0), (4, 4), (0, 4)], close=True)
    part.add_circle((2, 2), 1, dxfattribs={"layer": "Holes"})
    document.modelspace().add_blockref("part", (9, 9), dxfattribs={"layer": "Rim"})
    (region,) = found("a.dxf", saved(document)).regions
    assert [{side.name for side in loop} for loop in region.loops] == [{"Rim"}, {"Holes"}]
    assert region.name == "Rim"


def test_arcs_and_splines_stay_what_they_are(found):
    document = ezdxf.new("R2010")
    space = document.modelspace()
    space.add_arc((0, 0), 2, 0, 90)
    space.add_ellipse((0, 0), (0, 2), 0.5, 0, math.pi / 2)
    space.add_open_spline([(-1, 0), (-1, -1), (0, -2), (1, -1)], degree=3)
    space.add_line((1, -1), (2, 0))
    (region,) = found("a.dxf", saved(document)).regions
    kinds = sorted(side.curve.kind for side in region.loops[0])
    assert kinds == ["arc", "ellipse", "line", "spline"]


def test_blocks_scaled_unevenly_make_ellipses_and_mirrored_ones_turn(found):
    document = ezdxf.new("R2010")
    part = document.blocks.new("part")
    part.add_lwpolyline([(0, 0, 1), (2, 0, 0)], format="xyb", close=True)
    look = {"xscale": -2, "yscale": 1, "rotation": 30}
    document.modelspace().add_blockref("part", (5, 5), dxfattribs=look)
    (region,) = found("a.dxf", saved(document)).regions
    assert region.area == pytest.approx(math.pi)
    assert {side.curve.kind for side in region.loops[0]} == {"ellipse", "line"}


def test_units_of_the_drawing_are_told(found):
    document = ezdxf.new("R2010", units=4)
    document.modelspace().add_circle((0, 0), 1)
    assert found("a.dxf", saved(document)).units == "mm"


def test_what_ezdxf_removes_is_told(found):
    missing = "\n" + tags("0 INSERT 8 0 2 Nut 10 0 20 0")
    report = found("a.dxf", LINES.format(SQUARE.format(layer="0") + missing))
    assert report.repairs == ["there is no block named 'Nut'"]
    report = found("a.dxf", LINES.format(SQUARE.format(layer="0")).removesuffix("0\nEOF\n"))
    assert report.repairs == ["the end of the file is not marked (EOF): it may be cut off"]


def test_tilted_curves_are_left_out(found):
    tilted = "\n" + tags("0 CIRCLE 8 0 10 0 20 0 40 2 210 1 220 0 230 0")
    report = found("a.dxf", LINES.format(SQUARE.format(layer="0") + tilted))
    assert report.ignored == ["1 CIRCLE that does not lie in the plane left out"]


@pytest.mark.parametrize(
    ("inserts", "reason"),
    [
        ("0 INSERT 2 A 10 0 20 0 70 400 71 400 44 3 45 3", "more than 100,000"),
        ("0 INSERT 2 A 10 0 20 0 41 0 42 0", "scaled to nothing|no lines or curves"),
        ("0 INSERT 2 A 10 0 20 0 41 1e90 42 1e300", "no number"),
    ],
)
def test_harmful_inserts_are_refused(sentence, inserts, reason):
    blocks = tags("0 SECTION 2 BLOCKS 0 BLOCK 2 A 0 CIRCLE 10 0 20 0 40 1 0 ENDBLK 0 ENDSEC ")
    message = sentence("a.dxf", blocks + LINES.format(tags(inserts)))
    assert any(part in message for part in reason.split("|")), message


def test_blocks_that_multiply_are_refused_in_time(sentence):
    text = "0 SECTION 2 BLOCKS 0 BLOCK 2 B0 0 CIRCLE 10 0 20 0 40 1 0 ENDBLK "
    for i in range(1, 7):
        inserts = "".join(f"0 INSERT 2 B{i - 1} 10 {j} 20 0 " for j in range(10))
        text += f"0 BLOCK 2 B{i} {inserts}0 ENDBLK "
    text = tags(text + "0 ENDSEC ") + LINES.format(tags("0 INSERT 2 B6 10 0 20 0"))
    assert "more than 100,000" in sentence("a.dxf", text)
