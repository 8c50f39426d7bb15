"""Times and traffic of one click, measured in the page, its socket and the kernel."""

from __future__ import annotations

import itertools
import math
import statistics
import time
from dataclasses import dataclass
from typing import Any

from meshwright.benchmarks.notebook.jupyterlab import LabNotebook
from meshwright.benchmarks.notebook.widget_driver import Card

NOTING = """(() => {
    // what the socket carries and when, when the mouse was released, and what runs in a frame
    const noted = { traffic: [], released: 0, painted: 0, inFrame: false };
    window.noted = noted;
    const reader = new TextDecoder();
    const note = (way, data) => {
        const text = typeof data === 'string';
        const bytes = text ? new TextEncoder().encode(data) : new Uint8Array(data);
        const start = reader.decode(bytes);
        const word = start.match(way === 'up' ? /"do": ?"(\\w+)"/ : /"type": ?"(\\w+)"/);
        if (word) {
            noted.traffic.push({ at: performance.now(), way, word: word[1], bytes: bytes.length });
        }
    };
    const Plain = window.WebSocket;
    window.WebSocket = class extends Plain {
        constructor(...given) {
            super(...given);
            this.addEventListener('message', event => note('down', event.data));
        }
        send(data) {
            note('up', data);
            super.send(data);
        }
    };
    window.addEventListener('pointerup', event => { noted.released = event.timeStamp; }, true);
    const plain = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = callback => plain(time => {
        noted.inFrame = true;
        // observers of what the callback changed are called before this
        try { callback(time); } finally { queueMicrotask(() => { noted.inFrame = false; }); }
    });
    // calls back once the frame that is being made, or the next one, is on its way to the screen
    const after = callback => {
        const channel = new MessageChannel();
        channel.port1.onmessage = callback;
        channel.port2.postMessage(0);
    };
    noted.framed = callback => {
        if (noted.inFrame) after(callback);
        else plain(() => after(callback));
    };
})();"""
WATCH = """root => {
    noted.traffic.length = 0;
    noted.painted = 0;
    const before = root.dataset.revision;
    const observer = new MutationObserver(() => {
        if (root.dataset.revision === before) return;
        observer.disconnect();
        noted.framed(() => { noted.painted = performance.now(); });
    });
    observer.observe(root, { attributes: true, attributeFilter: ['data-revision'] });
}"""
READ = "() => ({ traffic: noted.traffic, released: noted.released, painted: noted.painted })"
COUNT = """root => {
    noted.frames = [];
    noted.counting = true;
    let before = root.dataset.painted;
    const look = time => {
        if (root.dataset.painted !== before) noted.frames.push(time);
        before = root.dataset.painted;
        if (noted.counting) requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
}"""
CODE = """
import time
import numpy as np
from meshwright.benchmarks.desktop.probe import scrambled
from meshwright.notebook import MeshWidget
mesh = scrambled({size}, {seed})
widget = MeshWidget(mesh)
rng, spent = np.random.default_rng({seed}), []

def somewhere():
    "A half-edge where flip_left is allowed."
    ids = mesh.element_ids()
    while True:
        h = int(4 * rng.choice(ids) + rng.integers(4))
        if widget.check("flip_left", h):
            return h

def clocked(comm):
    "Note how long after a message has come the last answer to it is sent."
    handle, send = widget._handle_msg, comm.send
    def receive(message):
        spent.append([time.perf_counter(), 0.0])
        handle(message)
    def answer(*given, **more):
        send(*given, **more)
        if spent:
            spent[-1][1] = time.perf_counter()
    comm.on_msg(receive)
    comm.send = answer
clocked(widget.comm)
widget
"""


@dataclass(frozen=True)
class ClickTimes:
    """One click: milliseconds by part, and what was sent for it in bytes."""

    milliseconds: dict[str, float]
    patch_bytes: int
    all_bytes: int


class WidgetProbe:
    """A widget with a scrambled mesh of ``size`` quads, ready to be clicked at."""

    def __init__(self, notebook: LabNotebook, size: int, seed: int) -> None:
        """Replace the notebook's cells by one that shows the widget."""
        self.notebook = notebook
        self.page = notebook.page
        self.page.evaluate("() => { noted.traffic.length = 0; }")
        notebook.show(CODE.format(size=size, seed=seed))
        self.card = Card(self.page)
        traffic = self.page.evaluate(READ)["traffic"]
        self.state_bytes = [row["bytes"] for row in traffic if row["word"] == "state"][-1]

    def click(self) -> ClickTimes:
        """Flip an edge by a real click; returns when the widget is idle again."""
        halfedge = self.notebook.ask("somewhere()")
        card = self.card
        card.hover(halfedge)
        card.arm("flip_left")
        self.page.wait_for_timeout(150)  # the preview is shown
        self.notebook.ask("None", "spent.clear()")
        card.look(WATCH)
        self.page.mouse.click(*card.place(halfedge))
        self.page.wait_for_function("() => noted.painted > 0")
        self.page.wait_for_timeout(150)  # what is sent afterwards counts as well
        found = self.page.evaluate(READ)
        sent = next(row["at"] for row in found["traffic"] if row["word"] == "operate")
        patch = next(row for row in found["traffic"] if row["word"] in ("patch", "state"))
        python = 1e3 * self.notebook.ask("spent[0][1] - spent[0][0]")
        self.notebook.ask("None", "widget.undo()")  # the next click finds the same mesh
        card.await_head(cursor=0)
        total = found["painted"] - found["released"]
        milliseconds = {
            "total": total,
            "browser": sent - found["released"],
            "python": python,
            "transport": patch["at"] - sent - python,
            "paint": found["painted"] - patch["at"],
        }
        everything = sum(row["bytes"] for row in found["traffic"] if row["way"] == "down")
        return ClickTimes(milliseconds, patch["bytes"], everything)

    def pan(self, seconds: float) -> dict[str, Any]:
        """Drag the view in circles; painted frames per second, and the slowest frame."""
        box = self.card.root.locator(".mw-stage").bounding_box()
        assert box is not None
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        self.card.look(COUNT)
        begun, angle = time.monotonic(), 0.0
        while time.monotonic() < begun + seconds:
            angle += 0.1
            self.page.mouse.move(x + 80 * math.sin(angle), y + 80 * math.cos(angle))
        frames = self.page.evaluate("() => { noted.counting = false; return noted.frames; }")
        self.page.mouse.up()
        gaps = [later - sooner for sooner, later in itertools.pairwise(frames)]
        return {
            "frames_per_second": round(1e3 / statistics.mean(gaps), 1),
            "slowest_frame_ms": round(max(gaps), 1),
        }
