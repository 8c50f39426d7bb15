from dataclasses import replace

from meshwright.assistant.block_search import better_blocks
from meshwright_agent.search.layout_search import Preference
from meshwright_agent.search.solution import Solution

_WIDE = Solution(
    [], 0, 0, 0, elements=10, worst_scaled_jacobian=0.61, worst_shape=0.15,
    aims=Preference().aims(1.0, 1.0),
)  # fmt: skip


def test_long_blocks_with_good_corners_are_better():
    long = replace(_WIDE, elements=5, worst_scaled_jacobian=0.7, worst_shape=0.02)
    assert long.rank > _WIDE.rank
    assert better_blocks(_WIDE, long) is long


def test_fewer_blocks_with_bad_corners_are_not():
    sharp = replace(_WIDE, elements=5, worst_scaled_jacobian=0.2, worst_shape=0.02)
    assert better_blocks(_WIDE, sharp) is _WIDE


def test_fewer_blocks_at_a_higher_s_are_not():
    above = replace(_WIDE, elements=5, worst_scaled_jacobian=0.7, score=2)
    assert better_blocks(_WIDE, above) is _WIDE
