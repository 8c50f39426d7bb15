"""The widget's Python interface: sources, edits, events, agent, close."""

import gc
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import pytest
import traitlets
from porting import Replica, allowed, script_agent

from meshwright.document.document import Document
from meshwright.notebook import MeshWidget
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright_core import HalfEdgeMesh, MeshError, OperationRefused


@pytest.fixture(autouse=True)
def scripted(monkeypatch, greedy):
    script_agent(monkeypatch, greedy)


class Shown(MeshWidget):
    """A widget with a replica as its browser."""

    def post(self, packet: Packet) -> None:
        if "packets" not in self.__dict__:
            self.packets, self.replica = [], Replica()
        self.packets.append(packet)
        self.replica.take(packet)

    def send(self, do: str, **fields) -> None:
        content = {"do": do, "id": 1, "view": "v", **fields}
        self._handle_msg(
            {"content": {"data": {"method": "custom", "content": content}}, "buffers": []}
        )

    @property
    def sentence(self) -> str:
        notices = [p.content for p in self.packets if p.content["type"] == "notice"]
        return str(notices[-1]["sentence"])

    @property
    def in_step(self) -> bool:
        return self.replica.shows(self.mesh, self.session.broadcaster.mesh_sync.frame)


@pytest.fixture
def show():
    made = []

    def build(source, **options) -> Shown:
        widget = Shown(source, **options)
        made.append(widget)
        widget.send("hello")
        return widget

    yield build
    for widget in made:
        widget.close()


@pytest.fixture
def widget(show, star) -> Shown:
    return show(star, name="star")


def test_valid_sources(show, star, tmp_path):
    from meshwright_core.domains import gallery
    from meshwright_core.io import mesh_files

    assert show(star).mesh is star
    document = Document(star, "mine")
    widget = show(document)
    assert widget.document is document and widget.label == "mine"
    assert show(widget).document is document
    assert show("l-shape").mesh.kind == "quad" and show("l-shape", kind="tri").mesh.kind == "tri"
    assert show(gallery.shape("star")).label == "star"
    mesh_files.write(tmp_path / "m.obj", star)
    assert show(tmp_path / "m.obj").mesh.n_elements == 24
    document.submit(*allowed(star))
    document.save(tmp_path / "p.meshwright")
    opened = show(str(tmp_path / "p.meshwright"))
    assert len(opened.history) == 1 and opened.label == "p"


@pytest.mark.parametrize(
    ("source", "options", "words"),
    [
        ("starr", {}, "starr"),
        ("no.obj", {}, "no.obj"),
        (3, {}, "int"),
        (None, {}, "nothing to show"),
        ("star", {"kind": "hex"}, "hex"),
        ("star", {"policy": "tri"}, "tri is a policy for triangles; this is a mesh of quads."),
        ("star", {"policy": "nobody"}, "There is no policy 'nobody'"),
    ],
)
def test_invalid_sources_raise_one_sentence(source, options, words):
    with pytest.raises(MeshError) as caught:
        MeshWidget(source, **options)
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_a_mesh_of_the_other_kind_is_refused(star):
    with pytest.raises(MeshError, match="quads"):
        MeshWidget(star, kind="tri")


@pytest.mark.parametrize("options", [{"height": 5}, {"height": "a"}, {"theme": "pink"}])
def test_height_and_theme_have_bounds(star, options):
    with pytest.raises(traitlets.TraitError):
        MeshWidget(star, **options)


def test_repr(widget):
    assert repr(widget) == f"<Shown of {widget.mesh!r}>" and "s = 12, s* = 4" in repr(widget)


def test_scores_are_traits_that_only_the_document_sets(widget, star):
    seen = []
    widget.observe(lambda change: seen.append((change["name"], change["new"])), ["score"])
    assert (widget.score, widget.optimum, widget.at_optimum) == (12, 4, False)
    operation, halfedge = allowed(star)
    edit = widget.apply(operation, np.int64(halfedge))
    assert widget.score == star.score == 12 + edit.score_change
    assert [value for _, value in seen] == ([star.score] if edit.score_change else [])
    with pytest.raises(traitlets.TraitError):
        widget.score = 0
    with pytest.raises(traitlets.TraitError):
        widget.optimum = 0


