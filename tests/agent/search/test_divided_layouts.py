"""Layouts that are divided to be drawn."""

from __future__ import annotations

import numpy as np
from tests.helpers import curved_meshes
from tests.helpers.tiny_meshes import grid

from meshwright_agent.search import divided_layouts
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.divided_layouts import (
    FEW,
    LONGEST,
    collapse_chords,
    divide_chords,
    drawn_divided,
    ways_down,
)
from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.quality import inverted


def never() -> bool:
    """No time limit."""
    return False


def test_every_strip_is_divided_once():
    mesh = grid(3, 2)
    start = mesh.copy()
    operations = divide_chords(mesh)
    assert len(operations) == 5 and mesh.n_elements == 24
    assert replayed(start, operations).n_elements == 24
    mesh.validate()


def test_only_the_strips_through_some_elements_are_divided():
    mesh = grid(3, 2)
    operations = divide_chords(mesh, np.array([4]))
    assert len(operations) == 2 and mesh.n_elements == 4 * 3
    mesh.validate()


def test_strips_through_what_stays_inverted_are_divided_once_more(monkeypatch):
    left = [np.array([0]), np.array([], int)]
    monkeypatch.setattr(divided_layouts, "draw", lambda *_: left.pop(0))
    mesh = grid(3, 2)
    operations, drawn = drawn_divided(mesh, never, 1)
    assert drawn and not left
    assert len(operations) == 5 + 2 and mesh.n_elements == 7 * 5


def test_strips_through_many_inverted_elements_stay(monkeypatch):
    monkeypatch.setattr(divided_layouts, "draw", lambda *_: np.arange(FEW + 1))
    mesh = grid(3, 2)
    operations, drawn = drawn_divided(mesh, never, 1)
    assert not drawn and len(operations) == 5


def test_strips_are_collapsed_down_to_a_size():
    mesh = grid(5, 4)
    start = mesh.copy()
    operations = collapse_chords(mesh, 8, np.random.default_rng(0), lambda after: True)
    assert 1 < mesh.n_elements <= 8 and mesh.score <= start.score
    assert replayed(start, operations).n_elements == mesh.n_elements
    mesh.validate()


def test_a_collapse_that_is_not_usable_is_undone():
    mesh = grid(5, 4)
    before = mesh.elements()
    assert not collapse_chords(mesh, 8, np.random.default_rng(0), lambda after: False)
    np.testing.assert_array_equal(mesh.elements(), before)


def test_closed_strips_stay():
    mesh = curved_meshes.ring()
    before = mesh.n_elements
    divide_chords(mesh)
    mesh.validate()
    assert mesh.n_elements == 2 * before  # across the ring, not along it


def test_positions_without_meaning_are_found_again():
    mesh = mesh_domain(gallery.shape("plate-with-round-hole"), "quad")
    rng = np.random.default_rng(1)
    ids = mesh.vertices()[mesh.curve_ids()[mesh.vertices()] < 0]
    size = np.ptp(mesh.points[mesh.vertices()], axis=0).max()
    places = mesh.points[ids] + 0.1 * size * np.array([1.0, 1.0, 0.0]) * rng.normal(
        size=(len(ids), 3)
    )
    mesh.move(ids, places)
    assert len(inverted(mesh))
    before, score = mesh.n_elements, mesh.score
    operations, drawn = drawn_divided(mesh, never, 3)
    assert drawn and not len(inverted(mesh))
    assert operations and mesh.n_elements >= 2 * before and mesh.score == score


def test_ways_down_reach_their_goal():
    mesh = mesh_domain(gallery.shape("star"), "quad")
    ways = ways_down(mesh, mesh.optimum, np.random.default_rng(0), never)
    assert ways and [len(way) for way in ways] == sorted(len(way) for way in ways)
    for way in ways:
        assert len(way) <= LONGEST and replayed(mesh, way).score == mesh.optimum
    assert not ways_down(mesh, mesh.optimum, np.random.default_rng(0), lambda: True)
