"""Domains: one orientation, corners, JSON, and a clear sentence for each kind of bad polygon."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshwright_core import MeshError
from meshwright_core.domains import gallery
from meshwright_core.domains.domain import Domain, turning_angles

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def refusal(*args, **kwargs) -> str:
    with pytest.raises(MeshError) as error:
        Domain(*args, **kwargs)
    message = str(error.value)
    assert "\n" not in message
    return message


def test_orientation_is_the_same_whichever_way_the_rings_are_given():
    flags = [True, False, False, True]
    hole = SQUARE * 0.2 + 0.4
    one = Domain(SQUARE, [hole[::-1]], corners=flags, hole_corners=[flags[::-1]])
    other = Domain(SQUARE[::-1], [hole], corners=flags[::-1], hole_corners=[flags])
    for domain in (one, other):
        assert domain.area == pytest.approx(0.96)
        assert sorted(map(tuple, domain.outline[domain.corners])) == [(0, 0), (0, 1)]
        hole_marks = domain.holes[0][domain.hole_corners[0]]
        assert np.allclose(sorted(map(tuple, hole_marks)), [(0.4, 0.4), (0.4, 0.6)])


def test_corners_are_where_the_boundary_turns():
    outline = np.insert(SQUARE, 1, [0.5, 0.0], axis=0)
    assert Domain(outline).corners.tolist() == [True, False, True, True, True]
    assert not Domain(outline, corner_angle=120).corners.any()
    assert turning_angles(SQUARE) == pytest.approx([90] * 4)


def test_closed_ring_loses_its_last_point():
    closed = np.vstack([SQUARE, SQUARE[:1]])
    domain = Domain(closed, corners=[True, False, True, False, True])
    assert domain.outline.tolist() == SQUARE.tolist()
    assert domain.corners.tolist() == [True, False, True, False]


def test_arrays_are_read_only_and_own_their_data():
    points = SQUARE.copy()
    domain = Domain(points)
    points[0] = 9
    assert domain.outline[0].tolist() == [0, 0]
    with pytest.raises(ValueError, match="read-only"):
        domain.outline[0] = 1


@pytest.mark.parametrize(
    ("outline", "expected"),
    [
        ([], ["outline has 0 points", "at least 3"]),
        ([[0, 0], [1, 0]], ["outline has 2 points", "at least 3"]),
        ([[0, 0], [1, 1], [1, 0], [0, 1]], ["itself", "(0.5, 0.5)", "0-1", "2-3"]),
        ([[0, 0], [2, 0], [2, 2], [1, 0], [0, 2]], ["itself", "(1, 0)"]),
        ([[0, 0], [1, 0], [0.5, 0], [0.5, 1]], ["itself", "0-1", "1-2"]),
        ([[0, 0], [1, 0], [np.nan, 1]], ["Point 2 of the outline", "nan"]),
        ([[0, 0], [np.inf, 0], [1, 1]], ["Point 1 of the outline", "inf"]),
        ([[0, 0], [1, 0], [1, 0], [0, 1]], ["Points 1 and 2", "same", "(1, 0)"]),
        ([[0, 0], [1, 0], [1, 1], [1, 0], [0, 1]], ["Points 1 and 3", "same"]),
        ([[0, 0], [1e-13, 0], [1, 0], [0, 1]], ["Points 0 and 1", "nearly the same"]),
        ([[0, 0], [1, 1], [2, 2]], ["no area", "one line"]),
        (SQUARE * 1e-150, ["no area"]),
        ("square", ["outline", "pairs of numbers"]),
        ([[0, 0, 0]] * 4, ["outline", "pairs of numbers"]),
        ([0, 1, 2, 3], ["outline", "pairs of numbers"]),
    ],
)
def test_bad_outline(outline, expected):
    message = refusal(outline)
    assert all(part in message for part in expected), message


@pytest.mark.parametrize(
    ("holes", "expected"),
    [
        ([SQUARE * 0.2 + 4], ["Hole 0", "outside", "(4, 4"]),
        ([SQUARE * 3 - 1], ["Hole 0", "outside", "around it"]),
        ([SQUARE * 0.5 + 0.7], ["Hole 0", "the outline", "near (1, 0.7)"]),
        ([SQUARE * 0.2 + 0.8], ["Hole 0", "touches", "the outline"]),
        ([SQUARE * 0.2 + 0.4, SQUARE * 0.2 + 0.5], ["Hole 1", "hole 0", "near"]),
        ([SQUARE * 0.5 + 0.2, SQUARE * 0.1 + 0.4], ["Hole 1", "inside hole 0"]),
        ([SQUARE[:2] * 0.1 + 0.5], ["Hole 0 has 2 points"]),
    ],
)
def test_bad_hole(holes, expected):
    message = refusal(SQUARE, holes)
    assert all(part in message for part in expected), message


def test_flags_must_fit():
    assert "4 true or false" in refusal(SQUARE, corners=[True] * 3)
    assert "4 true or false" in refusal(SQUARE, corners=[1, 0, 1, 0])
    assert "1 lists of hole corners for 0 holes" in refusal(SQUARE, hole_corners=[[True]])


def same_content(one, other):
    """Whether two JSON values are the same; angles of arcs pass through degrees and back."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same_content(one[k], other[k]) for k in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(same_content, one, other))
    if isinstance(one, float):
        return one == pytest.approx(other, rel=1e-12, abs=1e-12)
    return one == other


