"""Input on which Triangle, which is native code, would crash."""

import numpy as np
import pytest

from meshwright_core.domains.elements.triangulation import Bounds, triangle_areas, triangulated
from meshwright_core.errors import MeshError

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
RING = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
NO_HOLES = np.empty((0, 2))


def with_point(*place):
    return np.vstack([SQUARE, [place]])


@pytest.mark.parametrize("bounds", [Bounds(), Bounds(28.6, 0.3)])
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize(
    ("points", "reason"),
    [
        (with_point(1.0, 1.0), "coincide"),
        (with_point(1.0, 1e-160), "coincide"),
        (with_point(0.5, np.nan), "finite"),
        (with_point(0.5, np.inf), "finite"),
        (SQUARE[:2], "three points"),
    ],
)
def test_points_that_are_unfit_are_refused(points, reason, bounds, seed):
    segments = np.vstack([RING, [[0, 4]]]) if len(points) > 4 else RING[:1]
    with pytest.raises(MeshError, match=reason):
        triangulated(points, segments, NO_HOLES, 2.0**0.5, bounds, seed)


def test_coordinates_next_to_nothing_keep_their_places():
    points = with_point(0.5, 0.5)
    points[1, 1] = points[3, 0] = 1e-170
    found = triangulated(points, RING, NO_HOLES, 2.0**0.5, Bounds(28.6, 0.3))
    assert (found.points[:5] == points).all()
    assert triangle_areas(found.points, found.triangles).sum() == pytest.approx(1.0)


@pytest.mark.parametrize("extra", [[[0, 2], [1, 3]], [[0, 1], [1, 2]], [[1, 1]]])
def test_segments_that_cross_repeat_or_have_no_length_do_no_harm(extra):
    found = triangulated(SQUARE, np.vstack([RING, extra]), NO_HOLES, 2.0**0.5, Bounds())
    assert triangle_areas(found.points, found.triangles).sum() == pytest.approx(1.0)
