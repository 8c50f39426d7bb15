"""Sessions: requests, patches, the agent, and the end of a session."""

import gc
import threading
import time
import weakref

import curved_meshes
import numpy as np
import pytest
from porting import Port, allowed, script_agent

from meshwright.assistant.assistant import State
from meshwright.document import operation_preview
from meshwright.document.document import Document
from meshwright.notebook import thread_loop as loops
from meshwright.notebook.protocol import broadcaster, requests
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.notebook.session import Session
from meshwright_core import MeshError


@pytest.fixture(autouse=True)
def scripted(monkeypatch, greedy):
    script_agent(monkeypatch, greedy)


@pytest.fixture
def session(star):
    return Session.of(Document(star, "star"))


@pytest.fixture
def port(session):
    made = Port(session)
    made.ask("hello")
    yield made
    made.close()


def frame(port):
    return port.session.broadcaster.mesh_sync.frame


def workers() -> int:
    return sum(thread.name == "assistant" for thread in threading.enumerate())


def until(condition, seconds=10.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_hello_is_answered_with_state_and_agent(session):
    port = Port(session)
    state, agent = port.ask("hello")
    assert (state["type"], state["reply"], state["to"]) == ("state", 1, "v")
    assert state["read_only"] is False and state["k"] == 4
    assert [entry["key"] for entry in state["catalogue"]] == list("FRSCGXVIY")
    head = state["head"]
    assert (head["score"], head["optimum"], head["elements"]) == (12, 4, 24)
    track = head["track"]
    assert (track["from"], track["scores"], track["optima"]) == (0, [12], [4])
    assert track["titles"] == ["Start"]
    assert head["row"] is None and head["name"] == "star" and head["blocks"] == 24
    assert agent["state"] == "idle" and agent["policy"] == "quad"
    assert agent["policies"][0]["name"] == "quad"
    port.close()


def test_nothing_is_sent_before_the_first_view(session):
    port = Port(session)
    session.document.submit(*allowed(session.mesh))
    assert port.packets == []
    port.close()


def test_operate_undo_redo_and_go_to(port):
    mesh = port.session.mesh
    first = port.replica.slots.buffers
    operation, halfedge = allowed(mesh)
    [patch] = port.operate(operation, halfedge)
    assert (patch["type"], patch["reply"], patch["asked"]) == ("patch", 2, "v")
    assert patch["head"]["row"]["operation"] == operation and patch["head"]["cursor"] == 1
    assert patch["head"]["track"]["titles"][-1] == "Flip left"
    assert port.replica.shows(mesh, frame(port))
    port.ask("undo")
    assert port.sentence == "Undone: Flip left."
    assert port.replica.slots.buffers == first
    port.ask("redo")
    assert port.replica.shows(mesh, frame(port))
    port.operate(*allowed(mesh))
    track = port.of("patch")[-1]["head"]["track"]
    assert track["from"] == 2 and len(track["scores"]) == 1  # only what is new
    port.ask("go_to", cursor=0)
    assert port.replica.slots.buffers == first
    port.ask("undo")
    assert port.sentence == "There is nothing to undo."


def test_a_click_on_a_changed_half_edge_is_refused(port):
    mesh = port.session.mesh
    operation, halfedge = allowed(mesh)
    ends = [mesh.target(halfedge), mesh.origin(halfedge)]
    port.ask("operate", operation=operation, halfedge=halfedge, ends=ends)
    assert port.of("notice")[-1]["tone"] == "refused" and "in the meantime" in port.sentence
    assert len(port.session.document.history) == 0


def test_a_refused_operation_says_why(port):
    mesh = port.session.mesh
    edge = next(h for h in range(96) if mesh.twin(h) < 0)
    port.operate("flip_left", edge)
    assert port.sentence.startswith("The edge ") and port.sentence.endswith("on the boundary.")


def test_hover_shows_the_best_or_the_armed_operation(port):
    mesh = port.session.mesh
    seen = []
    port.session.document.hover_changed.connect(seen.append)
    operation, halfedge = allowed(mesh)
    [ghost] = port.ask("hover", halfedge=halfedge, operation=operation)
    assert (ghost["type"], ghost["halfedge"], ghost["operation"]) == ("ghost", halfedge, operation)
    assert ghost["reply"] == 2 and ghost["to"] == "v"
    offer = next(entry for entry in ghost["offers"] if entry["operation"] == operation)
    assert offer["allowed"] and offer["change"] == ghost["change"] and offer["reason"] == ""
    added, removed, gone, places, delta = port.packets[-1].buffers
    assert len(added) == len(removed) == 16 and gone == b""
    assert len(places) == 8 * len(delta)
    [best] = port.ask("hover", halfedge=halfedge, operation=None)
    changes = [entry["change"] for entry in best["offers"] if entry["allowed"]]
    assert best["change"] in changes
    refused = next(entry for entry in ghost["offers"] if not entry["allowed"])
    [none] = port.ask("hover", halfedge=halfedge, operation=refused["operation"])
    assert none["operation"] is None and none["change"] is None
    assert port.packets[-1].buffers == [b""] * 5
    [away] = port.ask("hover", halfedge=-1, operation=None)
    assert away["halfedge"] == -1 and away["offers"] == []
    assert seen == [halfedge, -1]


def test_previews_follow_curves():
    mesh = curved_meshes.plate()
    port = Port(Session.of(Document(mesh)))
    port.ask("hello")
    points = {}
    for tolerance in (1e-2, 1e-4):
        [ghost] = port.ask("hover", halfedge=0, operation="chord_collapse", tolerance=tolerance)
        assert ghost["operation"] == "chord_collapse"
        removed = np.frombuffer(port.packets[-1].buffers[1], "<f4").reshape(-1, 2, 2)
        scale = frame(port).scale
        plain = np.abs(removed * scale).reshape(-1, 2)
        # the rounded corners have their centres at (3, 3) and radius 1
        fillet = plain[(plain > 3.0).all(axis=1)]
        away = np.abs(np.hypot(*(fillet - 3.0).T) - 1.0)
        assert len(fillet) and away.max() < 1e-6
        points[tolerance] = len(removed)
    whole = operation_preview.ghost(mesh, "chord_collapse", 0).removed
    assert points[1e-4] > points[1e-2] > len(whole)
    assert port.ask("hover", halfedge=0, operation=None, tolerance=0.0)[0]["type"] == "notice"


def test_only_the_last_of_queued_hovers_of_a_view_is_answered(port, monkeypatch):
    monkeypatch.setattr(loops.ThreadLoop, "here", property(lambda self: False))
    port.packets.clear()
    for halfedge in (4, 5, 6):
        port.ask("hover", halfedge=halfedge, operation=None)
    monkeypatch.undo()
    port.session.loop.drain()
    assert [ghost["halfedge"] for ghost in port.of("ghost")] == [6]


def test_messages_from_another_thread_are_handled_in_the_owners(port):
    operation, halfedge = allowed(port.session.mesh)
    seen = []
    port.session.document.changed.connect(lambda: seen.append(threading.get_ident()))
    thread = threading.Thread(target=lambda: port.operate(operation, halfedge))
    thread.start()
    thread.join(5)
    assert seen == []
    port.session.loop.drain()
    assert seen == [threading.get_ident()]
    assert port.replica.shows(port.session.mesh, frame(port))


def test_desired_degrees_locks_and_corners(port):
    document, mesh = port.session.document, port.session.mesh
    vertex = int(mesh.vertices()[-1])
    port.ask("desired", vertex=vertex, degree=7)
    assert mesh.desired()[vertex] == 7
    assert port.of("patch")[-1]["head"]["optimum"] == document.optimum
    port.ask("lock", vertex=vertex, on=True)
    port.ask("corner", vertex=vertex, on=True)
    assert mesh.locked()[vertex] and mesh.geometric()[vertex]
    assert port.replica.shows(mesh, frame(port)) and len(document.history) == 3
    before = len(port.packets)
    assert port.ask("lock", vertex=vertex, on=True) == []  # it was locked already
    assert len(port.packets) == before


def test_the_whole_mesh(port):
    port.ask("smooth")
    assert port.sentence == "Smoothed."
    port.ask("untangle")
    assert port.sentence == "No element is inverted."
    port.ask("clean_all")
    assert "line" in port.sentence
    port.ask("auto_smooth", on=False)
    assert port.of("patch")[-1]["head"]["auto_smooth"] is False
    assert port.session.document.auto_smooth is False
    assert port.replica.shows(port.session.mesh, frame(port))


def test_two_ports_stay_synchronised_and_previews_go_to_one(port, star):
    other = Port(port.session, "w")
    other.ask("hello")
    port.operate(*allowed(star))
    other.ask("undo")
    port.session.document.submit(*allowed(star))
    port.ask("hover", halfedge=4, operation=None)
    for one in (port, other):
        assert one.replica.shows(star, frame(port))
        assert one.score == star.score
    assert port.of("ghost") and not other.of("ghost")
    assert other.replica.revision == port.replica.revision
    other.close()
    before = len(other.packets)
    port.ask("undo")
    assert len(other.packets) == before


def test_a_late_view_starts_in_the_present_state(port, star):
    port.operate(*allowed(star))
    late = Port(port.session, "late")
    state = late.ask("hello")[0]
    assert state["revision"] == port.replica.revision
    assert late.replica.scores == port.replica.scores
    port.ask("undo")
    assert late.replica.shows(star, frame(port))
    late.close()


def test_a_read_only_view_is_refused_edits(session, star):
    port = Port(session, read_only=True)
    assert port.ask("hello")[0]["read_only"] is True
    assert port.ask("hover", halfedge=4, operation=None)[0]["type"] == "ghost"
    port.operate(*allowed(star))
    assert port.sentence == "This view is read-only."
    session.document.submit(*allowed(star))
    assert port.replica.shows(star, frame(port))
    port.close()


def test_another_mesh_is_a_new_state_for_all(port, triangles):
    port.packets.clear()
    port.session.document.replace(triangles, "other")
    [state], agent = port.of("state"), port.of("agent")[-1]
    assert (state["type"], state["k"], "reply" in state) == ("state", 3, False)
    assert agent["policy"] in [entry["name"] for entry in agent["policies"]]
    assert agent["policy"] != "quad"
    assert port.replica.shows(triangles, frame(port)) and not port.of("patch")
    port.session.document.replace(None)
    assert port.replica.slots.flags.size == 0
    port.ask("undo")
    port.ask("smooth")
    assert "There is no mesh yet" in port.sentence


def test_frequent_changes_are_merged_and_the_last_one_arrives(port, star, monkeypatch):
    monkeypatch.setattr(type(port.session.loop), "running", property(lambda self: True))
    monkeypatch.setattr(broadcaster, "PACE", 1e9)
    operation, halfedge = allowed(star)
    for count in range(1, 40):
        port.session.document.submit(operation, halfedge)
        if count < 5:
            assert port.replica.shows(star, frame(port))  # a few are seen at once
        port.session.document.undo()
    assert len(port.of("patch")) <= broadcaster.BURST
    port.session.document.submit(operation, halfedge)
    port.session.loop.drain()
    assert port.replica.shows(star, frame(port))


def test_the_agent_steps_plays_pauses_and_hints(port, star):
    session = port.session
    port.ask("agent", action="step")
    assert session.wait(10) and session.assistant.state is State.PAUSED
    assert session.document.history.last.by == "quad" and port.replica.shows(star, frame(port))
    port.ask("speed", value=50)
    assert port.of("agent")[-1]["speed"] == 50
    port.ask("agent", action="play")
    assert port.of("agent")[-1]["state"] == "playing"
    session.loop.pump(lambda: session.document.history.cursor > 1, 10)
    port.ask("agent", action="pause")
    assert port.of("agent")[-1]["state"] == "paused"
    port.ask("undo")
    port.ask("agent", action="hint")
    assert session.wait(10)
    received = port.of("agent")[-1]
    assert received["hints"] and set(received["hints"][0]) == {
        "operation",
        "title",
        "halfedge",
        "probability",
        "change",
        "next",
    }
    score = star.score
    port.ask("take_hint", index=0)
    assert star.score == score + received["hints"][0]["change"]
    port.ask("agent", action="complete")
    assert session.wait(10) and session.document.at_optimum
    assert "At the optimum" in port.sentence
    assert port.replica.shows(star, frame(port))
    port.ask("agent", action="play")
    assert port.sentence.startswith("Already at the optimum")


def test_an_edit_that_ends_a_paused_run_is_sent_at_once(port, star):
    port.ask("agent", action="step")
    port.session.wait(10)
    assert port.session.assistant.state is State.PAUSED
    port.session.document.undo()
    assert port.of("agent")[-1]["state"] == "idle"
    assert port.of("patch")[-1]["head"]["cursor"] == 0
    assert port.replica.shows(star, frame(port))


def test_policies_that_do_not_fit_are_refused(session, port, tmp_path):
    for name, words in (
        ("tri", "tri is a policy for triangles; this is a mesh of quads."),
        ("nobody", "There is no policy 'nobody' for quads; there is: quad"),
        (str(tmp_path / "no.safetensors"), "there is no such file"),
    ):
        with pytest.raises(MeshError, match=None) as caught:
            session.agent.choose(name)
        assert words in str(caught.value)
    assert session.assistant.policy == "quad"
    port.ask("policy", name="quad-paper")
    assert port.of("agent")[-1]["policy"] == "quad-paper"
    port.ask("policy", name=str(tmp_path / "no.safetensors"))
    assert "not one of those on offer" in port.sentence


def test_a_failed_run_is_shown_and_raised(port, monkeypatch):
    def broken(mesh, policy, seed):
        raise ValueError("The policy is broken.")

    monkeypatch.setattr(port.session.assistant._worker, "_make_runner", broken)
    port.ask("agent", action="step")
    port.session.wait(10)
    assert port.of("notice")[-1]["tone"] == "failed" and port.sentence == "The policy is broken."
    with pytest.raises(MeshError, match="policy is broken"):
        port.session.finish(port.session.assistant.step)


def test_an_unexpected_exception_is_shown_and_logged(port, monkeypatch, caplog):
    def broken(session, request):
        raise KeyError("oops")

    port.session.handlers[requests.Smooth] = broken
    port.ask("smooth")
    assert port.of("notice")[-1]["tone"] == "failed" and "KeyError" in port.sentence
    assert "Traceback" in caplog.text
    port.operate(*allowed(port.session.mesh))
    assert port.replica.shows(port.session.mesh, frame(port))


def test_a_broken_connection_does_not_stop_the_others(port, caplog):
    class Broken(Port):
        def post(self, packet: Packet) -> None:
            raise OSError("gone")

    broken = Broken(port.session, "x")
    broken.ask("hello")
    port.operate(*allowed(port.session.mesh))
    assert port.replica.shows(port.session.mesh, frame(port)) and "gone" in caplog.text
    broken.close()


def test_added_handlers_and_welcome_messages(port):
    session = port.session

    def level(session, request):
        if request.action == "open":
            raise MeshError(f"there is no level {request.name}")
        return f"{request.action}!"

    session.handlers[requests.ChangeLevel] = level
    session.welcome_messages.append(lambda: Packet({"type": "level", "level": None, "all": []}))
    port.ask("level", action="again")
    assert port.sentence == "again!"
    port.ask("level", action="open", name="x")
    assert port.sentence == "There is no level x."
    assert port.ask("hello")[-1]["type"] == "level"


def test_guards_refuse_requests_and_the_end_is_signalled_once(star):
    session, ended = Session.of(Document(star)), []
    port = Port(session)
    session.guards.append(lambda request: "not in a level" * isinstance(request, requests.CleanAll))
    session.on_end.append(lambda: ended.append(1))
    port.ask("clean_all")
    assert port.sentence == "Not in a level." and not session.document.history
    port.operate(*allowed(star))
    assert session.document.history.cursor == 1
    port.close()
    port.close()
    assert ended == [1]


def test_one_session_per_document_while_a_widget_shows_it(star):
    document = Document(star)
    session = Session.of(document)
    one, other = Port(session), Port(session)
    assert Session.of(document) is session
    one.close()
    assert Session.of(document) is session
    other.close()
    assert Session.of(document) is not session
    with pytest.raises(MeshError, match="closed"):
        session.do(document.undo)


def test_the_agents_thread_ends_with_the_last_widget(star):
    before = workers()
    session = Session.of(Document(star))
    port, other = Port(session), Port(session)
    session.finish(session.assistant.step)
    assert workers() == before + 1
    port.close()
    time.sleep(0.05)
    assert workers() == before + 1
    other.close()
    until(lambda: workers() == before)


def test_collected_widgets_leave_no_references(star):
    before = workers()
    document = Document(star)
    session = Session.of(document)
    port = Port(session)
    port.ask("hello")
    session.finish(session.assistant.step)
    gone = [weakref.ref(port), weakref.ref(session), weakref.ref(document)]
    del port
    gc.collect()
    assert gone[0]() is None and session._ended
    until(lambda: workers() == before)
    del session, document
    gc.collect()
    assert [ref() for ref in gone] == [None] * 3


def test_a_widget_without_connection_is_closed_when_another_is_created(star, triangles):
    before = workers()
    session = Session.of(Document(star))
    port = Port(session)
    session.finish(session.assistant.step)
    port.reachable = False
    session.document.undo()  # no client is notified, and no error
    other = Session.of(Document(triangles))
    assert session._ended and not other._ended
    until(lambda: workers() == before)
    Port(other).close()
