"""The sketch behind the drawing page: edits, what is wrong in words, snapping."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshwright.sources.polygon_checks import PolygonLoop
from meshwright.sources.polygon_sketch import Sketch
from meshwright.sources.snapping import Snapper
from meshwright_core import MeshError
from meshwright_core.domains.domain import Domain

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


def drawn(*loops: list[tuple[float, float]], close: bool = True) -> Sketch:
    sketch = Sketch()
    for i, loop in enumerate(loops):
        if i:
            assert sketch.add_hole()
        for place in loop:
            sketch.add(place)
        if close or i < len(loops) - 1:
            assert sketch.close()
    return sketch


def test_a_square_with_a_hole_becomes_a_domain():
    sketch = drawn(SQUARE, [(1, 1), (2, 1), (2, 2)])
    assert sketch.complete and sketch.words == ""
    domain = Domain.from_json(sketch.domain())
    assert domain.area == 15.5
    assert [len(flags) for flags in domain.loop_corners] == [4, 3]


def test_hints_on_the_next_corner():
    sketch = Sketch()
    assert sketch.words == "Click to place the first corner of the outline."
    sketch.add((0, 0))
    assert sketch.words == "The outline needs at least 2 corners more."
    assert not sketch.close()
    sketch.add((1, 0))
    assert sketch.words == "The outline needs at least one corner more."
    assert not sketch.add_hole()
    sketch.add((1, 1))
    assert "close the outline" in sketch.words
    with pytest.raises(MeshError):
        sketch.domain()
    assert sketch.close()
    assert sketch.add_hole()
    assert sketch.words == "Click inside the outline to place the first corner of hole 1."


@pytest.mark.parametrize(
    ("loops", "words", "edges"),
    [
        ([[(0, 0), (2, 2), (2, 0), (0, 2)]], "itself near (1, 1)", {(0, 0), (0, 2)}),
        ([[(0, 0), (4, 0), (4, 4), (2, 0), (0, 4)]], "itself near (2, 0)", None),
        ([[(0, 0), (4, 0), (2, 0), (2, 2)]], "touches itself", {(0, 0), (0, 1)}),
        ([SQUARE, [(5, 5), (6, 5), (6, 6)]], "Hole 1 lies outside the outline.", None),
        ([SQUARE, [(3, 3), (6, 3), (3, 3.5)]], "Hole 1 crosses or touches the outline", None),
        (
            [SQUARE, [(1, 1), (3, 1), (3, 3), (1, 3)], [(1.5, 1.5), (2, 1.5), (2, 2)]],
            "Hole 2 lies inside hole 1.",
            None,
        ),
        (
            [SQUARE, [(1, 1), (2, 1), (2, 2)], [(1.5, 0.5), (3, 0.5), (1.8, 1.8)]],
            "Hole 2 crosses or touches hole 1",
            None,
        ),
        ([[(0, 0), (1, 1), (2, 2)]], "itself", None),
    ],
)
def test_problems_have_a_sentence_and_marks(loops, words, edges):
    sketch = drawn(*loops)
    assert not sketch.complete
    assert words in sketch.words
    assert edges is None or set(sketch.problem.edges) == edges
    with pytest.raises(MeshError, match=r"\w"):
        sketch.domain()


def test_a_crossing_edge_is_detected_before_it_is_added():
    sketch = drawn([(0, 0), (4, 0), (4, 4)], close=False)
    assert sketch.trial((0, 4)) is None
    assert "crosses" in sketch.trial((2, -2)).words
    assert sketch.trial((0, 0)) is None
    assert sketch.problem is None


def test_corners_in_line_are_allowed():
    assert drawn([(0, 0), (2, 0), (4, 0), (4, 4), (0, 4)]).complete


def test_every_edit_is_undone_and_redone():
    sketch = drawn(SQUARE, [(1, 1), (2, 1), (2, 2)])
    sketch.set(0, 1, (5, 0))
    sketch.insert(0, 2, (5, 2))
    sketch.remove(1, 0)
    sketch.begin()
    sketch.move(0, 0, (-1, 0))
    sketch.move(0, 0, (-2, 0))
    states = [sketch.loops]
    while sketch.can_undo:
        sketch.undo()
        states.append(sketch.loops)
    assert sketch.empty and len(states) == 1 + 14
    for state in states[-2::-1]:
        sketch.redo()
        assert sketch.loops == state
    assert not sketch.can_redo


def test_taking_back_opens_the_loop_then_takes_its_corners_then_the_hole():
    sketch = drawn(SQUARE, [(1, 1), (2, 1), (2, 2)])
    sketch.take_back()
    assert sketch.open and len(sketch.loops[1].corners) == 3
    for _ in range(4):
        sketch.take_back()
    assert sketch.loops == (PolygonLoop(tuple(SQUARE), True),)


def test_a_loop_of_fewer_than_three_corners_opens_or_is_removed():
    sketch = drawn(SQUARE, [(1, 1), (2, 1), (2, 2)], [(3, 3), (3.5, 3), (3, 3.5)])
    sketch.remove(1, 0)
    assert len(sketch.loops) == 2 and not sketch.open
    sketch.remove(1, 0)
    assert len(sketch.loops) == 2 and sketch.open


def test_a_repeated_corner_is_not_added():
    sketch = drawn([(1, 1)], close=False)
    sketch.add((1, 1))
    assert sketch.loops[0].corners == ((1, 1),)


def test_snapping_takes_points_first_then_angles_then_the_grid():
    snapper = Snapper(grid=0.1)
    assert snapper.snap((0.52, 0.49), 0.05, [(0.5, 0.5)]).met == "point"
    assert snapper.snap((0.52, 0.49), 0.05).place == (0.5, 0.5)
    level = snapper.snap((0.91, 0.27), 0.05, before=(0.3, 0.25))
    assert level.place == (0.9, 0.25) and level.met == "angle"
    assert level.guides == (((0.3, 0.25), (0.9, 0.25)),)
    square = snapper.snap((1.02, 0.03), 0.05, before=(1.0, 1.0), first=(0.0, 0.0))
    assert square.place == (1.0, 0.0) and len(square.guides) == 2
    slanted = Snapper().snap((0.02, 2.0), 0.05, before=(1, 1), behind=(0, 0))
    assert slanted.place == pytest.approx((0.01, 1.99))


def test_snapping_can_be_switched_off():
    off = Snapper(grid=0, points=False, angles=False)
    assert off.snap((0.123, 0.456), 1.0, [(0.1, 0.4)], before=(0, 0.45)).place == (0.123, 0.456)


def test_grid_places_are_short_decimals():
    assert Snapper(grid=0.1).snap((0.31, 0.69), 0.01).place == (0.3, 0.7)


PLACES = st.tuples(st.integers(0, 5), st.integers(0, 5))


def test_middles_of_segments_and_arcs():
    sketch = Sketch()
    for place, bulge in [((0.0, 0.0), 0.0), ((2.0, 0.0), 0.0), ((2.0, 2.0), 1.0)]:
        sketch.add(place, bulge)
    sketch.close()
    assert sketch.middles() == [(1.0, 0.0), (3.0, 1.0), (1.0, 1.0)]
    assert sketch.middles((0, 0)) == [(3.0, 1.0)]  # without the edges at the first corner
    snapper = Snapper()
    near = snapper.snap((2.98, 1.01), 0.05, [(2.0, 2.0)], middles=sketch.middles())
    assert (near.place, near.met) == ((3.0, 1.0), "middle")
    both = snapper.snap((1.0, 0.01), 0.05, [(1.0, 0.03)], middles=sketch.middles())
    assert both.met == "point"


@settings(max_examples=400)
@given(
    st.lists(PLACES, min_size=3, max_size=7, unique=True),
    st.lists(PLACES, min_size=3, max_size=4, unique=True),
)
def test_a_sketch_is_complete_exactly_if_it_is_a_domain(outline, hole):
    sketch = drawn(outline, hole)
    try:
        Domain(outline, [hole])
    except MeshError as error:
        assert not sketch.complete, error
    else:
        assert sketch.complete, sketch.words
