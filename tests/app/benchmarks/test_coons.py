"""The suite on Coons maps: its derivatives, the bound of the Jacobian, and what it reports."""

from __future__ import annotations

import numpy as np
import pytest

from meshwright.benchmarks import coons
from meshwright.console import no_update
from meshwright_core.curves.curve import Curve
from meshwright_core.geometry.jacobian_bound import jacobian_bound

RNG = np.random.default_rng


def jacobians(along, across):
    return along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0]


def bounds(corners, bends, along, across, parts):
    step = (along.shape[1] - 1) // parts
    rows = [x[:, ::step, ::step].reshape(len(x), -1, 2) for x in (along, across)]
    return jacobian_bound(corners, bends, rows[0], rows[1], parts)


def sector(degrees):
    """A sector of the ring between the radii 1 and 2: polar coordinates are its Coons map."""
    angle = np.radians(degrees)
    ends = np.array([[1.0, 0.0], [np.cos(angle), np.sin(angle)]])
    corners = np.array([ends[0], 2 * ends[0], 2 * ends[1], ends[1]])
    sides = [
        Curve.line(corners[0], corners[1]),
        Curve.arc((0.0, 0.0), 2.0, 0.0, angle),
        Curve.line(corners[2], corners[3]),
        Curve.arc((0.0, 0.0), 1.0, angle, -angle),
    ]
    return corners[None], sides, np.array([[0.0, 2.0 * angle**2, 0.0, angle**2]])


def test_the_map_of_a_sector_is_polar_coordinates():
    corners, sides, _ = sector(90.0)
    along, across = coons.derivatives(corners, sides, 8)
    radius = np.linspace(1.0, 2.0, 9)
    assert np.linalg.norm(along, axis=3) == pytest.approx(1.0)
    # the parameter of an arc is its length to four per cent
    speed = np.linalg.norm(across[0], axis=2)
    wanted = np.broadcast_to((0.5 * np.pi * radius)[:, None], (9, 9))
    assert speed == pytest.approx(wanted, rel=0.04)
    assert (jacobians(along, across) > 0.0).all()


def test_a_finer_grid_certifies_a_sector():
    corners, sides, bends = sector(90.0)
    derivatives = coons.derivatives(corners, sides, 64)
    found = [float(bounds(corners, bends, *derivatives, parts)[0]) for parts in (4, 16, 64)]
    assert found == sorted(found)
    assert found[-1] > 0.0


@pytest.mark.parametrize("degrees", [60.0, 120.0])
@pytest.mark.parametrize("bent", [1, 4])
def test_the_jacobian_never_falls_below_the_bound(bent, degrees):
    corners, sides, bends = coons._quads(RNG(bent), 200, bent, degrees)
    derivatives = coons.derivatives(corners, sides, 64)
    least = jacobians(*derivatives).min(axis=(1, 2))
    for parts in (4, 16):
        assert (bounds(corners, bends, *derivatives, parts) <= least).all()


def test_straight_quads_need_their_corners_only():
    corners, sides, bends = coons._quads(RNG(0), 50, 0, 90.0)
    least = jacobians(*coons.derivatives(corners, sides, 8))
    assert least.min(axis=(1, 2)) == pytest.approx(least[:, ::8, ::8].min(axis=(1, 2)))
    assert not bends.any()


def test_the_suite_counts(monkeypatch):
    monkeypatch.setattr(coons, "QUICK", 20)
    found = coons.run(0, True, no_update)
    assert len(found) == 12
    for row in found.values():
        assert 0 <= row["missed"] <= row["valid at 5 x 5"] <= row["quads"] == 20
        assert row.get("certified at 5 x 5", 0.0) <= row.get("certified at 17 x 17", 1.0)
