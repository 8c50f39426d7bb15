"""Random edits by users, Python and the agent on one mesh: all views stay synchronised."""

from __future__ import annotations

import asyncio
import random
import threading
from collections.abc import Callable

import pytest
from porting import Port, script_agent

from meshwright.document.document import Document
from meshwright.notebook.session import Session
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.operations.catalogue import of_kind


class Monkey:
    """Random requests from two widgets and random calls from Python."""

    def __init__(self, meshes: list[HalfEdgeMesh], seed: int) -> None:
        self.random = random.Random(seed)
        self.meshes = meshes
        self.document = Document(meshes[0].copy())
        self.session = Session.of(self.document)
        self.ports = [Port(self.session, "a"), Port(self.session, "b")]
        for port in self.ports:
            port.ask("hello")

    async def run(self, steps: int) -> None:
        for step in range(steps):
            self.random.choice((self.ask, self.ask, self.ask_elsewhere, self.call))()
            if self.random.random() < 0.3:
                await asyncio.sleep(self.random.choice((0, 0.001, 0.01)))
            if step % 10 == 9:
                await asyncio.sleep(0.02)
                self.check()
        self.session.assistant.cancel()
        await asyncio.sleep(0.05)
        self.check()

    def check(self) -> None:
        """All views equal the mesh, and no exception was reported."""
        self.session.broadcaster.flush()
        mesh, history = self.session.mesh, self.document.history
        scores = [history.first[0], *(row.after for row in history)]
        for port in self.ports:
            assert port.replica.shows(mesh, self.session.broadcaster.mesh_sync.frame)
            assert port.replica.scores[: len(scores)] == scores
            assert "failed" not in {notice["tone"] for notice in port.of("notice")}
            port.packets.clear()

    def ask(self) -> None:
        word, fields = self.words()
        self.random.choice(self.ports).ask(word, **fields)

    def ask_elsewhere(self) -> None:
        thread = threading.Thread(target=self.ask)
        thread.start()
        thread.join()

    def words(self) -> tuple[str, dict]:
        mesh, rng = self.session.mesh, self.random
        names = [str(info.operation) for info in of_kind(mesh.kind)]
        halfedge = mesh.k * rng.choice(mesh.element_ids().tolist()) + rng.randrange(mesh.k)
        vertex = rng.choice(mesh.vertices().tolist())
        ends = [mesh.origin(halfedge), mesh.target(halfedge)]
        operation = rng.choice(names)
        word = rng.choice(("operate", "operate", "operate", "hover", "hover", "agent", "other"))
        if word == "operate":
            return word, {"operation": operation, "halfedge": halfedge, "ends": ends}
        if word == "hover":
            return word, {"operation": rng.choice((operation, None)), "halfedge": halfedge}
        if word == "agent":
            actions = ("step", "play", "pause", "complete", "stop", "hint")
            return word, {"action": rng.choice(actions)}
        others: dict[str, dict] = {
            "undo": {},
            "redo": {},
            "smooth": {},
            "untangle": {},
            "clean_all": {},
            "hello": {},
            "go_to": {"cursor": rng.randrange(len(self.document.history) + 2)},
            "auto_smooth": {"on": rng.random() < 0.8},
            "desired": {"vertex": vertex, "degree": rng.randrange(1, 7)},
            "lock": {"vertex": vertex, "on": rng.random() < 0.5},
            "take_hint": {"index": rng.randrange(3)},
            "speed": {"value": 60},
        }
        word = rng.choice(list(others))
        return word, others[word]

    def call(self) -> None:
        """Calls that a cell may make."""
        session, document = self.session, self.document
        calls: list[Callable[[], object]] = [
            document.undo,
            document.redo,
            lambda: document.go_to(self.random.randrange(len(document.history) + 1)),
            lambda: document.replace(self.random.choice(self.meshes).copy()),
            session.assistant.step,
            session.assistant.play,
            session.assistant.pause,
            lambda: session.wait(0.02),
            lambda: session.finish(session.assistant.step),
            lambda: session.finish(session.assistant.hint),
        ]
        try:
            self.random.choice(calls)()
        except MeshError as error:
            assert str(error)


@pytest.mark.parametrize("seed", range(3))
def test_all_views_stay_synchronised(star, triangles, strip, monkeypatch, greedy, seed):
    script_agent(monkeypatch, greedy)

    async def cell() -> None:
        monkey = Monkey([star, triangles, strip], seed)
        await monkey.run(150)
        for port in monkey.ports:
            port.close()

    asyncio.run(cell())