def test_a_browser_sets_no_trait(widget):
    state = {"score": 0, "optimum": 0, "height": 9, "theme": "x", "_esm": "alert(1)", "label": 3}
    widget._handle_msg({"content": {"data": {"method": "update", "state": state}}, "buffers": []})
    assert (widget.score, widget.height, widget.theme) == (12, 464, "auto")
    assert widget._esm != "alert(1)"


@pytest.mark.parametrize(
    "message",
    [
        {},
        None,
        {"content": 3},
        {"content": {"data": []}},
        {"content": {"data": {}}},
        {"content": {"data": {"method": ["custom"]}}},
        {"content": {"data": {"method": "custom"}}},
        {"content": {"data": {"method": "custom", "content": "undo"}}, "buffers": None},
        {"content": {"data": {"method": "update"}}},
        {"content": {"data": {"method": "delete", "content": {"do": "undo"}}}},
    ],
    ids=str,
)
def test_malformed_comm_messages_are_ignored_or_refused(widget, message):
    before = widget.mesh.arrays.points.tobytes()
    widget._handle_msg(message)
    assert widget.mesh.arrays.points.tobytes() == before
    widget.apply(*allowed(widget.mesh))
    assert widget.in_step


def test_every_edit_from_python_is_sent(widget, star):
    operation, halfedge = allowed(star)
    assert widget.check(operation, halfedge)
    widget.apply(operation, halfedge)
    assert widget.history.cursor == 1 and widget.in_step
    assert widget.undo().title == "Flip left" and widget.undo() is None
    assert widget.redo().title == "Flip left"
    widget.smooth()
    widget.untangle()
    widget.clean_all()
    vertex = int(star.vertices()[-1])
    widget.set_desired(vertex, 7)
    widget.lock(vertex)
    widget.corner(vertex)
    widget.corner(vertex, False)
    assert star.locked()[vertex] and star.desired()[vertex] == 7
    assert not star.geometric()[vertex]
    widget.go_to(0)
    assert widget.history.cursor == 0 and widget.in_step
    boundary = next(h for h in range(96) if star.twin(h) < 0)
    assert widget.check("flip_left", boundary).reason.endswith("on the boundary")
    with pytest.raises(OperationRefused):
        widget.apply("flip_left", boundary)
    assert widget.in_step


def test_two_widgets_on_one_document_stay_synchronised(show, widget):
    other = show(widget)
    assert other.document is widget.document and other.assistant is widget.assistant
    other.send("operate", **operation_request(widget.mesh))
    assert widget.in_step and other.in_step and widget.score == other.score == widget.mesh.score
    other.close()
    widget.undo()
    assert widget.in_step


def operation_request(mesh: HalfEdgeMesh) -> dict:
    operation, halfedge = allowed(mesh)
    ends = [mesh.origin(halfedge), mesh.target(halfedge)]
    return {"operation": operation, "halfedge": halfedge, "ends": ends}


def test_events(widget):
    seen = []
    names = ("changed", "score", "history", "hover", "agent", "level")
    off = [widget.on(name, lambda *a, name=name: seen.append((name, *a))) for name in names]
    widget.apply(*allowed(widget.mesh))
    assert seen == [("changed",), ("score", widget.score), ("history",)]
    seen.clear()
    widget.send("hover", halfedge=4, operation=None)
    assert seen == [("hover", 4)]
    widget.step()
    assert ("agent", "paused") in seen
    widget.session.level_changed.emit("one")
    assert seen[-1] == ("level", "one")
    seen.clear()
    for disconnect in off:
        disconnect()
        disconnect()
    widget.undo()
    assert seen == []
    with pytest.raises(MeshError, match="no event 'click'"):
        widget.on("click", print)


def test_an_exception_in_a_callback_is_shown_and_logged_only(widget, caplog):
    seen = []
    widget.on("changed", lambda: 1 / 0)
    widget.on("changed", lambda: seen.append(1))
    widget.apply(*allowed(widget.mesh))
    assert seen == [1] and widget.in_step
    assert "ZeroDivisionError" in caplog.text and "ZeroDivisionError" in widget.sentence