@pytest.mark.parametrize("name", gallery.names())
def test_json_round_trip(name, tmp_path):
    domain = gallery.shape(name)
    path = tmp_path / "domain.json"
    path.write_text(json.dumps(domain.to_json()))
    for again in (Domain.from_json(path), Domain.from_json(domain.to_json())):
        assert same_content(again.to_json(), domain.to_json())


def test_json_takes_its_name_from_the_file_if_it_has_none(tmp_path):
    path = tmp_path / "plate.json"
    path.write_text(json.dumps({"outline": SQUARE[::-1].tolist()}))
    assert Domain.from_json(path).name == "plate"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", ["empty"]),
        ('{"outline": [[0, 0], [1, 0],\n[0, 1]}', ["line 2", "not JSON"]),
        ("[1, 2]", ["outline"]),
        ('{"holes": []}', ['no "outline"']),
        ('{"outline": 3}', ["outline is not a list"]),
        ('{"outline": [[0, 0], [1, "a"], [1, 1]]}', ["Point 1 of the outline", "'a'"]),
        ('{"outline": [[0, 0], [1, true], [1, 1]]}', ["Point 1 of the outline", "True"]),
        ('{"outline": [[0, 0], [1, NaN], [1, 1]]}', ["Point 1 of the outline", "nan"]),
        ('{"outline": [[0, 0], [1, 0], [1, 1' + "0" * 400 + "]]}", ["Point 2", "too large"]),
        ('{"outline": [[0, 0], [1, 0], [1, 1]], "holes": 3}', ["holes"]),
        ('{"outline": [[0, 0], [1, 0], [1, 1]], "holes": [[[0, 0]]]}', ["Hole 0 has 1 point,"]),
        ('{"outline": [[0, 0], [1, 0], [1, 1]], "corners": [true]}', ["corners of the outline"]),
        ('{"outline": [[0, 0], [1, 0], [1, 1]], "hole_corners": 5}', ["hole_corners"]),
        ('{"outline": [[0, 0], [1, 0], [1, 1]], "name": 5}', ["name"]),
        ("[" * 100_000, ["too deep"]),
    ],
)
def test_bad_json_file(text, expected, tmp_path):
    path = tmp_path / "bad.json"
    path.write_text(text)
    with pytest.raises(MeshError) as error:
        Domain.from_json(path)
    message = str(error.value)
    assert message.startswith(str(path))
    assert "\n" not in message
    assert all(part in message for part in expected), message


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(MeshError, match="no such file"):
        Domain.from_json(tmp_path / "missing.json")
    with pytest.raises(MeshError, match="folder"):
        Domain.from_json(tmp_path)
    (tmp_path / "picture.json").write_bytes(b"\x89PNG\xff\x00")
    with pytest.raises(MeshError, match="not a text file"):
        Domain.from_json(tmp_path / "picture.json")


@given(st.integers(3, 40), st.integers(0, 2**32 - 1), st.booleans())
def test_random_polygons_are_domains(sides, seed, turned):
    corners = gallery.random_corners(sides, np.random.default_rng(seed))
    domain = Domain(corners[::-1] if turned else corners)
    assert domain.area == pytest.approx(domain.polygon.area)
    assert 0 < domain.area < np.pi
    assert 0.5 < domain.diameter <= 2.0
    assert len(domain.outline) == sides


@pytest.mark.parametrize("count", [3, 4, 5, 24, 101])
def test_diameter_is_the_largest_of_all_distances(count):
    angle = 2 * np.pi * np.arange(count) / count
    for outline in (
        np.column_stack([np.cos(angle), np.sin(angle)]),
        np.column_stack([3 * np.cos(angle + 0.3), np.sin(angle)]),
        gallery.random_corners(count, np.random.default_rng(count)),
    ):
        apart = outline[:, None] - outline[None]
        assert Domain(outline).diameter == np.sqrt((apart**2).sum(-1)).max()


def test_diameter_of_a_fine_circle_takes_little_memory():
    angle = 2 * np.pi * np.arange(20_000) / 20_000
    assert Domain(np.column_stack([np.cos(angle), np.sin(angle)])).diameter == pytest.approx(2)
