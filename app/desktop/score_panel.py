"""The score panel: s, s*, the gap between them, and the counts of the mesh."""

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.desktop.widgets import Bar, Fact, Optimal, Tally, named, tabular
from app.document import Document
from app.theme import GRID, Theme


class ScorePanel(QWidget):
    """Follows the document's score."""

    def __init__(self, document: Document, theme: Theme) -> None:
        super().__init__()
        self._document = document
        self.score = named("", "Big")
        self.score.setFont(tabular(self.score.font()))
        self.score.setToolTip("s: the sum of |degree \u2212 desired degree| over all vertices")
        self.goal = named("", "Value")
        self.goal.setToolTip("s*: no connectivity can have a lower score")
        self.gap = named("", "Label")
        self.bar = Bar(theme)
        self.optimal = Optimal(theme)
        self.gained = Fact("Normalised return", "(start \u2212 best) / (start \u2212 optimum)")
        self.way = Fact("Start and best", "Score at the start, and the lowest one since")
        self.irregular = Tally(theme)
        self.counts = Fact("Mesh")
        self._arrange()
        document.score_changed.connect(self._on_score_changed)
        self._on_score_changed()

    def release(self) -> None:
        """Let go of the document."""
        self._document.score_changed.disconnect(self._on_score_changed)

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        for part in (self.bar, self.optimal, self.irregular):
            part.set_theme(theme)

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addWidget(named("SCORE", "Heading"))
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
        line.addWidget(self.score)
        line.addWidget(self.words, 1)
        line.addWidget(self.optimal, 1)
        layout.addLayout(line)
        layout.addWidget(self.bar)
        layout.addSpacing(GRID // 2)
        layout.addWidget(self.gained)
        layout.addWidget(self.way)
        tally = QHBoxLayout()
        tally.addWidget(named("Irregular vertices", "Label"))
        tally.addStretch(1)
        tally.addWidget(self.irregular, 0, Qt.AlignmentFlag.AlignRight)
        layout.addLayout(tally)
        layout.addWidget(self.counts)

    def _on_score_changed(self) -> None:
        document, mesh = self._document, self._document.mesh
        self.optimal.setVisible(document.at_optimum)
        for part in (self.words, self.bar):
            part.setVisible(not document.at_optimum)
        self.score.setVisible(mesh is not None)
        if mesh is None:
            self.goal.setText("No mesh")
            self.gap.setText("")
            for fact in (self.gained, self.way, self.counts):
                fact.text = "\u2013"
            self.irregular.set_counts(0, 0)
            self.bar.share = 0.0
            return
        delta = mesh.irregularity()
        self.score.setText(f"{mesh.score:,}")
        self.goal.setText(f"Optimum {mesh.optimum:,}")
        gap = mesh.score - mesh.optimum
        self.gap.setText(f"{gap:,} above it")
        self.bar.share = document.normalised_return
        self.gained.text = f"{document.normalised_return:.2f}"
        self.way.text = f"{document.start_score:,} \u2192 {document.best_score:,}"
        self.irregular.set_counts(int((delta > 0).sum()), int((delta < 0).sum()))
        noun = "quads" if mesh.k == 4 else "triangles"
        self.counts.text = f"{mesh.n_elements:,} {noun}, {mesh.n_vertices:,} vertices"
