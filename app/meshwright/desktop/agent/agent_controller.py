"""The agent beside the person: what the window does about its runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtWidgets import QFileDialog

from meshwright.assistant.assistant import State
from meshwright.assistant.policy_catalogue import ENDING, kind_of
from meshwright.assistant.policy_catalogue import label as policy_label
from meshwright.assistant.search_runner import Effort
from meshwright.desktop.agent.hints_controller import Hints
from meshwright.desktop.canvas.layers.hints import percent
from meshwright.desktop.canvas.layers.policy_view import FieldLayer, sight
from meshwright.document.document import title_of
from meshwright.graphics.markers import label
from meshwright_core.core.kinds import ELEMENT_NOUN

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow
    from meshwright_agent.policy.explanation_types import Insight
    from meshwright_core import HalfEdgeMesh


class AgentControl:
    """Passes on what a person wants of the agent, and shows what the agent says and sees."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.hints = Hints(window)
        self.field: FieldLayer | None = None
        self._region: tuple[HalfEdgeMesh, np.ndarray] | None = None  # mesh, elements outside

    def connect(self) -> None:
        """Follow the assistant."""
        window, assistant = self._window, self._window.assistant
        overlay = window.canvas.overlay
        self.field = FieldLayer(window.theme, overlay.font())
        overlay.add(self.field, below=overlay.markers)
        overlay.add(self.field.above, below=overlay.arrow)
        self.hints.connect()
        window.agent_panel.use(window.settings)
        assistant.changed.connect(self._on_changed)
        assistant.insight_changed.connect(self._on_looked)
        assistant.message.connect(window.say)
        assistant.failed.connect(window.notice.tell)
        window.document.selection.changed.connect(window.refresh)

    def release(self) -> None:
        """End what runs, and let go of the assistant."""
        window, assistant = self._window, self._window.assistant
        assistant.close()
        self.hints.release()
        assistant.changed.disconnect(self._on_changed)
        assistant.insight_changed.disconnect(self._on_looked)
        assistant.message.disconnect(window.say)
        assistant.failed.disconnect(window.notice.tell)
        window.document.selection.changed.disconnect(window.refresh)

    @property
    def busy(self) -> bool:
        """A run is under way or held, or hints are shown: :meth:`stop` has something to end."""
        assistant = self._window.assistant
        active = assistant.running or assistant.state is State.PAUSED
        return active or assistant.hinting.asking or bool(self.hints.shown)

    # What a person asks for

    def play_or_pause(self) -> None:
        """Pause a played run; else play."""
        if self._window.assistant.state is State.PLAYING:
            self._window.assistant.pause()
        else:
            self._window.assistant.play()

    def best_of(self) -> None:
        """Run the policy as often as the panel says."""
        rollouts = self._window.agent_panel.rollouts
        self._window.assistant.search(Effort(rollouts=rollouts, seconds=None))

    def search(self) -> None:
        """Search as long as the panel says."""
        self._window.assistant.search(Effort(seconds=self._window.agent_panel.seconds))

    def finish_region(self) -> None:
        """Search in the selected region, as long as the panel says; nothing outside changes."""
        mesh = self._window.document.mesh
        elements = self._window.document.selection.elements
        if mesh is None or not len(elements):
            self._window.say("Select a region first: Shift and a drag over the mesh.")
            return
        outside = np.setdiff1d(mesh.element_ids(), elements, assume_unique=True)
        seconds = self._window.agent_panel.seconds
        self._window.assistant.search(Effort(seconds=seconds, elements=elements))
        if self._window.assistant.running:
            self._region = mesh, outside

    def stop(self) -> None:
        """End what is under way; what is done stays."""
        assistant = self._window.assistant
        if assistant.running or assistant.state is State.PAUSED:
            assistant.stop()
        else:
            self.hints.hide()

    def toggle_watch(self) -> None:
        """Show what the policy sees, or no longer."""
        self._window.assistant.watch = not self._window.assistant.watch

    def choose_policy(self) -> None:
        """Ask for a policy file, and follow it."""
        path, _ = QFileDialog.getOpenFileName(
            self._window,
            "Choose policy file",
            self._window.settings.text("agent/folder"),
            f"Policies (*{ENDING});;All files (*)",
        )
        if path:
            self.open_policy(path)

    def open_policy(self, path: str) -> None:
        """Follow the policy in a file; one sentence if that cannot be."""
        window = self._window
        try:
            kind = kind_of(path)
        except (ValueError, OSError) as error:
            window.notice.tell(str(error))
            return
        if window.document.kind and kind != window.document.kind:
            window.notice.tell(
                f"{Path(path).name} is a policy for {ELEMENT_NOUN[kind]} meshes; this is a"
                f" {ELEMENT_NOUN[window.document.kind]} mesh."
            )
            return
        window.settings.put("agent/folder", str(Path(path).parent))
        window.agent_panel.offer(path, kind)
        if window.document.kind:
            window.assistant.choose(path)

    # What the assistant says

    def _on_changed(self) -> None:
        self._window.refresh()
        if self._region is not None and not self._window.assistant.running:
            (mesh, outside), self._region = self._region, None
            if mesh is self._window.document.mesh:
                self._select_all_but(outside)

    def _select_all_but(self, outside: np.ndarray) -> None:
        """Select the corners of all elements but those outside: the region as it is now."""
        mesh = self._window.document.mesh
        if mesh is not None:
            inside = np.setdiff1d(mesh.element_ids(), outside, assume_unique=True)
            self._window.document.selection.set(mesh.corners(inside).ravel())

    def _on_looked(self) -> None:
        mesh, insight = self._window.document.mesh, self._window.assistant.insight
        if self.field is None:
            return
        if mesh is None or insight is None:
            self.field.show(None)
        else:
            self.field.show(sight(insight, mesh, self._words(insight, mesh.kind)))

    def _words(self, insight: Insight, kind: str) -> tuple[str, ...]:
        """What is seen, in three lines."""
        wanted = insight.wanted
        title = title_of(wanted.operation, kind)
        slots = len(insight.template)
        beyond = f", {insight.missing} slots beyond the boundary" if insight.missing else ""
        blocks = int(insight.field[:, 1].max(initial=0))
        policy = policy_label(self._window.assistant.policy)
        value = f"{insight.value:.2f}".replace("-", "\u2212")
        return (
            f"{policy} weighs {len(insight.halfedges)} half-edges; next: {title},"
            f" {percent(wanted.probability)}, \u0394s {label(wanted.change)}",
            f"Rings: its template, {slots} vertices by slot{beyond}",
            f"Tint: its field of view, {len(insight.field)} elements in {blocks} blocks"
            f"; value {value}",
        )
