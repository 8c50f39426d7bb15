"""The Blocks view: shows chords, numbers of cells and the fine grid, and selects."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from qtpy.QtCore import QPointF, Qt

from meshwright.desktop.blocks.blocks_panel import GROWTH, BlocksPanel, ChordShown
from meshwright.desktop.blocks.chord_tools import ChordTools
from meshwright.desktop.blocks.preview_job import PreviewJob
from meshwright.desktop.blocks.slide_gesture import SlideLine
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.gestures import Gesture
from meshwright.desktop.canvas.layers.blocks import BlocksLayer, BlocksShown, GridLinesLayer
from meshwright.desktop.canvas.mouse import Click
from meshwright.desktop.controller import Controller
from meshwright.desktop.editing.hover_controller import HoverController
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.block_preview import (
    ALONG_CURVES,
    MOST_CELLS,
    GridPreview,
    PlannedBlocks,
)
from meshwright.document.document import Document
from meshwright.graphics.colouring import chord_colours
from meshwright.graphics.theme import Theme
from meshwright.signals import Signal
from meshwright_core import MeshError
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.core.grid_plan import Grading
from meshwright_core.errors import sentence

REACH = 9.0
"""Distance in pixels at which an edge counts as under the mouse."""


class BlocksController(Controller):
    """Shows the blocks while :attr:`shown`; ``changed()`` when that, or the selection, is another.

    The selected edge is kept by its two vertices, so that it survives edits elsewhere.
    """

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        hover: HoverController,
        actions: ActionSet,
        status: StatusBar,
        notice: NoticeBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._hover = document, canvas, hover
        self._status, self._notice = status, notice
        self.changed = Signal()
        self.shown = False
        self.planned: PlannedBlocks | None = None
        self.panel = BlocksPanel(actions, theme)
        self.grid = GridLinesLayer(theme)
        self.layer = BlocksLayer(theme, canvas.font())
        canvas.overlay.add(self.grid, below=canvas.overlay.markers)
        canvas.overlay.add(self.layer, below=canvas.overlay.markers)
        self.job = PreviewJob(canvas)
        self.job.ready.connect(self._on_preview)
        self.job.failed.connect(notice.show_message)
        self._edge: tuple[int, int] | None = None
        self._block = -1  # the element that is the selected block
        self._said = ""
        self._bent: list[np.ndarray] | None = None
        """The block edges where the fine grid has them, of the structure in `_bent_of`."""
        self._bent_of: BlockStructure | None = None
        self._before = canvas.gesture_at
        canvas.gesture_at = self._gesture_at
        canvas.hovered.connect(self._on_hovered)
        self._connections.add(document.changed, self._on_changed)
        self._connections.add(document.replaced, self._on_replaced)
        panel = self.panel
        self.tools = ChordTools(document, self, status)
        panel.count_set.connect(self.tools.set_count)
        panel.count_freed.connect(lambda: self.tools.set_count(None))
        panel.grading_set.connect(self.tools.set_grading)
        panel.size_set.connect(self.tools.set_size)
        panel.chord_chosen.connect(self.select_chord)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        self.panel.set_theme(theme)
        self.show_selection()

    def close(self) -> None:
        """Disconnect, and end the thread."""
        super().close()
        self.job.release()

    # The view

    def toggle(self) -> None:
        """Show the blocks, or no longer."""
        self.show(not self.shown)

    def show(self, shown: bool) -> None:
        """Show the blocks or not; a sentence is shown where the mesh has none."""
        if shown == self.shown:
            return
        if shown and not self._plan():
            return
        self.shown = shown
        self._hover.suspend(shown)
        overlay = self._canvas.overlay
        overlay.element.visible = overlay.arrow.visible = not shown
        overlay.markers.strokes = not shown
        self._canvas.show_edges(not shown)
        if shown:
            self._refresh()
            self._status.show_message("Blocks: click an edge to select its chord, or a quad.")
        else:
            self.job.stop()
            self.planned = self._bent = self._bent_of = None
            self.layer.show(None)
            self.grid.show([])
            overlay.markers.displace()
            self._status.show_message("Blocks hidden.")
        self.changed.emit()

    def _on_replaced(self) -> None:
        self._edge, self._block, self._said = None, -1, ""
        if self.shown and self._document.kind != "quad":
            self.show(False)

    def _on_changed(self) -> None:
        if self.shown:
            if self._plan():
                self._refresh()
            else:
                self.show(False)

    def _plan(self) -> bool:
        """Find blocks and numbers of the present mesh; a sentence where there are none."""
        mesh = self._document.mesh
        if mesh is None:
            return False
        try:
            self.planned = PlannedBlocks.of(mesh)
        except MeshError as error:
            self._notice.show_message(sentence(str(error)))
            return False
        return True

    def _refresh(self) -> None:
        """Show blocks and numbers, and compute the fine grid."""
        from meshwright_core.analysis.blocks import block_count  # brings in parts of scipy

        planned = self.planned
        assert planned is not None
        structure = planned.structure
        counts = planned.division.counts if planned.division is not None else None
        if self._bent_of is not None and not _alike(self._bent_of, structure):
            self._bent = self._bent_of = None
            self._canvas.overlay.markers.displace()
        self.layer.show(
            BlocksShown(
                structure.parts, self._bent, structure.chord, counts, frozenset(planned.pinned()),
                frozenset(planned.chords), self._strip,
            )
        )  # fmt: skip
        values = self.panel.values
        blocks = block_count(self._document.need_mesh())
        values["quads"].text = f"{len(structure.corners):,}, {blocks:,}, {structure.chord_count:,}"
        values["cells"].text = f"{planned.cells:,}" if planned.cells else "\u2013"
        plan = self._document.need_mesh().grid_plan
        self.panel.show_size(plan.size, float(np.median(structure.lengths)) / 5.0)
        if planned.problem:
            self.grid.show([])
            self.say(planned.problem)
        elif planned.remarks:
            self.say(" ".join(planned.remarks))
        elif self._said:
            self._notice.hide()
            self._said = ""
        previewed = 0 < planned.cells <= MOST_CELLS
        for name in ("worst", "aspect"):
            values[name].text = "\u2026" if previewed else "\u2013"
        if planned.cells > MOST_CELLS:
            self.grid.show([])
        self.show_selection()
        self.job.start(planned)

    def _strip(self, chord: int) -> list[np.ndarray]:
        """The outlines of the blocks of a chord."""
        assert self.planned is not None
        blocks = np.flatnonzero((self.planned.structure.crossing == chord).any(axis=1))
        return [self._outline(block) for block in blocks.tolist()]

    def _outline(self, block: int) -> np.ndarray:
        """(p, 2) a block as a polygon."""
        assert self.planned is not None
        structure = self.planned.structure
        lines = []
        for side in range(4):
            edge = int(structure.sides[block, side])
            if self._bent is not None:
                line = self._bent[edge]
            else:
                w = np.linspace(0.0, 1.0, 2 if structure.parts.curve[edge] < 0 else ALONG_CURVES)
                line = structure.parts.points(np.full(len(w), edge), w)[:, :2]
            # sides 2 and 3 run against the axes of the block
            along = bool(structure.forward[block, side]) ^ (side > 1)
            lines.append(line[:-1] if along else line[:0:-1])
        return np.concatenate(lines)

    def _on_preview(self, preview: GridPreview) -> None:
        if not self.shown:
            return
        self.grid.show(preview.lines)
        if preview.final and self.planned is not None and self.layer.shown is not None:
            self._bent, self._bent_of = preview.edges, self.planned.structure
            self.layer.show(replace(self.layer.shown, bent=self._bent))
            marks = self._canvas.overlay.markers
            marks.displace(self.planned.structure.vertices, preview.corners)
            if self.block >= 0:
                self.layer.select(-1, -1, self._outline(self.block))
            quality, values = preview.quality, self.panel.values
            inverted = f", {quality.inverted:,} inverted" if quality.inverted else ""
            values["worst"].text = f"{quality.worst_scaled_jacobian:.2f}{inverted}"
            values["aspect"].text = f"{quality.worst_aspect:.1f}"

    def say(self, words: str) -> None:
        """Say in the notice bar what cannot be, until an edit resolves it."""
        self._said = sentence(words)
        self._notice.show_message(self._said)

    # Selection

    @property
    def edge(self) -> int:
        """The selected block edge, a row of the structure; -1 for none."""
        if self.planned is None or self._edge is None:
            return -1
        return self.planned.structure.edge_between(*self._edge)

    @property
    def chord(self) -> int:
        """The selected chord; -1 for none."""
        edge = self.edge
        return int(self.planned.structure.chord[edge]) if self.planned and edge >= 0 else -1

    @property
    def halfedge(self) -> int:
        """The half-edge of the selected edge that runs in the direction of its chord, or the other
        one on the boundary; -1 for none.
        """
        mesh, edge = self._document.mesh, self.edge
        if mesh is None or edge < 0 or self.planned is None:
            return -1
        structure = self.planned.structure
        a, b = structure.vertices[structure.edges[edge]].tolist()
        found = mesh.halfedge(a, b)
        return found if found >= 0 else mesh.halfedge(b, a)

    @property
    def block(self) -> int:
        """The selected block, a row of the structure; -1 for none."""
        mesh = self._document.mesh
        if mesh is None or self._block < 0:
            return -1
        ids = mesh.element_ids()
        row = int(np.searchsorted(ids, self._block))
        return row if row < len(ids) and ids[row] == self._block else -1

    def select_edge(self, edge: int) -> None:
        """Select a block edge, and with it its chord; -1 for none."""
        assert self.planned is not None
        structure = self.planned.structure
        self._block = -1
        self._edge = None
        if edge >= 0:
            a, b = structure.vertices[structure.edges[edge]].tolist()
            self._edge = (a, b)
        self.show_selection()

    def select_chord(self, chord: int) -> None:
        """Select a chord by its first edge."""
        if self.planned is not None:
            self.select_edge(int(np.flatnonzero(self.planned.structure.chord == chord)[0]))
            self._canvas.focus()

    def next_chord(self, step: int) -> None:
        """Select the next chord by number; the previous one for -1."""
        if not self.shown:
            self.show(True)
        if self.shown and self.planned is not None:
            count = self.planned.structure.chord_count
            now = self.chord
            first = 0 if step > 0 else count - 1
            self.select_chord((now + step) % count if now >= 0 else first)

    def put_down(self) -> bool:
        """Select nothing; False if nothing was selected."""
        if not self.shown or (self._edge is None and self._block < 0):
            return False
        self.select_edge(-1)
        return True

    def show_selection(self) -> None:
        """Show what is selected on the canvas and in the panel."""
        planned = self.planned
        if planned is None or not self.shown:
            return
        structure, edge, chord, block = planned.structure, self.edge, self.chord, self.block
        outline = self._outline(block) if block >= 0 else None
        self.layer.select(chord, edge, outline)
        colours = chord_colours(structure.chord_count, self._theme)
        if chord >= 0:
            self.panel.show_chord(self._described(planned, chord, colours[chord]))
        elif block >= 0:
            one, other = structure.crossing[block].tolist()
            counts = planned.division.counts if planned.division is not None else None
            shape = (int(counts[one]), int(counts[other])) if counts is not None else (0, 0)
            self.panel.show_block(block, shape, (one, other), (colours[one], colours[other]))
        else:
            self.panel.show_chord(None)
        self.changed.emit()

    def _described(self, planned: PlannedBlocks, chord: int, colour: str) -> ChordShown:
        structure, division = planned.structure, planned.division
        grading = Grading(0.0, 0.0, GROWTH)
        if division is not None:
            ratio = float(division.ratio[chord])
            first, last = float(division.first[chord]), float(division.last[chord])
            grading = Grading(first, last, ratio if first or last else GROWTH)
        edges = structure.chord == chord
        return ChordShown(
            chord, colour, int(edges.sum()), int((structure.crossing == chord).any(axis=1).sum()),
            int(division.counts[chord]) if division is not None else 0,
            chord in planned.pinned(), grading, float(structure.lengths[edges].min()),
        )  # fmt: skip

    # The mouse

    def edge_at(self, at: QPointF) -> int:
        """The block edge near pixel `at`, or whose number is there; -1 for none."""
        return self.layer.edge_at(at, REACH)

    def click(self, click: Click) -> bool:
        """Select what is under a click of the left button while blocks are shown."""
        if not self.shown or click.button != Qt.MouseButton.LeftButton or click.shift:
            return False
        edge = self.edge_at(click.at)
        if edge < 0 and click.halfedge >= 0:
            self._edge, self._block = None, click.halfedge // 4
            self.show_selection()
        else:
            self.select_edge(edge)
        return True

    def _on_hovered(self, at: QPointF | None) -> None:
        if self.shown and self.planned is not None:
            edge = self.edge_at(at) if at is not None else -1
            self.layer.hover(int(self.planned.structure.chord[edge]) if edge >= 0 else -1)

    def _gesture_at(self, at: QPointF, modifiers: Qt.KeyboardModifier) -> Gesture | None:
        before = self._before(at, modifiers)
        mesh = self._document.mesh
        if before is not None or not self.shown or mesh is None:
            return before
        edge = self.edge_at(at)
        if edge < 0:
            return None
        self.select_edge(edge)
        return SlideLine(self._canvas, self.layer, mesh, self.halfedge, at, self.tools.slide)


def _alike(one: BlockStructure, other: BlockStructure) -> bool:
    """Whether two structures have the same edges at the same places."""
    return (
        one.edges.shape == other.edges.shape
        and bool((one.edges == other.edges).all())
        and one.points.shape == other.points.shape
        and bool((one.points == other.points).all())
    )
