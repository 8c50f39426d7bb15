"""The widget in a real kernel: blocking cells, background runs, subshells, exceptions."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from queue import Empty
from typing import Any

import pytest

pytestmark = pytest.mark.slow

BEGIN = """
import sys
sys.path.insert(0, {folder!r})
import meshwright.assistant.worker, meshwright.notebook.kernel_warmup as preparing
from meshwright.assistant.kernel_preparation import Stage
from meshwright.notebook import MeshWidget
from meshwright.document.operation_preview import choices

class Runner:
    "Takes the best local operation anywhere, six times."
    reason, left = "nothing more", 6
    def __init__(self, mesh, policy, seed):
        self.mesh = mesh.copy()
    @property
    def finished(self):
        return self.left == 0
    def look(self):
        return None
    def step(self):
        mesh = self.mesh
        halves = [4 * e + i for e in mesh.element_ids().tolist() for i in range(4)]
        offers = [(h, c) for h in halves for c in choices(mesh, h) if c.allowed]
        offers = [(h, c) for h, c in offers if c.info.is_local]
        h, c = min(offers, key=lambda offer: offer[1].change)
        mesh.apply(c.operation, h)
        self.left -= 1
        return [(c.operation, h)]

meshwright.assistant.worker._load_policy = lambda name: name
meshwright.assistant.worker._make_runner = Runner
preparing.PREPARATION._stage = Stage.READY
w = MeshWidget("star")
"""


class Kernel:
    """A kernel, with a stand-in for the browser."""

    def __init__(self, client: Any) -> None:
        self._client = client
        self._id = 0
        self.comm = ""
        self.subshell = ""
        self.inbox: list[dict[str, Any]] = []
        self.printed = ""

    def run(self, code: str) -> str:
        """Run a cell to its end; returns what it printed."""
        self.printed = ""
        sent = self._client.execute(code)
        self.until(lambda m: m["msg_type"] == "status" and self._ends(m, sent))
        reply = self._client.get_shell_msg(timeout=30)
        while reply["parent_header"].get("msg_id") != sent:
            reply = self._client.get_shell_msg(timeout=30)
        assert reply["content"]["status"] == "ok", self.printed
        return self.printed.strip()

    def begin(self, code: str) -> None:
        """Start a cell."""
        self._client.execute(code)

    def request(self, do: str, **fields: Any) -> int:
        """Send a request as JupyterLab does: to the subshell, if there is one."""
        self._id += 1
        content = {"do": do, "id": self._id, "view": "v", **fields}
        message = self._client.session.msg(
            "comm_msg",
            {"comm_id": self.comm, "data": {"method": "custom", "content": content}},
        )
        if self.subshell:
            message["header"]["subshell_id"] = self.subshell
        self._client.shell_channel.send(message)
        return self._id

    def until(self, wanted: Callable[[dict[str, Any]], Any], seconds: float = 30.0) -> None:
        """Read messages until one is as wanted."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                message = self._client.get_iopub_msg(timeout=1)
            except Empty:
                continue
            self._note(message)
            if wanted(message):
                return
        pytest.fail(f"no such message; last: {self.inbox[-3:]} {self.printed}")

    def answer(self, number: int) -> dict[str, Any]:
        """Read messages until the request of this number is answered."""
        self.until(lambda m: self.inbox and self.inbox[-1].get("reply") == number)
        return self.inbox[-1]

    def _note(self, message: dict[str, Any]) -> None:
        content = message["content"]
        if message["msg_type"] == "comm_open":
            if content["data"]["state"].get("_model_module") == "anywidget":
                self.comm = content["comm_id"]
        elif message["msg_type"] == "comm_msg" and content["data"].get("method") == "custom":
            self.inbox.append(content["data"]["content"])
        elif message["msg_type"] == "stream":
            self.printed += content["text"]
        elif message["msg_type"] == "error":
            self.printed += "\n".join(content["traceback"])

    def _ends(self, message: dict[str, Any], sent: str) -> bool:
        idle = message["content"]["execution_state"] == "idle"
        return idle and message["parent_header"].get("msg_id") == sent


