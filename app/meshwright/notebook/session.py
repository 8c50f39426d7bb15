"""A session: what all widgets on one document share."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, TypeVar
from weakref import WeakValueDictionary, finalize

from meshwright.assistant.assistant import Assistant
from meshwright.assistant.kernel_preparation import Stage
from meshwright.document.document import NO_MESH, Document
from meshwright.notebook import kernel_warmup
from meshwright.notebook.kernel_warmup import DONE, WAITS
from meshwright.notebook.protocol.agent_bridge import Helper
from meshwright.notebook.protocol.broadcaster import Port, Telling
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.notebook.protocol.preview_messages import ghost_packet, no_ghost
from meshwright.notebook.protocol.request_handlers import (
    DEEDS,
    Deed,
    require_halfedge,
    require_operation,
)
from meshwright.notebook.protocol.requests import RefusedError, Request, parse
from meshwright.notebook.thread_loop import Loop
from meshwright.signals import Signal
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.errors import sentence

Result = TypeVar("Result")

NEEDS: dict[Stage, tuple[str, ...]] = {
    Stage.EDITING: ("operate", "smooth", "untangle", "clean_all", "agent", "take_hint", "level"),
    Stage.AGENT: ("agent",),
}
"""What has to wait while something is compiled for the first time."""

_log = logging.getLogger(__name__)


class Session:
    """A document with its assistant and all widgets that show it.

    It lives as long as one of the widgets. Everything happens in the thread that made it, wherever
    a message comes from. Events: ``agent_changed()`` what the agent does has changed,
    ``level_changed(level)`` for who plays levels to emit.
    """

    _all: ClassVar[WeakValueDictionary[int, Session]] = WeakValueDictionary()

    def __init__(self, document: Document) -> None:
        """For :meth:`of`."""
        self.document = document
        self.loop = Loop(self._on_broken)
        self.assistant = Assistant(document, self.loop)
        self.agent = Helper(document, self.assistant, self.loop)
        self.telling = Telling(document, self.agent, self.loop)
        self.agent_changed = Signal()
        self.level_changed = Signal()
        self.words: dict[str, Deed] = dict(DEEDS)
        """What is done for each word that a browser may say: others may add theirs, which get the
        session and the request, may raise MeshError to refuse, and return a sentence or none.
        """
        self.greetings: list[Callable[[], Packet]] = []
        """What else a view is told when it comes."""
        self.bars: list[Callable[[Request], str]] = []
        """Asked before anything is done: a sentence refuses it."""
        self.endings: list[Callable[[], None]] = []
        """Called once no widget is left."""
        self.level: Any = None
        """The level that is being played; None where none is."""
        self._hovers: dict[str, tuple[Port, Request]] = {}
        self._calling = self._ended = False
        self.agent.settle()
        document.replaced.connect(self._on_replaced)
        document.changed.connect(self.telling.follow)
        document.score_changed.connect(self._on_score_changed)
        self.assistant.changed.connect(self._on_agent_changed)
        self.assistant.hinting.changed.connect(self._on_agent_changed)
        self.assistant.message.connect(self._on_said)
        self.assistant.failed.connect(self._on_failed)

    @classmethod
    def of(cls, document: Document) -> Session:
        """The session of a document; a new one if no widget shows it yet."""
        for session in list(cls._all.values()):
            if session.loop.here:  # marimo's readers have a thread each
                for port in session.telling.lost:
                    port.close()
        found = cls._all.get(id(document))  # it holds the document, so the number is still its own
        if found is None:
            found = cls._all[id(document)] = cls(document)
        return found

    @property
    def mesh(self) -> HalfEdgeMesh:
        """The mesh; MeshError while there is none."""
        if self.document.mesh is None:
            raise MeshError(NO_MESH)
        return self.document.mesh

    # Who takes part

    def join(self, port: Port) -> None:
        """A widget begins to show the document."""
        self.telling.add(port)
        finalize(port, self.end_if_alone).atexit = False

    def leave(self, port: Port) -> None:
        """A widget is closed; after the last one the agent's thread ends."""
        self.telling.remove(port)
        self._hovers = {view: held for view, held in self._hovers.items() if held[0] is not port}
        self.end_if_alone()

    def end_if_alone(self) -> None:
        """End, if no widget shows the document."""
        if self._ended or not self.telling.alone:
            return
        if self._all.get(id(self.document)) is self:
            del self._all[id(self.document)]
        self._ended = True
        for end in self.endings:
            end()
        self.assistant.close()
        self.document.replaced.disconnect(self._on_replaced)
        self.document.changed.disconnect(self.telling.follow)
        self.document.score_changed.disconnect(self._on_score_changed)

    # What Python asks for

    def do(self, call: Callable[[], Result]) -> Result:
        """The result of ``call()``, called in the thread that owns the document."""
        self._require_open()
        return self.loop.do(call)

    def wait(self, timeout: float | None = None) -> bool:
        """Let the agent work until it is at rest; returns whether it is."""
        self._require_open()
        self._require_patience()
        return self.loop.pump(lambda: self.agent.idle, timeout)

    def finish(self, begin: Callable[[], None]) -> None:
        """Begin something of the agent's and wait for its end, in whichever thread.

        Raises MeshError where it broke off. An interrupt ends it, too.
        """
        self._require_patience()
        failures: list[str] = []
        self.do(lambda: self.assistant.failed.connect(failures.append))
        try:
            self.do(begin)
            self.wait()
        except KeyboardInterrupt:
            if self.loop.here:
                self.assistant.cancel()  # where no loop runs, a queued one would end the next run
            else:
                self.loop(self.assistant.cancel)
            raise
        finally:
            self.assistant.failed.disconnect(failures.append)
        self.loop.do(self.telling.catch_up)
        if failures:
            raise MeshError(failures[-1])

    def call_back(self, callback: Callable[..., Any], *arguments: Any) -> None:
        """Call what a person has connected; what it raises is told and logged, and goes no
        further.
        """
        outer, self._calling = self._calling, True
        try:
            callback(*arguments)
        except Exception as error:  # not ours: the document must go on
            _log.error("a callback broke off", exc_info=error)
            self.telling.notice("failed", broken(error))
        finally:
            self._calling = outer

    def _require_patience(self) -> None:
        if self._calling and self.loop.here:
            raise MeshError("A callback cannot wait for the agent: it would wait for itself.")

    def _require_open(self) -> None:
        if self._ended:
            raise MeshError("This widget is closed; make another one on its document.")

    # What browsers say

    def receive(self, port: Port, content: Any, buffers: Sequence[Any] | None = None) -> None:
        """A message of a widget's browser, in whichever thread it comes; never raises."""
        try:
            request = parse(content, buffers)
        except RefusedError as error:
            self.telling.answer(port, error.request, "refused", error.sentence)
            return
        if request.do == "hover":
            self._hovers[request.view] = port, request  # the latest of a view wins
        if self.loop.here:
            self._serve(port, request)
        else:
            self.loop(lambda: self._serve(port, request))

    def _serve(self, port: Port, request: Request) -> None:
        self.telling.hold(request)
        try:
            self._do(port, request)
        except MeshError as error:
            self.telling.answer(port, request, "refused", sentence(str(error)))
        except Exception as error:  # the kernel lives on: the person and the log are told
            _log.error("'%s' broke off", request.do, exc_info=error)
            self.telling.answer(port, request, "failed", broken(error))
        finally:
            self.telling.release()

    def _do(self, port: Port, request: Request) -> None:
        if request.do == "hello":
            self.telling.greet(port, request)
            for greeting in self.greetings:
                self.telling.post(port, greeting(), request)
            self._prepare(port, request)
        elif request.do == "hover":
            self._point(request)
        elif port.read_only:
            raise MeshError("this view is for looking only")
        elif request.do not in self.words:
            raise MeshError(f"there is nothing to '{request.do}' here")
        elif request.do in NEEDS.get(kernel_warmup.PREPARATION.compiling, ()):
            raise MeshError(WAITS[kernel_warmup.PREPARATION.compiling])
        else:
            why = next(filter(None, (bar(request) for bar in self.bars)), "")
            if why:
                raise MeshError(why)
            said = self.words[request.do](self, request)
            if said:
                self.telling.answer(port, request, "said", said)

    def _point(self, request: Request) -> None:
        held = self._hovers.pop(request.view, None)
        if held is None:
            return  # a later one was served in its place
        port, request = held
        halfedge, operation = request["halfedge"], request["operation"]
        if halfedge < 0 or kernel_warmup.PREPARATION.compiling is Stage.EDITING:
            self.document.hover = -1
            self.telling.post(port, no_ghost(), request)
            return
        require_halfedge(self.mesh, halfedge)
        if operation is not None:
            require_operation(self.mesh.kind, operation)
        self.document.hover = halfedge
        frame, bar = self.telling.mirror.frame, self.document.bar
        packet = ghost_packet(self.mesh, frame, halfedge, operation, bar)
        self.telling.post(port, packet, request)

    def _prepare(self, port: Port, request: Request) -> None:
        """Behind the first view everything is made ready, if it is not."""
        kernel_warmup.PREPARATION.begin(self.loop, self._on_prepared)
        stage = kernel_warmup.PREPARATION.compiling
        if stage is not Stage.READY:
            self.telling.answer(port, request, "said", WAITS[stage])

    def _on_prepared(self) -> None:
        self.telling.notice("said", DONE[kernel_warmup.PREPARATION.compiling])

    # What happens here

    def _on_replaced(self) -> None:
        self.telling.start_over()
        self.agent.settle()

    def _on_score_changed(self) -> None:
        for port in self.telling.ports:
            port.show_score()

    def _on_agent_changed(self) -> None:
        self.telling.touch_agent()
        self.agent_changed.emit()

    def _on_said(self, words: str) -> None:
        self.telling.notice("said", sentence(words))

    def _on_failed(self, words: str) -> None:
        self.telling.notice("failed", sentence(words))

    def _on_broken(self, error: Exception) -> None:
        """A queued call has raised, and is in the log already."""
        self.telling.notice("failed", broken(error))


def broken(error: Exception) -> str:
    """What a person hears of a mistake of ours, or of a callback."""
    words = str(error).splitlines()[0][:120] if str(error) else ""
    told = f"{type(error).__name__}: {words}" if words else type(error).__name__
    return f"Something went wrong ({told}); the traceback is in the log."
