"""Drawings of all kinds, made by script: all regions are found, with exact areas and all holes."""

import ezdxf
import pytest
from drawing_files import drawing_files, saved

from meshwright_core.curves.curve import Curve
from meshwright_core.io import drawings

FILES = {file.name: file for file in drawing_files()}


def test_there_are_27():
    assert len(FILES) == 27


@pytest.mark.parametrize("name", FILES)
def test_all_regions_are_found_with_area_and_holes(tmp_path, name):
    file = FILES[name]
    path = tmp_path / name
    path.write_bytes(file.content)
    report = drawings.read_regions(path)
    found = [(region.area, region.holes) for region in report.regions]
    assert [holes for _, holes in found] == [holes for _, holes in file.regions]
    for (area, _), (wanted, _) in zip(found, file.regions, strict=True):
        assert area == pytest.approx(wanted, rel=1e-9)
    assert all(not region.crossing for region in report.regions)
    assert not report.open_outlines
    domain = drawings.read_domain(path, region="1")
    assert domain.area == pytest.approx(file.regions[0][0], rel=1e-9)


def test_1000_holes_are_traced_without_evaluating_each(tmp_path, monkeypatch):
    document = ezdxf.new("R2010")
    space = document.modelspace()
    space.add_lwpolyline([(-2, -2), (98, -2), (98, 98), (-2, 98)], close=True)
    for i in range(1000):
        space.add_circle((i % 32 * 3, i // 32 * 3), 1)
    path = tmp_path / "many.dxf"
    path.write_bytes(saved(document))
    evaluate, calls = Curve._evaluated, []
    monkeypatch.setattr(Curve, "_evaluated", lambda *given: calls.append(1) or evaluate(*given))
    report = drawings.read_regions(path)
    assert len(calls) < 10
    assert [region.holes for region in report.regions] == [1000]
