"""The notebook widget."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Any, TypeVar

import anywidget
import traitlets

from meshwright.assistant.assistant import Assistant
from meshwright.assistant.search_runner import COMPLETE_SECONDS, Effort
from meshwright.document.document import Document
from meshwright.document.history import History, HistoryStep
from meshwright.graphics.export import mimebundle
from meshwright.notebook import bundle
from meshwright.notebook.arguments import (
    degree_of,
    operation_of,
    policy_of,
    positive,
    vertex_of,
    whole,
)
from meshwright.notebook.export import html_page, images
from meshwright.notebook.export.film_progress import shown_progress
from meshwright.notebook.export.images import SECONDS, SIZE, File
from meshwright.notebook.protocol.level_bridge import LevelBridge
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.notebook.session import Session
from meshwright.puzzles import level as levels
from meshwright.puzzles.level import Level
from meshwright.signals import Signal
from meshwright.sources import resolve
from meshwright_core import Edit, HalfEdgeMesh, MeshError, Operation, Verdict

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import PolicyAction
    from meshwright_core.domains.domain import Domain

Result = TypeVar("Result")

LOWEST, HIGHEST = 160, 4000
"""Bounds of a widget's height in pixels."""


class MeshWidget(anywidget.AnyWidget):
    """An editor for a mesh in a notebook cell, with the agent.

    Browser and Python edit the same document; several widgets on one document stay synchronised.
    ``widget.mesh`` is live: what a cell changes on it directly, without smoothing, is recorded as
    steps "Edit in Python" when the cell has ended, or at the next use of the widget.
    """

    # anywidget sends only traits of the class; their texts are defaults of the instance
    _esm = traitlets.Unicode().tag(sync=True)
    _css = traitlets.Unicode().tag(sync=True)
    height = traitlets.Int(464, min=LOWEST, max=HIGHEST).tag(sync=True)
    """Height of the canvas in pixels."""
    theme = traitlets.Enum(("auto", "light", "dark"), "auto").tag(sync=True)
    """Colours: as the notebook, always light, or always dark."""
    label = traitlets.Unicode("").tag(sync=True)
    """Name of the mesh, for the browser."""
    score = traitlets.Int(0, read_only=True).tag(sync=True)
    """Score s of the present mesh."""
    optimum = traitlets.Int(0, read_only=True).tag(sync=True)
    """Optimum s*, the lower bound of the score over all connectivities."""
    snapshot = traitlets.Dict().tag(sync=True)
    """What a saved notebook shows while no kernel runs: a recording of the history, or of the
    present state; kept up to date at the end of each cell and a moment after each change."""
    seen = traitlets.Int(0).tag(sync=True)
    """Counts changes made in the browser. marimo runs the cells that use a widget again when a
    trait is changed by the page; a message alone does not cause that."""

    def __init__(
        self,
        source: HalfEdgeMesh | Document | MeshWidget | Domain | str | Path | None = None,
        *,
        kind: str | None = None,
        policy: str | Path | None = None,
        level: str | Level | None = None,
        height: int = 464,
        theme: str = "auto",
        name: str = "",
        read_only: bool = False,
    ) -> None:
        """Show ``source``; a document, also that of another widget, is shared and not copied.

        Args:
            source: see :func:`meshwright.sources.resolve.document`; or another widget.
            kind: elements to mesh a shape with, "tri" or "quad"; quads by default.
            policy: policy of the agent: the name of a shipped one, or a file; by default the first
                that is shipped for this kind of mesh.
            level: name of a level to play, instead of a source.
            height: height of the canvas in pixels.
            theme: "auto" (as the notebook), "light" or "dark".
            name: name of the mesh.
            read_only: whether the browser may not edit; Python still may.

        Raises:
            MeshError: source, level or policy is not valid.
            traitlets.TraitError: height or theme is not valid.
        """
        self._connected: list[tuple[Signal, Callable[..., None]]] = []
        self.read_only = bool(read_only)
        if level is not None and not (source is None and kind is None):
            raise MeshError("A level brings its own mesh: leave source and kind out.")
        wanted = levels.load(level) if isinstance(level, str) else level
        if not isinstance(wanted, Level | None):
            raise MeshError(f"A level must be the name of one, not {shortened(level)}.")
        shown = source.document if isinstance(source, MeshWidget) else source
        document = Document() if wanted is not None else resolve.document(shown, kind, name)
        session = self.session = Session.of(document)
        try:
            if wanted is not None:
                LevelBridge.of(session).begin(wanted)
            if policy is not None:
                session.agent.choose(policy_of(policy))
            super().__init__(height=height, theme=theme, label=name or document.name)
        except BaseException:
            session.end_if_alone()  # no widget shows the document: disconnect from it
            raise
        session.join(self)
        self.show_score()
        session.touch_snapshot()

    @traitlets.default("_esm")
    def _module(self) -> str:
        return bundle.module()

    @traitlets.default("_css")
    def _style(self) -> str:
        return bundle.style()

    # State

    @property
    def document(self) -> Document:
        """The document, shared by all views: mesh, history, selection and their events."""
        return self.session.document

    @property
    def mesh(self) -> HalfEdgeMesh:
        """The live mesh; MeshError while there is none."""
        return self.session.mesh

    @property
    def history(self) -> History:
        """The history, one row for every step."""
        return self.document.history

    @property
    def assistant(self) -> Assistant:
        """Runs the agent; shared by all widgets on the document."""
        return self.session.assistant

    @property
    def at_optimum(self) -> bool:
        """True if s = s*."""
        return self.document.at_optimum

    @property
    def level(self) -> Level | None:
        """The level being played, or None."""
        return self.session.level

    @property
    def stars(self) -> int:
        """Stars earned in the level: 0 before the goal is reached, and without a level."""
        return LevelBridge.of(self.session).play.stars if self.session.level is not None else 0

    # Editing

    def check(self, operation: Operation | str, halfedge: int) -> Verdict:
        """Whether an operation is allowed at a half-edge: true, or false with a ``reason``."""
        action, at = operation_of(self.mesh, operation), whole(halfedge, "half-edge")
        return self._do(lambda: self.document.check(action, at))

    def apply(self, operation: Operation | str, halfedge: int) -> Edit:
        """Apply an operation and smooth around it, as one step; OperationRefused if refused."""
        action, at = operation_of(self.mesh, operation), whole(halfedge, "half-edge")
        return self._do(lambda: self.document.submit(action, at))

    def undo(self) -> HistoryStep | None:
        """Undo the last step; returns its row, or None without one."""
        return self._do(self.document.undo)

    def redo(self) -> HistoryStep | None:
        """Redo the step that was undone last; returns its row, or None without one."""
        return self._do(self.document.redo)

    def go_to(self, cursor: int) -> None:
        """Undo or redo until ``cursor`` steps are applied, clipped to the length of the history."""
        step = whole(cursor, "step")
        self._do(lambda: self.document.go_to(step))

    def smooth(self) -> None:
        """Smooth and untangle the whole mesh, as one step."""
        self._do(self.document.smooth)

    def untangle(self) -> tuple[int, int]:
        """Repair inverted elements; returns their numbers before and after."""
        return self._do(self.document.untangle)

    def clean_all(self) -> int:
        """Remove every removable global line of a quad mesh; returns their number."""
        return self._do(self.document.clean_all)

    def set_desired(self, vertex: int, degree: int) -> None:
        """Set the desired degree of a vertex; s and s* change with it."""
        self._do(lambda: self.document.set_desired(vertex_of(self.mesh, vertex), degree_of(degree)))

    def lock(self, vertex: int, flag: bool = True) -> None:
        """Lock a vertex, so that it is neither moved nor removed, or unlock it."""
        self._do(lambda: self.document.set_locked(vertex_of(self.mesh, vertex), bool(flag)))

    def corner(self, vertex: int, flag: bool = True) -> None:
        """Make a vertex a corner, which keeps its position, or undo that."""
        self._do(lambda: self.document.set_geometric(vertex_of(self.mesh, vertex), bool(flag)))

    # The agent

    def play(
        self, policy: str | Path | None = None, *, speed: float | None = None, wait: bool = False
    ) -> None:
        """Start the agent; its steps are shown while the notebook stays usable.

        Args:
            policy: policy to use from now on.
            speed: decisions per second from now on.
            wait: return only at the end of the run, which then runs at full speed.

        Raises:
            MeshError: the policy does not fit, or (where the call waits) the run failed.
        """
        agent = self.session.agent
        rate = positive(speed, "speed") if speed is not None else None
        self._choose(policy)
        self._start(lambda: agent.play(rate, hurry=wait), wait)

    def step(self, policy: str | Path | None = None, wait: bool = True) -> None:
        """One decision of the agent: an operation and the line removals that follow it."""
        self._choose(policy)
        self._start(self.assistant.step, wait)

    def pause(self) -> None:
        """Pause a run; :meth:`play` and :meth:`step` continue it."""
        self._do(self.assistant.pause)

    def complete(self, seconds: float = COMPLETE_SECONDS, wait: bool = True) -> None:
        """Search for ``seconds``, and go to the best state found.

        Showing the way there takes up to a tenth of the time and half a second more, and loading
        the policy and compiled code on first use a few seconds.
        """
        limit = positive(seconds, "seconds")
        effort = Effort(seconds=limit, shown=min(0.1 * limit + 0.5, 2.0))
        self._start(lambda: self.assistant.search(effort), wait)

    def hint(self, wait: bool = True) -> tuple[PolicyAction, ...]:
        """The operations with the highest probability under the policy in the present state.

        Where the call does not wait: the hints that are known already, possibly none.
        """
        self._start(self.assistant.hint, wait)
        return self.assistant.hinting.hints

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the agent is idle; returns False if that took longer than ``timeout`` s.

        The browsers are updated in the meantime.
        """
        return self.session.wait(timeout)

    def _choose(self, policy: str | Path | None) -> None:
        if policy is not None:
            self._do(lambda: self.session.agent.choose(policy_of(policy)))

    def _start(self, begin: Callable[[], None], wait: bool) -> None:
        if wait:
            self.session.finish(begin)
        else:
            self._do(begin)

    # Events

    def on(self, event: str, callback: Callable[..., Any]) -> Callable[[], None]:
        """Call ``callback`` at every ``event``; returns a function that disconnects it.

        Events are "changed", "history" (no arguments), "score" (s), "hover" (a half-edge or -1),
        "agent" (its state, a word) and "level" (the level or None). An exception in a callback is
        logged and shown in the browser.
        """
        if not callable(callback):
            raise MeshError(f"A callback must be callable, not {shortened(callback)}.")
        session, document = self.session, self.document
        events: dict[str, tuple[Signal, Callable[..., tuple[Any, ...]]]] = {
            "changed": (document.changed, lambda: ()),
            "score": (document.score_changed, lambda: (document.score,)),
            "history": (document.history_changed, lambda: ()),
            "hover": (document.hover_changed, lambda halfedge: (halfedge,)),
            "agent": (session.agent_changed, lambda: (str(session.assistant.state),)),
            "level": (session.level_changed, lambda level: (level,)),
        }
        if event not in events:
            raise MeshError(f"There is no event {event!r}; there are {', '.join(events)}.")
        signal, values = events[event]

        def slot(*arguments: Any) -> None:
            session.call_back(callback, *values(*arguments))

        entry = (signal, signal.connect(slot))
        self._connected.append(entry)

        def disconnect() -> None:
            signal.disconnect(slot)
            if entry in self._connected:
                self._connected.remove(entry)

        return disconnect

    # Files. A file is written whole or not at all. All methods raise MeshError, in one sentence,
    # where there is no mesh or the file cannot be written.

    def to_html(self, path: File = None, *, title: str = "") -> str:
        """The recording of the history as one HTML page that needs neither Python nor network."""
        return self._do(lambda: html_page.page(self.document, str(title), path))

    def save(self, path: str | os.PathLike[str] | None = None) -> Path:
        """Write the mesh to ``path``, or to where it came from; returns where it is now.

        A project, ``.meshwright``, holds the history with its branches too.
        """
        return self._do(lambda: self.document.save(None if path is None else Path(path)))

    def to_png(self, path: File = None, size: tuple[int, int] = SIZE, halfedge: int = -1) -> bytes:
        """An image of the mesh in its present state, ``size`` in pixels; with an arrow for
        ``halfedge``.
        """
        theme = self._export_theme
        return self._do(lambda: images.png(self.document, size, path, theme, halfedge))

    def to_svg(self, path: File = None, size: tuple[int, int] = SIZE, halfedge: int = -1) -> str:
        """The same image as SVG."""
        theme = self._export_theme
        return self._do(lambda: images.svg(self.document, size, path, theme, halfedge))

    def to_gif(
        self, path: File = None, seconds: float = SECONDS, size: tuple[int, int] = SIZE
    ) -> bytes:
        """The history as an animated GIF; each frame lasts ``seconds``. It can be interrupted."""
        theme = self._export_theme
        with shown_progress() as report:
            return self._do(lambda: images.gif(self.document, seconds, size, path, theme, report))

    def to_mp4(
        self, path: File = None, seconds: float = SECONDS, size: tuple[int, int] = SIZE
    ) -> bytes:
        """The history as MP4 (H.264); each frame lasts ``seconds``. It can be interrupted."""
        theme = self._export_theme
        with shown_progress() as report:
            return self._do(lambda: images.mp4(self.document, path, seconds, size, theme, report))

    @property
    def _export_theme(self) -> str:
        """Light unless the widget is always dark: where an image is shown later is unknown."""
        return "dark" if self.theme == "dark" else "light"

    # The widget in the notebook

    def _repr_mimebundle_(self, **options: Any) -> tuple[dict[str, Any], dict[str, Any]] | None:
        """The widget, and a static image for viewers of the saved notebook without a kernel."""
        bundle = super()._repr_mimebundle_(**options)
        mesh = self.document.mesh
        if bundle is None or mesh is None or not self.reachable:
            return bundle
        data, metadata = bundle
        image, image_metadata = self._do(lambda: mimebundle.still(mesh))
        return data | image, metadata | image_metadata

    def close(self) -> None:
        """Remove all views. The agent's thread ends with the document's last widget."""
        session = self.__dict__.get("session")  # an __init__ that has failed leaves none
        if session is not None:
            for signal, slot in self._connected:
                signal.disconnect(slot)
            self._connected.clear()
            session.leave(self)
        super().close()

    @property
    def reachable(self) -> bool:
        """Whether the connection is open; marimo closes it when the cell runs again."""
        return self.comm is not None and not getattr(self.comm, "_closed", False)

    def post(self, packet: Packet) -> None:
        """For the session: send a message to all views."""
        self.send(packet.content, packet.buffers)

    def __repr__(self) -> str:
        """The mesh in one line."""
        session = self.__dict__.get("session")
        mesh = session.document.mesh if session is not None else None
        return f"<{type(self).__name__} of {mesh!r}>" if mesh is not None else object.__repr__(self)

    def show_score(self) -> None:
        """For the session: update score and optimum."""
        self.set_trait("score", self.document.score)
        self.set_trait("optimum", self.document.optimum)

    def keep(self, snapshot: dict[str, Any]) -> None:
        """For the session: keep a snapshot for the saved notebook."""
        self.snapshot = snapshot

    def set_state(self, sync_data: Any) -> None:
        """Ignore traits set by the browser: it sends requests as messages."""

    def _handle_msg(self, message: Any) -> None:
        """Handle any message from the browser; never raises."""
        content = message.get("content") if isinstance(message, dict) else None
        data = content.get("data") if isinstance(content, dict) else None
        data = data if isinstance(data, dict) else {}
        method = data.get("method")
        if method == "request_state":
            self.send_state()
        elif method != "update":
            custom = method == "custom"
            buffers = message.get("buffers") if custom else None
            self.session.receive(self, data.get("content") if custom else None, buffers)

    def _do(self, call: Callable[[], Result]) -> Result:
        """The result of ``call()`` in the thread that owns the document."""
        return self.session.do(call)
