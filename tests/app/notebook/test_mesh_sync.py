"""State and patch messages: a replica that applies them equals the mesh."""

import curved_meshes
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from porting import CURVE_TYPES, TYPES, Replica, allowed

from meshwright.document.document import Document
from meshwright.notebook.protocol.document_status import DocumentStatus
from meshwright.notebook.protocol.mesh_sync import (
    ALIVE,
    ANCHOR,
    BOUNDARY,
    CORNER,
    FIXED,
    CoordinateFrame,
    MeshSync,
    SlotArrays,
)
from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import gallery, meshing
from meshwright_core.geometry.quality import inverted
from meshwright_core.operations.catalogue import of_kind


def follow(mesh: HalfEdgeMesh) -> tuple[MeshSync, Replica]:
    sync, replica = MeshSync(), Replica()
    sync.reset(mesh)
    replica.take(sync.state())
    return sync, replica


def test_a_state_holds_the_mesh(strip):
    sync, replica = follow(strip)
    assert sync.state().content["frame"] == {"cx": 1.0, "cy": 0.5, "scale": 1.0}
    assert replica.slots.places.tolist() == [
        [-1, -0.5],
        [0, -0.5],
        [1, -0.5],
        [-1, 0.5],
        [0, 0.5],
        [1, 0.5],
    ]
    assert replica.slots.origin.tolist() == [0, 1, 4, 3, 1, 2, 5, 4]
    assert replica.slots.twin.tolist() == [-1, 7, -1, -1, -1, -1, -1, 1]
    corner, side = ALIVE | BOUNDARY | CORNER, ALIVE | BOUNDARY
    assert replica.slots.flags.tolist() == [corner, side, corner, corner, side, corner]
    assert replica.shows(strip, sync.frame)


def test_a_patch_holds_the_differences(star):
    sync, replica = follow(star)
    star.set_locked(3)
    packet = sync.patch(star)
    assert [len(b) for b in packet.buffers] == [4, 8, 1, 1, *8 * [0]]
    replica.take(packet)
    assert replica.slots.flags[3] & FIXED
    nothing = sync.patch(star)
    assert nothing.size == 0 and nothing.content["to"] == packet.content["to"] + 1


def test_slots_freed_by_undo_stay_as_dead_slots(strip):
    sync, replica = follow(strip)
    strip.apply("global_split", allowed(strip, ("global_split",))[1])
    replica.take(sync.patch(strip))
    grown = len(replica.slots.flags)
    assert grown > 6 and replica.shows(strip, sync.frame)
    strip.undo()
    replica.take(sync.patch(strip))
    assert len(replica.slots.flags) == grown
    assert replica.slots.flags[6:].tolist() == [0] * (grown - 6)
    assert set(replica.slots.origin[8:].tolist()) == {-1}
    assert replica.shows(strip, sync.frame)


def test_a_patch_larger_than_the_state_is_the_state(star):
    sync, replica = follow(star)
    live = star.vertices()
    star.move(live, star.points[live] + 0.1)
    assert sync.patch(star).content["type"] == "patch"  # all vertices, but no half-edge
    other = meshing.mesh_domain(gallery.shape("l-shape"), "quad")
    packet = sync.patch(other)
    assert packet.content["type"] == "state"
    replica.take(packet)
    assert replica.shows(other, sync.frame)


def test_the_state_of_no_mesh_is_empty(star):
    sync = MeshSync()
    sync.reset(None)
    assert sync.state().content["vertices"] == 0 and sync.patch(None).size == 0
    sync.reset(star)
    assert sync.state().content["vertices"] == star.slots


@pytest.mark.parametrize("kind", ["quad", "tri"])
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_a_replica_follows_random_edits(kind, data):
    mesh = meshing.mesh_domain(gallery.shape("l-shape"), kind)
    document = Document(mesh)
    sync, replica = follow(mesh)
    status = DocumentStatus(document)
    status.reset()
    replica.scores = status.full()["track"]["scores"]
    names = [info.operation for info in of_kind(kind)]
    for _ in range(data.draw(st.integers(1, 12))):
        act = data.draw(st.sampled_from(["operate", "operate", "operate", "go", "lock", "smooth"]))
        if act == "operate":
            operation = data.draw(st.sampled_from(names))
            halfedge = data.draw(st.integers(0, mesh.k * int(mesh.element_ids()[-1]) + 3))
            if mesh.check(operation, halfedge):
                document.submit(operation, halfedge)
        elif act == "go":
            document.go_to(data.draw(st.integers(0, len(document.history))))
        elif act == "lock":
            document.set_locked(int(data.draw(st.sampled_from(mesh.vertices().tolist()))), True)
        else:
            document.smooth()
        if data.draw(st.booleans()):
            continue  # several changes may travel in one patch
        replica.take(sync.patch(mesh))
        sent = status.update()
        replica.scores[sent["track"]["from"] :] = sent["track"]["scores"]
        assert replica.shows(mesh, sync.frame)
        assert sent["inverted"] == len(inverted(mesh))
        scores = [document.history.first[0], *(row.after for row in document.history)]
        assert replica.scores[: sent["length"] + 1] == scores
        assert sent["score"] == scores[sent["cursor"]]


