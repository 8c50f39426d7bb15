"""The score panel: s, s*, shape and its bound, inverted elements, irregular vertices, counts."""

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from meshwright.desktop.controller import Connections
from meshwright.desktop.quality.irregularity_chart import IrregularityChart
from meshwright.desktop.quality.optimum_badge import OptimumBadge
from meshwright.desktop.quality.quality_job import QualityMonitor
from meshwright.desktop.widgets.basic import (
    ShareBar,
    ValueLine,
    ValueLink,
    named,
    tabular,
)
from meshwright.desktop.widgets.wording import plural
from meshwright.document.document import Document
from meshwright.document.quality_summary import (
    QualitySummary,
    decimal,
    shape_words,
)
from meshwright.document.verdict import findings, gap_words
from meshwright.graphics.theme import GRID, Theme
from meshwright_core import HalfEdgeMesh

_NONE = "\u2013"
_STALE = "\u2026"
SCORE_SIZES = ((5, 40), (7, 30), (99, 18))
"""Up to how many characters the score has which size in pixels, so that it fits the panel."""
LONGEST = 24
"""Characters of the line *Elements*; a longer one leaves out the noun."""


class ScorePanel(QWidget):
    """Shows the score of ``document`` at once, and measurements of ``monitor`` when they are
    available.

    ``delta_chosen(delta)`` when a column of the chart is clicked, ``inverted_chosen()`` when the
    number of inverted elements is, ``element_chosen(element)`` when the worst of a measure is.
    """

    delta_chosen = Signal(int)
    inverted_chosen = Signal()
    element_chosen = Signal(int)

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
        self.shape = ValueLink(
            "Shape",
            "Worst scaled Jacobian, the smallest sine of a corner, and what the angles of the"
            " corners permit where they are regular; click to go to the element",
        )
        self.flattest = ValueLink(
            "Worst element shape",
            "Worst corner of an element by angle and ratio of sides: 1 for a square or an"
            " equilateral triangle; click to go to the element",
        )
        self.irregular = ValueLine(
            "Irregular vertices", "Vertices whose degree is not the desired one"
        )
        self.tally = IrregularityChart(theme)
        self.gained = ValueLine("Normalised return", "(start \u2212 best) / (start \u2212 optimum)")
        self.way = ValueLine("Start and best", "Score at the start, and the lowest score since")
        self.elements = ValueLine(
            "Elements", "Elements; quads that form one regular grid count as one block"
        )
        self.inverted = ValueLink("Inverted elements", "Reversed orientation; click to go to them")
        self._arrange()
        self.tally.chosen.connect(self.delta_chosen)
        self.inverted.clicked.connect(self.inverted_chosen)
        self.shape.clicked.connect(lambda: self._choose("jacobian"))
        self.flattest.clicked.connect(lambda: self._choose("shape"))
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
        for fact in (self.shape, self.flattest, self.inverted, self.irregular):
            layout.addWidget(fact)
        layout.addWidget(self.tally)
        for fact in (self.gained, self.way, self.elements):
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
        text = f"{mesh.score:,}"
        self.score.setText(text)
        size = next(pixels for digits, pixels in SCORE_SIZES if len(text) <= digits)
        self.score.setStyleSheet(f"font-size: {size}px")
        self.score.setAccessibleName(f"Score {mesh.score}, optimum {mesh.optimum}")
        self.goal.setText(f"Optimum {mesh.optimum:,}")
        self.gap.setText(gap_words(mesh.score, mesh.optimum))
        self.bar.share = document.normalised_return
        self.gained.text = f"{document.normalised_return:.2f}"
        self.way.text = f"{document.start_score:,} \u2192 {document.best_score:,}"
        self.irregular.text = f"{mesh.irregular_count:,} of {mesh.n_vertices:,}"
        self.tally.show_deltas(mesh.irregularity())

    def _on_measured(self) -> None:
        """Show shape, blocks and inverted elements; an ellipsis while they are being measured."""
        mesh, summary = self._document.mesh, self._monitor.summary
        if mesh is None:
            self.elements.text = _NONE
            for link in (self.shape, self.flattest, self.inverted):
                link.show_value(_NONE)
            return
        fresh = summary if not self._monitor.stale else None
        self.elements.text = _counted(mesh, fresh)
        if fresh is None:
            self.optimal.show_findings(())
            for link in (self.shape, self.flattest, self.inverted):
                link.show_value(_STALE)
            return
        worst, count = fresh.jacobian.worst, len(fresh.inverted)
        self.shape.show_value(shape_words(worst, fresh.bound), leads=True, warns=worst <= 0.0)
        flattest = fresh.shape.worst
        self.flattest.show_value(decimal(flattest), leads=True, warns=flattest <= 0.0)
        self.inverted.show_value(f"{count:,}", leads=count > 0, warns=count > 0)
        self.optimal.show_findings(findings(mesh, worst, flattest, fresh.bound, count))

    def _choose(self, measure: str) -> None:
        if self._monitor.summary is not None:
            spread = getattr(self._monitor.summary, measure)
            self.element_chosen.emit(spread.worst_element)


def _counted(mesh: HalfEdgeMesh, summary: QualitySummary | None) -> str:
    """``24 quads in 5 blocks``; the number of blocks is an ellipsis while it is not known."""
    if mesh.k == 3:
        return f"{mesh.n_elements:,} triangles"
    if summary is None or summary.blocks is None:
        return f"{mesh.n_elements:,} quads in {_STALE} blocks"
    text = f"{mesh.n_elements:,} quads in {plural(summary.blocks, 'block')}"
    return text if len(text) <= LONGEST else text.replace(" quads", "")
