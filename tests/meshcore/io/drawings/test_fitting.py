"""Polylines that stand for curves: arcs and splines are found in them where that is asked for."""

import math

import numpy as np
import pytest

from meshwright_core.io import drawings


def text(points: np.ndarray) -> str:
    ring = ", ".join(f"{x!r} {y!r}" for x, y in np.vstack([points, points[:1]]).tolist())
    return f"POLYGON(({ring}))"


def rounded(steps: int) -> np.ndarray:
    """A 10 by 5 rectangle with fillets of radius 1 as chords."""
    angle = np.radians(np.linspace(0, 90, steps + 1))
    corners = [((9, 1), -90), ((9, 4), 0), ((1, 4), 90), ((1, 1), 180)]
    return np.vstack(
        [
            np.add(centre, np.column_stack([np.cos(a), np.sin(a)]))
            for centre, turn in corners
            for a in [angle + math.radians(turn)]
        ]
    )


@pytest.fixture
def read(tmp_path):
    def read(points: np.ndarray, fit: str | None):
        path = tmp_path / "a.wkt"
        path.write_text(text(points))
        return drawings.read_domain(path, fit=fit)

    return read


def test_arcs_are_found_in_chords(read):
    domain = read(rounded(12), "arcs")
    (loop,) = domain.boundary
    assert sorted(curve.kind for curve in loop) == ["arc"] * 4 + ["line"] * 4
    assert domain.area == pytest.approx(50 - (4 - math.pi), rel=1e-6)


def test_splines_are_found_between_corners(read):
    angle = np.linspace(0, math.pi, 41)
    half = np.column_stack([2 * np.cos(angle), np.sin(angle)])
    domain = read(half, "splines")
    (loop,) = domain.boundary
    assert sorted(curve.kind for curve in loop) == ["line", "spline"]
    assert domain.area == pytest.approx(math.pi, rel=1e-3)
    assert read(half, None).boundary[0][0].kind != "spline"


def test_straight_sides_between_splines_stay_straight(read):
    domain = read(rounded(12), "splines")
    (loop,) = domain.boundary
    assert sorted(curve.kind for curve in loop) == ["line"] * 4 + ["spline"] * 4
    assert domain.area == pytest.approx(50 - (4 - math.pi), rel=1e-3)


def test_polygons_stay_polygons(read):
    square = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
    for fit in ("arcs", "splines"):
        domain = read(square, fit)
        assert domain.area == pytest.approx(16)
        assert not domain.has_curves