def test_bytes_of_a_local_operation_do_not_grow_with_the_mesh():
    sizes = []
    for edge in (0.2, 0.065):
        mesh = meshing.mesh_domain(gallery.shape("square"), "quad", max_edge=edge)
        document = Document(mesh)
        sync, _ = follow(mesh)
        largest = 0
        for element in mesh.element_ids()[:: max(1, mesh.n_elements // 12)].tolist():
            if mesh.live(4 * element) and mesh.check("flip_left", 4 * element):
                document.submit("flip_left", 4 * element)
                largest = max(largest, sync.patch(mesh).size)
        sizes.append((mesh.n_elements, largest))
    (small, few), (large, many) = sizes
    assert large > 5 * small and 0 < many < 4 * few


def test_a_state_holds_curves_regions_and_anchors():
    mesh = curved_meshes.insert()
    sync, replica = follow(mesh)
    packet, frame = sync.state(), sync.frame
    assert packet.content["regions"] == list(curved_meshes.INSERT)
    assert replica.slots.region.tolist() == [1] * 5 + [0] * 4
    assert replica.slots.curve.tolist() == [-1] * 4 + [1] * 4 + [0] * 4
    np.testing.assert_array_equal(replica.slots.parameter, mesh.arrays.parameter[: mesh.slots])
    buffers = zip(packet.buffers[len(TYPES) :], CURVE_TYPES, strict=True)
    control, first, start, stop, spans, closed, interfaces = (
        np.frombuffer(buffer, kind) for buffer, kind in buffers
    )
    curves = mesh.boundary_info.curves
    x, y, weight = control.reshape(-1, 3).T
    np.testing.assert_allclose(frame.scale * x + frame.cx * weight, curves.control[:, 0])
    np.testing.assert_allclose(frame.scale * y + frame.cy * weight, curves.control[:, 1])
    for sent, true in (
        (weight, curves.control[:, 3]),
        (first, curves.first_control),
        (start, curves.start),
        (stop, curves.stop),
        (spans, curves.first_span),
        (closed, curves.closed),
        (interfaces.reshape(-1, 4), mesh.boundary_info.table()),
    ):
        np.testing.assert_array_equal(sent, true)
    plate = curved_meshes.plate()
    _, replica = follow(plate)
    anchors = np.flatnonzero(replica.slots.flags & ANCHOR)
    places = np.sort(np.abs(plate.points[anchors, :2]))
    assert len(anchors) == 8 and (places == (3.0, 4.0)).all()  # the ends of the fillets


@pytest.mark.parametrize("name", ["disc", "ring", "plate", "insert"])
def test_a_replica_follows_edits_along_curves(name):
    mesh = getattr(curved_meshes, name)()
    document = Document(mesh)
    sync, replica = follow(mesh)
    rng = np.random.default_rng(3)
    names = [info.operation for info in of_kind("quad")]
    for _ in range(300):
        operation = names[rng.integers(len(names))]
        halfedge = 4 * int(rng.choice(mesh.element_ids())) + int(rng.integers(4))
        if mesh.check(operation, halfedge):
            document.submit(operation, halfedge)
            packet = sync.patch(mesh)
            replica.take(packet)
            assert replica.shows(mesh, sync.frame)
        if len(document.history) == 12:
            break
    assert document.history
    document.go_to(0)
    replica.take(sync.patch(mesh))
    assert replica.shows(mesh, sync.frame)


def test_a_patch_inside_has_no_bytes_for_curves(star):
    sync, _ = follow(star)
    inside = star.vertices()[~star.boundary()[star.vertices()]][:1]
    star.move(inside, star.points[inside] + 1e-3)
    assert [len(b) for b in sync.patch(star).buffers] == [4, 8, 1, 1, *8 * [0]]


def test_coordinates_are_normalised_at_any_position_and_scale(star):
    star.move(star.vertices(), star.points[star.vertices()] * 1e6 + (3e8, -2e8, 0))
    frame = CoordinateFrame.of(star)
    places = SlotArrays.of(star, frame).places
    assert np.abs(places).max() == pytest.approx(1.0)
    assert np.abs(frame.normalised(star.points) - places).max() < 1e-6
