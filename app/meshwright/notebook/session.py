"""The state that all widgets on one document share."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, TypeVar
from weakref import WeakValueDictionary, finalize

from msgspec import UNSET

from meshwright.assistant.assistant import Assistant
from meshwright.assistant.kernel_preparation import Stage
from meshwright.document.document import NO_MESH, Document
from meshwright.graphics.export import mimebundle
from meshwright.graphics.export.mimebundle import PNG
from meshwright.notebook import kernel_warmup
from meshwright.notebook.cell_events import on_cell_end
from meshwright.notebook.export.snapshot import MOST_ELEMENTS, snapshot
from meshwright.notebook.kernel_warmup import DONE, WAITS
from meshwright.notebook.protocol.agent_bridge import AgentBridge
from meshwright.notebook.protocol.broadcaster import Broadcaster, Port
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.notebook.protocol.preview_messages import COARSE, ghost_packet, no_ghost
from meshwright.notebook.protocol.request_handlers import (
    HANDLERS,
    Handler,
    require_halfedge,
    require_operation,
)
from meshwright.notebook.protocol.requests import (
    Hello,
    Hover,
    RefusedError,
    Request,
    Still,
    parse,
)
from meshwright.notebook.thread_loop import ThreadLoop
from meshwright.signals import Signal
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.errors import sentence

Result = TypeVar("Result")

NEEDS: dict[Stage, tuple[str, ...]] = {
    Stage.EDITING: ("operate", "smooth", "untangle", "clean_all", "agent", "take_hint", "level"),
    Stage.AGENT: ("agent",),
}
"""Requests that are refused while a stage is compiled for the first time."""

SNAPSHOT_AFTER = 1.0
"""Seconds after a change at which the snapshot is made."""

_log = logging.getLogger(__name__)


class Session:
    """A document with its assistant and all widgets that show it.

    It exists as long as one of the widgets. All work is done in the thread that created it, from
    whichever thread a message comes. Events: ``agent_changed()`` after a change of the agent's
    state, ``level_changed(level)`` emitted by the level bridge.
    """

    _all: ClassVar[WeakValueDictionary[int, Session]] = WeakValueDictionary()

    def __init__(self, document: Document) -> None:
        """Use :meth:`of`, which returns the existing session of a document."""
        self.document = document
        self.loop = ThreadLoop(self._on_broken)
        self.assistant = Assistant(document, self.loop)
        self.agent = AgentBridge(document, self.assistant, self.loop)
        self.broadcaster = Broadcaster(document, self.agent, self.loop)
        self.agent_changed = Signal()
        self.level_changed = Signal()
        self.handlers: dict[type[Request], Handler] = dict(HANDLERS)
        """By type of request; other parts of the notebook may add theirs."""
        self.welcome_messages: list[Callable[[], Packet]] = []
        """Further messages that a new view gets."""
        self.guards: list[Callable[[Request], str]] = []
        """Called before the handler of a request: a sentence refuses the request."""
        self.on_end: list[Callable[[], None]] = []
        """Called once, when no widget is left."""
        self.level: Any = None
        """The level being played, or None."""
        self._hovers: dict[str, tuple[Port, Hover]] = {}
        self._calling = self._ended = False
        self._cells = on_cell_end(self.catch_up)
        self._snapshot_due = self._snapshot_late = self._stills_wanted = False
        self.agent.settle()
        document.replaced.connect(self._on_replaced)
        document.changed.connect(self.broadcaster.follow)
        document.changed.connect(self.touch_snapshot)
        document.score_changed.connect(self._on_score_changed)
        self.assistant.changed.connect(self._on_agent_changed)
        self.assistant.hinting.changed.connect(self._on_agent_changed)
        self.assistant.message.connect(self._on_message)
        self.assistant.failed.connect(self._on_failed)

    @classmethod
    def of(cls, document: Document) -> Session:
        """The session of a document; created if no widget shows it yet."""
        for session in list(cls._all.values()):
            if session.loop.here:  # marimo runs each browser session in its own thread
                for port in session.broadcaster.lost:
                    port.close()
        found = cls._all.get(id(document))  # the session holds the document: the id is not reused
        if found is None:
            found = cls._all[id(document)] = cls(document)
        return found

    @property
    def mesh(self) -> HalfEdgeMesh:
        """The mesh; MeshError while there is none."""
        if self.document.mesh is None:
            raise MeshError(NO_MESH)
        return self.document.mesh

    # Widgets

    def join(self, port: Port) -> None:
        """Add a widget that shows the document."""
        self.broadcaster.add(port)
        finalize(port, self.end_if_alone).atexit = False

    def leave(self, port: Port) -> None:
        """Remove a widget that was closed; after the last one the agent's thread ends."""
        self.broadcaster.remove(port)
        self._hovers = {view: kept for view, kept in self._hovers.items() if kept[0] is not port}
        self.end_if_alone()

    def end_if_alone(self) -> None:
        """Close the session if no widget shows the document."""
        if self._ended or not self.broadcaster.alone:
            return
        if self._all.get(id(self.document)) is self:
            del self._all[id(self.document)]
        self._ended = True
        self._cells()
        for end in self.on_end:
            end()
        self.assistant.close()
        self.document.replaced.disconnect(self._on_replaced)
        self.document.changed.disconnect(self.broadcaster.follow)
        self.document.changed.disconnect(self.touch_snapshot)
        self.document.score_changed.disconnect(self._on_score_changed)

    # Calls from Python

    def catch_up(self) -> None:
        """At the end of a cell: record and show what it has changed on the mesh itself, and keep
        a snapshot; never raises.
        """
        try:
            self.document.catch_up()
            self.keep_snapshot()
        except Exception as error:  # must not reach the notebook's cell
            _log.error("changes of the mesh could not be recorded", exc_info=error)

    def do(self, call: Callable[[], Result]) -> Result:
        """The result of ``call()``, called in the thread that owns the document."""
        self._require_open()
        return self.loop.do(call)

    def wait(self, timeout: float | None = None) -> bool:
        """Process calls until the agent is idle; returns False at the timeout (s)."""
        self._require_open()
        self._refuse_wait_in_callback()
        return self.loop.pump(lambda: self.agent.idle, timeout)

    def finish(self, begin: Callable[[], None]) -> None:
        """Call ``begin()``, which starts an agent's run, and wait for its end, in any thread.

        Raises MeshError where the run failed. An interrupt cancels the run.
        """
        self._refuse_wait_in_callback()
        failures: list[str] = []
        self.do(lambda: self.assistant.failed.connect(failures.append))
        try:
            self.do(begin)
            self.wait()
        except KeyboardInterrupt:
            if self.loop.here:
                self.assistant.cancel()  # a queued call could cancel the next run
            else:
                self.loop(self.assistant.cancel)
            raise
        finally:
            self.assistant.failed.disconnect(failures.append)
        self.loop.do(self.broadcaster.catch_up)
        if failures:
            raise MeshError(failures[-1])

    def call_back(self, callback: Callable[..., Any], *arguments: Any) -> None:
        """Call a user's callback; an exception in it is logged and shown, and not raised."""
        outer, self._calling = self._calling, True
        try:
            callback(*arguments)
        except Exception as error:  # user code: it must not stop the document's event
            _log.error("a callback failed", exc_info=error)
            self.broadcaster.notice("failed", broken(error))
        finally:
            self._calling = outer

    def _refuse_wait_in_callback(self) -> None:
        if self._calling and self.loop.here:
            raise MeshError("A callback cannot wait for the agent: it would block itself.")

    def _require_open(self) -> None:
        if self._ended:
            raise MeshError("This widget is closed; make another one on its document.")

    # The snapshot for the saved notebook

    def touch_snapshot(self) -> None:
        """The snapshot is outdated: make another one a moment after the last change."""
        self._snapshot_late = self._snapshot_due
        if not self._snapshot_due:
            self._snapshot_due = True
            self.loop.later(SNAPSHOT_AFTER, self._on_snapshot_due)

    def _on_snapshot_due(self) -> None:
        if self._snapshot_late and not self._ended:  # changed meanwhile: wait again
            self._snapshot_late = False
            self.loop.later(SNAPSHOT_AFTER, self._on_snapshot_due)
        else:
            self.keep_snapshot()

    def keep_snapshot(self) -> None:
        """Give all widgets a snapshot, if theirs is outdated."""
        if not self._snapshot_due or self._ended or self.assistant.running:
            return
        self._snapshot_due = self._snapshot_late = False
        try:
            made = snapshot(self.document)
            for port in self.broadcaster.ports:
                port.keep(made)
            if self._stills_wanted:
                self._send_still()
        except Exception as error:  # must not reach the notebook's cell
            _log.error("the snapshot could not be made", exc_info=error)

    def _send_still(self) -> None:
        """Send the static picture to all pages: those in JupyterLab keep it in the notebook.

        It takes 40 ms, and a quarter of a second for 6,000 quads; of very large meshes, as there
        is no snapshot of them either, the notebook keeps the first.
        """
        mesh = self.document.mesh
        if mesh is None or mesh.n_elements > MOST_ELEMENTS:
            return
        data, metadata = mimebundle.still(mesh)
        content = {"type": "still", "image": data[PNG], "metadata": metadata[PNG]}
        for port in self.broadcaster.ports:
            self.broadcaster.post(port, Packet({**content, "model_id": port.model_id}))

    # Requests from browsers

    def receive(self, port: Port, content: Any, buffers: Sequence[Any] | None = None) -> None:
        """Handle a message from a widget's browser, in any thread; never raises."""
        try:
            request = parse(content, buffers)
        except RefusedError as error:
            self.broadcaster.answer(port, error.sender, "refused", error.sentence)
            return
        if isinstance(request, Hover):
            self._hovers[request.view] = port, request  # only the latest of a view is answered
        if self.loop.here:
            self._handle(port, request)
        else:
            self.loop(lambda: self._handle(port, request))

    def _handle(self, port: Port, request: Request) -> None:
        self.broadcaster.hold(request)
        try:
            self.document.catch_up()
            self._dispatch(port, request)
        except MeshError as error:
            self.broadcaster.answer(port, request, "refused", sentence(str(error)))
        except Exception as error:  # a bug: shown and logged, and the kernel keeps running
            _log.error("request '%s' failed", request.word, exc_info=error)
            self.broadcaster.answer(port, request, "failed", broken(error))
        finally:
            self.broadcaster.release()

    def _dispatch(self, port: Port, request: Request) -> None:
        if isinstance(request, Hello):
            self.broadcaster.send_state(port, request)
            for greeting in self.welcome_messages:
                self.broadcaster.post(port, greeting(), request)
            self._prepare(port, request)
        elif isinstance(request, Hover):
            self._preview(request)
        elif isinstance(request, Still):
            self._stills_wanted = True
            self._send_still()
        elif port.read_only:
            raise MeshError("this view is read-only")
        elif type(request) not in self.handlers:
            raise MeshError(f"'{request.word}' is not available here")
        elif request.word in NEEDS.get(kernel_warmup.PREPARATION.compiling, ()):
            raise MeshError(WAITS[kernel_warmup.PREPARATION.compiling])
        else:
            why = next(filter(None, (guard(request) for guard in self.guards)), "")
            if why:
                raise MeshError(why)
            answer = self.handlers[type(request)](self, request)
            if answer:
                self.broadcaster.answer(port, request, "info", answer)

    def _preview(self, request: Hover) -> None:
        latest = self._hovers.pop(request.view, None)
        if latest is None:
            return  # superseded by a later one
        port, request = latest
        halfedge, operation = request.halfedge, request.operation
        if halfedge < 0 or kernel_warmup.PREPARATION.compiling is Stage.EDITING:
            self.document.hover = -1
            self.broadcaster.post(port, no_ghost(), request)
            return
        require_halfedge(self.mesh, halfedge)
        if operation is not None:
            require_operation(self.mesh.kind, operation)
        self.document.hover = halfedge
        frame, bar = self.broadcaster.mesh_sync.frame, self.document.bar
        tolerance = COARSE if request.tolerance is UNSET else request.tolerance
        packet = ghost_packet(self.mesh, frame, halfedge, operation, bar, tolerance)
        self.broadcaster.post(port, packet, request)

    def _prepare(self, port: Port, request: Request) -> None:
        """With the first view: start compiling the kernels, if they are not compiled."""
        kernel_warmup.PREPARATION.begin(self.loop, self._on_prepared)
        stage = kernel_warmup.PREPARATION.compiling
        if stage is not Stage.READY:
            self.broadcaster.answer(port, request, "info", WAITS[stage])

    def _on_prepared(self) -> None:
        self.broadcaster.notice("info", DONE[kernel_warmup.PREPARATION.compiling])

    # Events

    def _on_replaced(self) -> None:
        self.broadcaster.start_over()
        self.agent.settle()

    def _on_score_changed(self) -> None:
        for port in self.broadcaster.ports:
            port.show_score()

    def _on_agent_changed(self) -> None:
        self.broadcaster.touch_agent()
        self.agent_changed.emit()
        if self._snapshot_due and not self.assistant.running:
            self.loop.later(SNAPSHOT_AFTER, self.keep_snapshot)

    def _on_message(self, text: str) -> None:
        self.broadcaster.notice("info", sentence(text))

    def _on_failed(self, text: str) -> None:
        self.broadcaster.notice("failed", sentence(text))

    def _on_broken(self, error: Exception) -> None:
        """A queued call has raised; the traceback is in the log already."""
        self.broadcaster.notice("failed", broken(error))


def broken(error: Exception) -> str:
    """The sentence shown for an unexpected exception in the library or in a callback."""
    first_line = str(error).splitlines()[0][:120] if str(error) else ""
    what = f"{type(error).__name__}: {first_line}" if first_line else type(error).__name__
    return f"Something went wrong ({what}); the traceback is in the log."