def test_a_callback_may_edit_but_not_wait(widget):
    raised = []

    def undo() -> None:
        if widget.history.cursor:
            widget.undo()
            for wait in (widget.wait, widget.step):
                try:
                    wait()
                except MeshError as error:
                    raised.append(str(error))

    widget.on("history", undo)
    widget.apply(*allowed(widget.mesh))
    assert widget.history.cursor == 0 and widget.in_step
    assert ["block itself" in words for words in raised] == [True, True]
    assert not widget.assistant.running


def test_the_agent_with_and_without_waiting(widget):
    widget.step()
    assert widget.history.cursor >= 1 and widget.history.last.by == "quad"
    widget.play(speed=60)
    assert not widget.at_optimum
    assert widget.wait(20) and widget.at_optimum
    widget.go_to(0)
    widget.assistant.speed = 2
    begun = time.monotonic()
    widget.play("quad-paper", wait=True)
    assert widget.at_optimum and widget.assistant.speed == 2
    assert time.monotonic() - begun < 2  # five decisions at 2 a second would take longer
    assert widget.history.last.by == "quad-paper" and widget.in_step
    widget.go_to(0)
    first, *_ = widget.hint()
    assert widget.check(first.operation, first.halfedge) and first.probability > 0
    assert widget.hint(wait=False) == ()
    widget.complete(1.0)
    assert widget.at_optimum and widget.in_step
    assert widget.hint() == ()


def test_pause_and_a_wait_that_times_out(widget):
    widget.play(speed=0.5)
    assert not widget.wait(0.1)
    widget.pause()
    assert widget.wait(5) and str(widget.assistant.state) == "paused"
    with pytest.raises(MeshError, match="seconds"):
        widget.complete(float("nan"))


def test_an_interrupt_ends_the_run(widget, monkeypatch):
    def interrupted(until, timeout=None):
        raise KeyboardInterrupt

    monkeypatch.setattr(widget.session.loop, "pump", interrupted)
    with pytest.raises(KeyboardInterrupt):
        widget.play(wait=True)
    widget.session.loop.drain()
    assert not widget.assistant.running


def test_calls_from_other_threads_run_in_the_owners_thread(widget):
    got = []

    def work() -> None:
        got.append(widget.apply(*allowed(widget.mesh)))
        widget.step()
        got.append("end")

    thread = threading.Thread(target=work)
    thread.start()
    widget.session.loop.pump(lambda: len(got) == 2, 20)
    thread.join(10)
    assert got[-1] == "end" and widget.history.cursor >= 2 and widget.in_step


def test_a_closed_widget_refuses_calls(star):
    widget = MeshWidget(star)
    widget.close()
    widget.close()
    assert widget.mesh is star
    with pytest.raises(MeshError, match="closed"):
        widget.undo()
    again = MeshWidget(widget)
    assert again.mesh is star
    again.close()


def test_a_closed_widget_leaves_no_references(star):
    widget = MeshWidget(star)
    widget.on("changed", print)
    document = widget.document
    gone = weakref.ref(widget)
    widget.close()
    del widget
    gc.collect()
    assert gone() is None
    document.submit(*allowed(star))


def test_importing_the_widget_imports_neither_qt_nor_torch():
    code = (
        "import sys, meshwright.notebook; print([m for m in ('torch', 'qtpy', 'PySide6', 'pyvista',"
        " 'matplotlib', 'PIL', 'meshwright_agent', 'scipy.sparse') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == "[]", done.stderr


def test_the_process_exits_during_a_run():
    code = (
        "from meshwright.notebook import MeshWidget\n"
        "import meshwright.assistant.worker, time, threading\n"
        "class Slow:\n"
        "    finished, reason = False, ''\n"
        "    def look(self): return None\n"
        "    def step(self):\n"
        "        time.sleep(0.2)\n"
        "        return []\n"
        "meshwright.assistant.worker._load_policy = lambda name: name\n"
        "meshwright.assistant.worker._make_runner = lambda mesh, policy, seed: Slow()\n"
        "w = MeshWidget('star')\n"
        "w.play()\n"
        "print(any(t.name == 'assistant' for t in threading.enumerate()))\n"
    )
    # the run never ends: a process that waited for it would exceed the time limit
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stdout.strip() == "True" and done.stderr == ""
