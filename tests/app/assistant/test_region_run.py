"""A run in a region, from assistant to document: nothing outside changes, not even places."""

import threading

import numpy as np
import pytest

from meshwright.assistant.assistant import Assistant
from meshwright.assistant.search_runner import Effort
from meshwright.document.document import Document
from meshwright_core.analysis.submesh import enclose
from meshwright_core.core.arrays import ORIGIN
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry.movable_part import rings

pytestmark = pytest.mark.slow


@pytest.fixture(params=["quad", "tri"])
def document(request):
    domain = gallery.random_polygon(14, np.random.default_rng(7))
    return Document(meshing.mesh_domain(domain, request.param, max_edge=0.16))


@pytest.fixture
def assistant(document, desk):
    made = Assistant(document, desk.dispatch)
    made.policy = document.kind
    made.heard = []
    made.message.connect(made.heard.append)
    made.failed.connect(made.heard.append)
    yield made
    made.close()
    for thread in threading.enumerate():
        if thread.name.startswith("assistant"):
            thread.join(30)


def around_the_middle(mesh, reach):
    irregular = np.flatnonzero(mesh.irregularity())
    centre = mesh.points[mesh.vertices()].mean(axis=0)
    away = np.linalg.norm(mesh.points[irregular] - centre, axis=1)
    chosen = rings(mesh, irregular[[int(away.argmin())]], reach)
    return mesh.element_ids()[np.isin(mesh.elements(), chosen).all(axis=1)]


def test_a_region_is_finished_and_the_rest_stays_to_the_bit(document, assistant, desk):
    mesh = document.mesh
    elements = around_the_middle(mesh, 3)
    inside = enclose(mesh, elements)
    outer = np.setdiff1d(mesh.element_ids(), elements)
    halfedges = mesh.halfedges_of(outer).ravel()
    ends = mesh.arrays.edge[halfedges, ORIGIN].copy()
    places = mesh.points[inside.held].copy()
    start, points, flags = document.score, mesh.points.copy(), mesh.arrays.vertex.copy()

    assistant.search(Effort(rollouts=16, seconds=None, elements=elements))
    desk.until(lambda: not assistant.running, seconds=120.0)

    assert document.score < start and assistant.heard[-1].startswith("The region is finished")
    assert np.array_equal(mesh.arrays.edge[halfedges, ORIGIN], ends)
    assert np.array_equal(mesh.points[inside.held], places)
    assert not mesh.locked().any()
    mesh.validate()
    document.go_to(0)
    assert np.array_equal(mesh.points[: len(points)], points)
    assert np.array_equal(mesh.arrays.vertex[: len(flags)], flags[: len(mesh.arrays.vertex)])


def test_an_interrupted_run_leaves_no_vertex_locked(document, assistant, desk):
    elements = around_the_middle(document.mesh, 3)
    assistant.search(Effort(rollouts=16, seconds=None, elements=elements))
    desk.until(lambda: document.history.cursor > 0, seconds=120.0)
    assistant.cancel()
    done = document.history.cursor
    desk.work()
    assert document.history.cursor == done and not document.mesh.locked().any()
    document.mesh.validate()


def test_a_region_in_which_nothing_is_free_is_refused_in_words(document, assistant):
    assistant.search(Effort(elements=document.mesh.element_ids()[:1]))
    assert not assistant.running
    assert "No vertex lies inside this region" in assistant.heard[-1]
