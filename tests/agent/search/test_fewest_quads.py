"""The fewest quads of the star at its optimum: all its decompositions into five are listed.

Euler's formula for a disc of Q quads with b boundary vertices leaves 1 + Q - b / 2 inside. With
Q = 5 and b = 10, the corners alone, there is one vertex inside; every tip keeps degree 2 only in a
quad of its own, and these close up only around a vertex of degree 5, which makes s = 6. With b = 12
there is none inside: such decompositions are those of a 12-gon by diagonals. With b = 14 there
would be fewer than none.
"""

from functools import cache
from itertools import combinations_with_replacement

import pytest

from meshwright_agent.policy.policy_files import load
from meshwright_agent.search.solver import solve
from meshwright_core.domains.gallery import shape
from meshwright_core.domains.meshing import mesh_domain

pytestmark = pytest.mark.slow

DESIRED = {"reflex": 4, "tip": 2, "flat": 3}


@cache
def _dissections(first, last):
    """All ways to cut the polygon first ... last into quads, each a frozenset of quads."""
    if last - first == 1:
        return [frozenset()]
    return [
        left | middle | right | {(first, a, b, last)}
        for a in range(first + 1, last, 2)
        for b in range(a + 1, last, 2)
        for left in _dissections(first, a)
        for middle in _dissections(a, b)
        for right in _dissections(b, last)
    ]


def _outlines():
    """The corners of the star with two more vertices anywhere on its sides."""
    for sides in combinations_with_replacement(range(10), 2):
        outline = []
        for side in range(10):
            outline.append("tip" if side % 2 else "reflex")
            outline += ["flat"] * sides.count(side)
        yield outline


def _degrees(quads):
    edges = {tuple(sorted((quad[i - 1], quad[i]))) for quad in quads for i in range(4)}
    return [sum(v in edge for edge in edges) for v in range(12)]


def test_five_quads_reach_the_optimum_only_where_they_cannot_be_drawn():
    assert len(_dissections(0, 11)) == 273
    bad_corners = []
    for outline in _outlines():
        for quads in _dissections(0, 11):
            degrees = _degrees(quads)
            if sum(abs(d - DESIRED[kind]) for d, kind in zip(degrees, outline, strict=True)) == 4:
                # a quad alone at a flat or reflex vertex has an angle of 180 degrees or more there
                alone = [d == 2 and kind != "tip" for d, kind in zip(degrees, outline, strict=True)]
                bad_corners.append(sum(alone))
    assert len(bad_corners) == 45
    assert min(bad_corners) == 2


def test_the_solver_finds_some_that_can_be_drawn():
    star = mesh_domain(shape("star"), "quad")
    solution = solve(star, load("quad"), rollouts=4, seed=1)
    assert (solution.score, solution.inverted) == (4, 0)
    assert 6 <= solution.elements <= 8  # 6 where it has the time; it started from 24
