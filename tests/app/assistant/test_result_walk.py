"""The way to the result of a search: in slices, skipped, stopped, and never to a worse mesh."""

from types import SimpleNamespace

import numpy as np
import pytest

from meshwright.assistant import result_walk
from meshwright.assistant.outcome import result_of
from meshwright.assistant.result_walk import ResultWalk
from meshwright.document.document import Document
from meshwright_core.geometry.quality import inverted
from meshwright_core.geometry.smoothing import relax


@pytest.fixture
def result(star, greedy):
    """A document, operations that lead to s*, and the mesh that they lead to."""
    runner = greedy(star)
    operations = []
    while not runner.finished:
        operations += runner.step()
    target = star.copy()
    for operation, halfedge in operations:
        target.apply(operation, halfedge)
    relax(target)
    return Document(star), operations, target


def test_the_result_has_the_positions_that_it_was_judged_by(result):
    document, operations, target = result
    walk = ResultWalk(document, "agent", operations, None, target)
    while not walk.arrived:
        walk.advance()
    assert walk.settle()
    ids = document.mesh.vertices()
    assert np.array_equal(document.mesh.points[ids], target.points[ids])
    assert [row.action for row in document.history][: len(operations)] == [
        operation.value for operation, _ in operations
    ]
    assert document.history.last.title == "Positions"
    assert {row.by for row in document.history} == {"agent"}


def test_skipping_leads_to_the_same_result_with_one_event(result):
    document, operations, target = result
    changes = []
    walk = ResultWalk(document, "agent", operations, None, target)
    document.changed.connect(lambda: changes.append(document.score))
    walk.skip()
    assert walk.settle()
    assert changes == [target.score] * 2  # the operations, and the positions
    ids = target.vertices()
    assert np.array_equal(document.mesh.points[ids], target.points[ids])


def test_a_stopped_walk_keeps_the_rest_in_the_history(result, monkeypatch):
    document, operations, target = result
    monkeypatch.setattr(result_walk, "SLICE", -1.0)
    monkeypatch.setattr(result_walk, "LONGEST", -1.0)
    walk = ResultWalk(document, "agent", operations, None, target)
    walk.advance()
    walk.advance()
    here = walk.done
    assert here == 2 < len(operations)
    assert walk.stop_here()
    assert document.history.cursor == here
    document.go_to(len(document.history))
    ids = target.vertices()
    assert np.array_equal(document.mesh.points[ids], target.points[ids])


def test_a_result_that_would_be_inverted_is_taken_back(result, monkeypatch):
    document, operations, target = result
    inner = np.flatnonzero(~target.boundary() & (target.degree() > 0))[:1]
    target.move(inner, target.points[inner] + (5.0, 0.0, 0.0))
    assert len(inverted(target))
    monkeypatch.setattr(document, "smooth", lambda *_: None)
    walk = ResultWalk(document, "agent", operations, None, target)
    walk.skip()
    assert not walk.settle()
    assert document.history.cursor == 0 and not len(inverted(document.mesh))
    assert len(document.history) > len(operations)  # it can be looked at all the same


def test_on_a_surface_that_is_not_smoothed_the_way_ends_before_elements_are_inverted(
    result, monkeypatch
):
    document, operations, target = result
    monkeypatch.setattr(type(document), "plane", property(lambda self: False))
    walk = ResultWalk(document, "agent", operations, None, target)
    walk.skip()
    assert len(inverted(document.mesh))
    assert walk.settle()
    assert not len(inverted(document.mesh))
    assert document.history.cursor < len(document.history) == len(operations)
    said, unfinished = result_of(
        document, SimpleNamespace(effort=None, runner=None, held=None), "", True, False
    )
    assert unfinished and said.endswith("elements, and can be redone.")
    document.redo()
    assert len(inverted(document.mesh))
