"""Runs of the agent, started by the user and shown in the window."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QFileDialog, QWidget

from meshwright.assistant.assistant import Assistant, State
from meshwright.assistant.policy_catalogue import ENDING, kind_of
from meshwright.assistant.policy_catalogue import label as policy_label
from meshwright.assistant.search_runner import Effort
from meshwright.desktop.agent.agent_panel import AgentPanel
from meshwright.desktop.agent.hints_controller import HintsController
from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.hints import percent
from meshwright.desktop.canvas.layers.policy_view import FieldLayer, sight
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document, title_of
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme
from meshwright_core.core.kinds import ELEMENT_NOUN

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight
    from meshwright_core import HalfEdgeMesh

IDLE = 1500
"""Milliseconds without a change or a hover after which the policy is loaded."""


class AgentController(Controller):
    """Starts and stops runs of the policy, and shows what the policy sees."""

    def __init__(
        self,
        document: Document,
        assistant: Assistant,
        canvas: Canvas,
        settings: Settings,
        panel: AgentPanel,
        hints: HintsController,
        status: StatusBar,
        notice: NoticeBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._assistant, self._settings = document, assistant, settings
        self._canvas, self._panel, self._hints = canvas, panel, hints
        self._status, self._notice, self._parent = status, notice, parent
        self._region: tuple[HalfEdgeMesh, np.ndarray] | None = None  # mesh, elements outside
        self._readiness: Readiness | None = None
        self._prepared = False
        self._idle = QTimer(parent, singleShot=True, interval=IDLE)
        self._idle.timeout.connect(self._on_idle)
        overlay = canvas.overlay
        self.field = FieldLayer(theme, overlay.font())
        overlay.add(self.field, below=overlay.markers)
        overlay.add(self.field.above, below=overlay.arrow)
        self._connections.add(assistant.changed, self._on_changed)
        self._connections.add(assistant.insight_changed, self._on_looked)
        self._connections.add(assistant.message, status.show_message)
        self._connections.add(assistant.failed, notice.show_message)

    def prepare_while_idle(self, readiness: Readiness) -> None:
        """Load the policy once nobody has done anything for a moment, so that the first run need
        not wait for it.
        """
        self._readiness = readiness
        for signal in (readiness.changed, self._document.changed, self._document.hover_changed):
            self._connections.add(signal, self._await_idle)
        self._await_idle()

    def _await_idle(self, *_: object) -> None:
        if self._readiness is not None and not self._prepared:
            self._idle.start()

    def _on_idle(self) -> None:
        assistant, readiness = self._assistant, self._readiness
        ready = readiness is not None and readiness.agent and bool(assistant.policy)
        if ready and not assistant.running and not assistant.loading:
            self._prepared = True
            assistant.prepare()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        self._panel.set_theme(theme)

    def close(self) -> None:
        """End what runs, and disconnect."""
        self._idle.stop()
        self._assistant.close()
        super().close()
        self._panel.release()

    @property
    def busy(self) -> bool:
        """Whether :meth:`stop` would end something: a run, a paused run, or hints."""
        assistant = self._assistant
        active = assistant.running or assistant.state is State.PAUSED
        return active or assistant.hinting.asking or bool(self._hints.shown)

    # Commands

    def play_or_pause(self) -> None:
        """Pause a played run; else play."""
        if self._assistant.state is State.PLAYING:
            self._assistant.pause()
        else:
            self._assistant.play()

    def _wished(self, effort: Effort) -> Effort:
        """The effort with what the panel says of blocks, shape and size."""
        panel = self._panel
        return replace(effort, prefer=panel.preference, keep_size=panel.keep_size.isChecked())

    def complete(self) -> None:
        """Search until s* and the wanted shape are reached or nothing more is won."""
        self._assistant.search(self._wished(Effort(until_done=True)))

    def best_of(self) -> None:
        """Run the policy as often as set in the panel, and apply the best result."""
        rollouts = self._panel.rollouts
        self._assistant.search(
            Effort(rollouts=rollouts, seconds=None, prefer=self._panel.preference, beyond=True)
        )

    def search(self) -> None:
        """Search for the time set in the panel."""
        self._assistant.search(self._wished(Effort(seconds=self._panel.seconds, beyond=True)))

    def finish_region(self) -> None:
        """Search in the selected region for the time set in the panel; the rest of the mesh is
        unchanged.
        """
        mesh = self._document.mesh
        elements = self._document.selection.elements
        if mesh is None or not len(elements):
            self._status.show_message("Select a region first: Shift+drag over the mesh.")
            return
        outside = np.setdiff1d(mesh.element_ids(), elements, assume_unique=True)
        seconds = self._panel.seconds
        self._assistant.search(Effort(seconds=seconds, elements=elements))
        if self._assistant.running:
            self._region = mesh, outside

    def stop(self) -> None:
        """End the run, or hide the hints; operations that were applied are kept."""
        assistant = self._assistant
        if assistant.running or assistant.state is State.PAUSED:
            assistant.stop()
        else:
            self._hints.hide()

    def toggle_watch(self) -> None:
        """Show or hide what the policy sees."""
        self._assistant.watch = not self._assistant.watch

    def choose_policy(self) -> None:
        """Ask for a policy file, and use it."""
        path, _ = QFileDialog.getOpenFileName(
            self._parent,
            "Load policy file",
            self._settings.text("agent/folder"),
            f"Policies (*{ENDING});;All files (*)",
        )
        if path:
            self.open_policy(path)

    def open_policy(self, path: str) -> None:
        """Use the policy in a file; a notice is shown if it is unreadable or of another kind."""
        try:
            kind = kind_of(path)
        except (ValueError, OSError) as error:
            self._notice.show_message(str(error))
            return
        if self._document.kind and kind != self._document.kind:
            self._notice.show_message(
                f"{Path(path).name} is a policy for {ELEMENT_NOUN[kind]} meshes; this is a"
                f" {ELEMENT_NOUN[self._document.kind]} mesh."
            )
            return
        self._settings.put("agent/folder", str(Path(path).parent))
        self._panel.offer(path, kind)
        if self._document.kind:
            self._assistant.choose(path)

    # Following the assistant

    def _on_changed(self) -> None:
        if self._region is not None and not self._assistant.running:
            (mesh, outside), self._region = self._region, None
            if mesh is self._document.mesh:
                self._select_all_but(outside)

    def _select_all_but(self, outside: np.ndarray) -> None:
        """Select the corners of all elements that are not in ``outside``."""
        mesh = self._document.mesh
        if mesh is not None:
            inside = np.setdiff1d(mesh.element_ids(), outside, assume_unique=True)
            self._document.selection.set(mesh.corners(inside).ravel())

    def _on_looked(self) -> None:
        mesh, insight = self._document.mesh, self._assistant.insight
        if mesh is None or insight is None:
            self.field.show(None)
        else:
            words = self._words(insight, mesh.kind)
            self.field.show(sight(insight, mesh, words, self._canvas.edges))

    def _words(self, insight: Insight, kind: str) -> tuple[str, ...]:
        """The legend of what the policy sees, in three lines."""
        wanted = insight.wanted
        title = title_of(wanted.operation, kind)
        slots = len(insight.template)
        beyond = f", {insight.missing} slots beyond the boundary" if insight.missing else ""
        blocks = int(insight.field[:, 1].max(initial=0))
        policy = policy_label(self._assistant.policy)
        value = f"{insight.value:.2f}".replace("-", "\u2212")
        return (
            f"Policy {policy} rates {len(insight.halfedges)} half-edges; next: {title},"
            f" {percent(wanted.probability)}, \u0394s {label(wanted.change)}",
            f"Rings: template, {slots} vertices by slot{beyond}",
            f"Tint: field of view, {len(insight.field)} elements in {blocks} blocks; value {value}",
        )