@pytest.fixture(scope="module")
def kernel() -> Iterator[Kernel]:
    from jupyter_client.manager import start_new_kernel

    from meshwright.document import document

    manager, client = start_new_kernel()
    try:
        started = Kernel(client)
        started.run(
            BEGIN.format(
                folder=document.__file__.removesuffix("app/meshwright/document/document.py")
            )
        )
        state = started.answer(started.request("hello"))
        assert state["type"] in ("state", "agent")
        # Workers share the tests of this file out, so each finds one operation in the history.
        started.run("w.step(); w.go_to(0)")
        yield started
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)


def position(kernel: Kernel) -> int:
    return int(kernel.run("print(w.history.cursor)"))


def test_a_run_continues_after_its_cell_has_ended(kernel):
    kernel.run("w.go_to(0)")
    kernel.inbox.clear()
    assert kernel.run("w.play(speed=30); print(w.history.cursor)") == "0"
    kernel.until(lambda m: kernel.inbox and kernel.inbox[-1].get("state") == "idle")
    patches = [inbox for inbox in kernel.inbox if inbox["type"] == "patch"]
    assert len(patches) > 1  # it was seen on its way
    assert position(kernel) == patches[-1]["head"]["cursor"]
    score = kernel.run("print(w.score)")
    assert score == str(patches[-1]["head"]["score"])


def test_waiting_in_a_cell_completes_the_run(kernel):
    kernel.run("w.go_to(0)")
    kernel.inbox.clear()
    assert int(kernel.run("w.play(wait=True); print(w.history.cursor)")) > 1
    assert any(inbox["type"] == "patch" for inbox in kernel.inbox)
    kernel.run("w.go_to(0); w.step(); assert w.history.cursor >= 1")


def test_edits_of_a_running_cell_are_shown_while_it_runs(kernel):
    kernel.run("w.go_to(1)")
    kernel.begin("import time\nw.undo(); time.sleep(1.5); w.redo()")
    begun = time.monotonic()
    kernel.until(lambda m: kernel.inbox and kernel.inbox[-1].get("head", {}).get("cursor") == 0)
    assert time.monotonic() - begun < 1.2
    kernel.until(lambda m: kernel.inbox and kernel.inbox[-1].get("head", {}).get("cursor") == 1)


def test_clicks_through_a_subshell_run_in_the_thread_of_the_cells(kernel):
    kernel.run("w.go_to(1)")
    kernel._client.control_channel.send(kernel._client.session.msg("create_subshell_request"))
    kernel.subshell = kernel._client.get_control_msg(timeout=10)["content"]["subshell_id"]
    kernel.run(
        "import threading\nseen = []\n"
        "off = w.on('changed', lambda: seen.append(threading.current_thread().name))"
    )
    try:
        kernel.answer(kernel.request("undo"))
        assert kernel.run("print(seen)") == "['MainThread']"
        # a cell that runs keeps the mesh to itself, unless it waits
        kernel.begin("import time; time.sleep(0.6); print('slept', w.history.cursor)")
        time.sleep(0.2)
        kernel.inbox.clear()
        kernel.answer(kernel.request("redo"))
        assert "slept 0" in kernel.printed
        assert position(kernel) == 1
    finally:
        kernel.subshell = ""
        kernel.run("off()")


def test_exceptions_in_callbacks_are_shown_in_notebook_and_browser(kernel):
    kernel.run("w.go_to(1); off = w.on('changed', lambda: 1 / 0)")
    kernel.inbox.clear()
    kernel.answer(kernel.request("undo"))
    assert any(inbox.get("tone") == "failed" for inbox in kernel.inbox)
    assert "ZeroDivisionError" in kernel.printed
    kernel.run("off()")


def test_malformed_messages_do_not_stop_the_kernel(kernel):
    before = kernel.run("print(hash(w.mesh.arrays.points.tobytes()))")
    for content in ({"do": "operate"}, {"do": "undo", "more": 1}, {"do": 5}, {"halfedge": [[[]]]}):
        number = kernel.request(content.pop("do", "hover"), **content)
        assert kernel.answer(number)["tone"] == "refused"
    assert kernel.run("print(hash(w.mesh.arrays.points.tobytes()))") == before


def test_the_agents_thread_ends_with_the_widget(kernel):
    names = kernel.run(
        "import threading, time\nw.close(); time.sleep(0.3)\n"
        "print([t.name for t in threading.enumerate() if t.name in ('assistant', 'preparing')])"
    )
    assert names == "[]"
