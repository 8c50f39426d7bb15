"""Plates of many holes: how much is evaluated, what is read twice, and holes that touch."""

from __future__ import annotations

import os

import ezdxf
import pytest

from meshwright_core.curves.curve import Curve
from meshwright_core.domains import meshing
from meshwright_core.errors import MeshError
from meshwright_core.io import drawings
from meshwright_core.io.drawings.readers import dxf


def plate(path, circles, size=(100.0, 100.0)):
    """A DXF file of a rectangle from the origin on and circles (x, y, radius) in it."""
    document = ezdxf.new()
    model = document.modelspace()
    corners = [(0, 0), (size[0], 0), size, (0, size[1])]
    model.add_lwpolyline(corners, close=True)
    for x, y, radius in circles:
        model.add_circle((x, y), radius)
    document.saveas(path)
    return path


def grid(count):
    """`count` squared circles."""
    step = 100.0 / (count + 1)
    return [
        (step * (i + 1), step * (j + 1), 0.3 * step) for i in range(count) for j in range(count)
    ]


def test_no_hole_is_evaluated_on_its_own(tmp_path, monkeypatch):
    evaluate, calls = Curve._evaluated, []
    monkeypatch.setattr(Curve, "_evaluated", lambda *given: calls.append(1) or evaluate(*given))
    counts = []
    for side in (3, 8):
        path = plate(tmp_path / f"{side}.dxf", grid(side))
        calls.clear()
        domain = drawings.read_domain(path)
        meshing.mesh_domain(domain, "quad")
        assert len(domain.holes) == side * side
        counts.append(len(calls))
    assert counts[0] == counts[1]


def test_a_file_that_has_not_changed_is_read_once(tmp_path, monkeypatch):
    read, calls = dxf.read, []
    monkeypatch.setitem(drawings._READERS, ".dxf", lambda given: calls.append(1) or read(given))
    path = plate(tmp_path / "plate.dxf", grid(2))
    report = drawings.read_regions(path)
    drawings.read_domain(path)
    drawings.read_domain(path, region="1")
    assert len(calls) == 1
    assert drawings.read_regions(path, gap=0.5) is not report
    assert len(calls) == 2


def test_a_file_that_has_changed_is_read_again(tmp_path):
    path = plate(tmp_path / "plate.dxf", grid(2))
    before = drawings.read_regions(path)
    plate(path, grid(3))
    os.utime(path, ns=(1, 1))
    assert [before.regions[0].holes, drawings.read_regions(path).regions[0].holes] == [4, 9]


def test_two_holes_that_touch_are_told_with_their_place(tmp_path):
    path = plate(tmp_path / "touching.dxf", [(40.0, 50.0, 10.0), (60.0, 50.0, 10.0)])
    told = "the boundary touches itself at (50, 50)"
    assert drawings.read_regions(path).regions[0].crossing == told
    with pytest.raises(MeshError, match=r"touches itself at \(50, 50\)"):
        drawings.read_domain(path)


@pytest.mark.parametrize(
    ("circle", "told"),
    [
        ((50.0, 10.0, 10.0), "touches another line or curve at (50, 0)"),
        ((50.0, 6.0, 10.0), "crosses another line or curve at ("),
    ],
)
def test_touching_and_crossing_are_told_apart(tmp_path, circle, told):
    path = plate(tmp_path / "plate.dxf", [circle])
    assert drawings.read_regions(path).regions[0].crossing.startswith(f"the boundary {told}")


def test_where_every_outline_crosses_another_that_is_what_is_said(tmp_path):
    path = plate(tmp_path / "plate.dxf", [(40.0, 50.0, 10.0), (50.0, 50.0, 10.0)])
    with pytest.raises(MeshError, match=r"crosses another line or curve at \(45, "):
        drawings.read_domain(path)


def test_regions_that_fill_the_sectors_around_a_point_do_not_touch_in_it(tmp_path):
    document = ezdxf.new()
    for x, y in ((0, 0), (10, 0), (0, 10), (10, 10)):
        corners = [(x, y), (x + 10, y), (x + 10, y + 10), (x, y + 10)]
        document.modelspace().add_lwpolyline(corners, close=True)
    path = tmp_path / "four.dxf"
    document.saveas(path)
    assert [region.crossing for region in drawings.read_regions(path).regions] == [""] * 4
