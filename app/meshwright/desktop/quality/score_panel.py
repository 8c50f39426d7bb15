"""The score panel: s, s*, their difference, irregular vertices, and counts of the mesh."""

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from meshwright.desktop.controller import Connections
from meshwright.desktop.quality.irregularity_chart import IrregularityChart
from meshwright.desktop.quality.quality_job import QualityMonitor
from meshwright.desktop.widgets.basic import (
    OptimumBadge,
    ShareBar,
    ValueLine,
    ValueLink,
    named,
    tabular,
)
from meshwright.document.document import Document
from meshwright.graphics.theme import GRID, Theme

_NONE = "\u2013"
_STALE = "\u2026"


class ScorePanel(QWidget):
    """Shows the score of ``document`` at once, and measurements of ``monitor`` when they are
    available.

    ``delta_chosen(delta)`` when a column of the chart is clicked, ``inverted_chosen()`` when the
    number of inverted elements is.
    """

    delta_chosen = Signal(int)
    inverted_chosen = Signal()

    def __init__(self, document: Document, monitor: QualityMonitor, theme: Theme) -> None:
        super().__init__()
        self._document = document
        self._monitor = monitor
        self.score = named("", "Big")
        self.score.setFont(tabular(self.score.font()))
        self.score.setToolTip("s: the sum of |degree \u2212 desired degree| over all vertices")
        self.goal = named("", "Value")
        self.goal.setToolTip("s*: no connectivity can have a lower score")
        self.gap = named("", "Label")
        self.bar = ShareBar(theme)
        self.bar.setToolTip("Progress from the start score to the optimum")
        self.optimal = OptimumBadge(theme)
        self.irregular = ValueLine(
            "Irregular vertices", "Vertices whose degree is not the desired one"
        )
        self.tally = IrregularityChart(theme)
        self.gained = ValueLine("Normalised return", "(start \u2212 best) / (start \u2212 optimum)")
        self.way = ValueLine("Start and best", "Score at the start, and the lowest score since")
        self.elements = ValueLine("Elements", "Elements; quads form blocks, each a regular grid")
        self.inverted = ValueLink("Inverted elements", "Reversed orientation; click to go to them")
        self._arrange()
        self.tally.chosen.connect(self.delta_chosen)
        self.inverted.clicked.connect(self.inverted_chosen)
        self._connections = Connections()
        self._connections.add(document.score_changed, self._on_score_changed)
        monitor.aged.connect(self._on_measured)
        monitor.measured.connect(self._on_measured)
        self._on_score_changed()

    def release(self) -> None:
        """Disconnect from the document."""
        self._connections.close()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        for part in (self.bar, self.optimal, self.tally):
            part.set_theme(theme)

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        line = QHBoxLayout()
        line.setSpacing(2 * GRID)
        self.words = QWidget()
        words = QVBoxLayout(self.words)
        words.setContentsMargins(0, 0, 0, 0)
        words.setSpacing(2)
        words.addStretch(1)
        words.addWidget(self.goal)
        words.addWidget(self.gap)
        words.addStretch(1)
        line.addWidget(self.score, 0, Qt.AlignmentFlag.AlignVCenter)
        line.addWidget(self.words, 1)
        line.addWidget(self.optimal, 1)
        layout.addLayout(line)
        layout.addWidget(self.bar)
        layout.addSpacing(GRID // 2)
        layout.addWidget(self.irregular)
        layout.addWidget(self.tally)
        layout.addSpacing(GRID // 2)
        for fact in (self.gained, self.way, self.elements, self.inverted):
            layout.addWidget(fact)

    def _on_score_changed(self) -> None:
        document, mesh = self._document, self._document.mesh
        self.optimal.setVisible(document.at_optimum)
        for part in (self.words, self.bar):
            part.setVisible(not document.at_optimum)
        self.score.setVisible(mesh is not None)
        self._on_measured()
        if mesh is None:
            self.goal.setText("No mesh")
            self.gap.setText("")
            for fact in (self.gained, self.way, self.irregular):
                fact.text = _NONE
            self.tally.clear()
            self.bar.share = 0.0
            return
        self.score.setText(f"{mesh.score:,}")
        self.score.setAccessibleName(f"Score {mesh.score}, optimum {mesh.optimum}")
        self.goal.setText(f"Optimum {mesh.optimum:,}")
        gap = mesh.score - mesh.optimum
        self.gap.setText(f"{gap:,} above it")
        self.bar.share = document.normalised_return
        self.gained.text = f"{document.normalised_return:.2f}"
        self.way.text = f"{document.start_score:,} \u2192 {document.best_score:,}"
        self.irregular.text = f"{mesh.irregular_count:,} of {mesh.n_vertices:,}"
        self.tally.show_deltas(mesh.irregularity())

    def _on_measured(self) -> None:
        """Show blocks and inverted elements; an ellipsis while they are being measured."""
        mesh, summary = self._document.mesh, self._monitor.summary
        if mesh is None:
            self.elements.text = _NONE
            self.inverted.show_value(_NONE)
            return
        if mesh.k == 4:
            blocks = "blocks"
            number = _STALE
            if not self._monitor.stale and summary is not None and summary.blocks is not None:
                number = f"{summary.blocks:,}"
                blocks = "block" if summary.blocks == 1 else blocks
            self.elements.text = f"{mesh.n_elements:,} quads in {number} {blocks}"
        else:
            self.elements.text = f"{mesh.n_elements:,} triangles"
        if summary is None or self._monitor.stale:
            self.inverted.show_value(_STALE)
            return
        count = len(summary.inverted)
        self.inverted.show_value(f"{count:,}", leads=count > 0, warns=count > 0)
