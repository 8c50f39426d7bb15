"""Random parts: as many corners as requested, nothing degenerate, meshes without folds."""

import numpy as np
import pytest
import shapely

from meshwright_core.domains.domain import turning_angles
from meshwright_core.domains.random_parts import (
    DIAMETER,
    FLATTEST,
    GAP,
    SHARPEST,
    part_mesh,
    parts,
    random_part,
)
from meshwright_core.errors import MeshError
from meshwright_core.geometry import quality

RANGES = [(8, 24), (25, 50)]


@pytest.mark.parametrize("corners", RANGES)
def test_parts_have_the_requested_corners_and_holes(corners):
    made = parts(12, corners, seed=5)
    for i, domain in enumerate(made):
        count = sum(len(loop) for loop in domain.loops)
        assert corners[0] <= count <= corners[1]
        assert all(flags.all() for flags in domain.loop_corners)
        assert 1 <= len(domain.holes) <= 2 if i % 2 else not domain.holes
    assert len({domain.name for domain in made}) > 3


@pytest.mark.parametrize("corners", RANGES)
def test_no_part_is_degenerate(corners):
    for domain in parts(12, corners, seed=6):
        sides = np.concatenate(
            [np.hypot(*(np.roll(loop, -1, axis=0) - loop).T) for loop in domain.loops]
        )
        turned = np.concatenate([turning_angles(loop) for loop in domain.loops])
        assert turned.min() >= FLATTEST - 1e-6
        assert turned.max() <= 180 - SHARPEST + 1e-6
        assert domain.diameter == pytest.approx(DIAMETER, rel=0.15)
        least = sides.min()
        loops = [shapely.LinearRing(loop) for loop in domain.loops]
        for i, loop in enumerate(loops):
            for other in loops[:i]:
                assert loop.distance(other) > 0.3 * GAP * least


def test_a_part_depends_on_its_seed_and_place_alone():
    first, second = parts(4, (8, 24), 7), parts(2, (8, 24), 7)
    assert all((a.outline == b.outline).all() for a, b in zip(first, second, strict=False))
    assert (
        first[0].outline.shape != parts(1, (8, 24), 8)[0].outline.shape
        or (first[0].outline != parts(1, (8, 24), 8)[0].outline).any()
    )


@pytest.mark.parametrize("corners", range(4, 12))
def test_small_parts(corners):
    for holes in (True, False):
        domain = random_part(corners, np.random.default_rng(corners), holes)
        assert sum(len(loop) for loop in domain.loops) == corners
        assert bool(domain.holes) == (holes and corners > 6)


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_meshes_of_parts_have_no_folds(kind):
    rng = np.random.default_rng(9)
    for _ in range(6):
        mesh = part_mesh(kind, (8, 50), rng)
        assert len(quality.inverted(mesh)) == 0
        mesh.validate()


@pytest.mark.parametrize("corners", [3, (9, 8), (2, 5)])
def test_impossible_parts_are_refused(corners):
    with pytest.raises(MeshError, match="corners"):
        random_part(corners, np.random.default_rng(0))
