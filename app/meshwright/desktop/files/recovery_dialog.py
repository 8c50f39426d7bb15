"""The dialog that offers work of a process that ended without saving."""

from collections.abc import Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QDialog,
    QFrame,
    QHBoxLayout,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.widgets.basic import named
from meshwright.document.storage.recovery import LostWork
from meshwright.graphics.theme import GRID
from meshwright_core.core.kinds import KIND_NOUN

STORY = (
    "Meshwright ended before this work was saved. Every step until then was recorded and can be"
    " recovered, with the whole history."
)
SHOWN = 4
"""Number of works that are visible at once; the list scrolls if there are more."""
CARD = 92
"""Height of one work in pixels."""


class RecoveryDialog(QDialog):
    """Offers ``works``; :attr:`chosen` is the one to recover, None for later.

    What is discarded here is deleted at once, after a second click.
    """

    def __init__(self, works: Sequence[LostWork], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.chosen: LostWork | None = None
        self.works = list(works)
        self.cards: list[LostWorkCard] = []
        self.setWindowTitle("Recover work")
        self.setMinimumWidth(560)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(3 * GRID, 3 * GRID, 3 * GRID, 2 * GRID)
        layout.setSpacing(GRID)
        layout.addWidget(named("Unsaved work was found", "Question"))
        story = named(STORY, "Label")
        story.setWordWrap(True)
        layout.addWidget(story)
        layout.addSpacing(GRID)
        layout.addWidget(self._list())
        layout.addSpacing(GRID)
        self.later = QPushButton("Decide later")
        self.later.setToolTip("Ask again at the next start")
        self.later.setAutoDefault(False)
        self.later.clicked.connect(self.reject)
        line = QHBoxLayout()
        line.addStretch(1)
        line.addWidget(self.later)
        layout.addLayout(line)

    def _list(self) -> QScrollArea:
        inside = QWidget()
        inside.setObjectName("CardList")
        inside.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(GRID)
        for number, work in enumerate(self.works):
            card = LostWorkCard(work)
            card.recover.clicked.connect(partial(self._on_recover, work))
            card.discard.clicked.connect(partial(self._on_discard, card))
            if not number:
                card.recover.setObjectName("Primary")
                card.recover.setDefault(True)
            self.cards.append(card)
            column.addWidget(card)
        column.addStretch(1)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(inside)
        seen = min(len(self.works), SHOWN)
        area.setFixedHeight(seen * CARD + (seen - 1) * GRID)
        return area

    def _on_recover(self, work: LostWork, checked: bool = False) -> None:
        self.chosen = work
        self.accept()

    def _on_discard(self, card: "LostWorkCard", checked: bool = False) -> None:
        if not card.sure:
            card.make_sure()
            return
        card.work.discard()
        self.works.remove(card.work)
        self.cards.remove(card)
        card.hide()
        card.deleteLater()
        if not self.works:
            self.reject()


class LostWorkCard(QFrame):
    """One work: name, progress, time of the last step."""

    def __init__(self, work: LostWork) -> None:
        super().__init__()
        self.work = work
        self.sure = False
        self.setObjectName("Card")
        self.setFixedHeight(CARD)
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * GRID, GRID, 2 * GRID, GRID)
        row.setSpacing(GRID)
        words = QVBoxLayout()
        words.setSpacing(2)
        words.addStretch(1)
        self.title = named(work.name or "Untitled mesh", "CardTitle")
        self.story = named(progress(work), "Label")
        self.place = named(f"{moment(work.when)}, {origin(work)}", "Hint")
        for part in (self.title, self.story, self.place):
            part.setTextFormat(Qt.TextFormat.PlainText)
            words.addWidget(part)
        words.addStretch(1)
        self.discard = QPushButton("Discard")
        self.discard.setObjectName("Link")
        self.discard.setToolTip("Delete this work permanently")
        self.recover = QPushButton("Recover")
        for button in (self.discard, self.recover):
            button.setAutoDefault(False)
        row.addLayout(words, 1)
        row.addWidget(self.discard)
        row.addWidget(self.recover)
        if work.file is not None:
            self.setToolTip(str(work.file))

    def make_sure(self) -> None:
        """Ask for a second click on *Discard*."""
        self.sure = True
        self.discard.setText("Delete permanently?")


def progress(work: LostWork) -> str:
    """``12 steps, s 8 (optimum 4), 1,024 quads``, as far as known."""
    now = {key: value for key, value in work.now.items() if isinstance(value, int | str)}
    parts = []
    if "steps" in now:
        parts.append("1 step" if now["steps"] == 1 else f"{now['steps']:,} steps")
    if "score" in now and "optimum" in now:
        parts.append(f"s {now['score']:,} (optimum {now['optimum']:,})")
    if "elements" in now:
        noun = KIND_NOUN.get(str(now.get("kind")), "elements")
        parts.append(f"{now['elements']:,} {noun}")
    return ", ".join(parts)


def moment(when: float) -> str:
    """``today at 14:05``, ``yesterday at 9:30``, or the day."""
    then = datetime.fromtimestamp(when)
    days = (datetime.now().date() - then.date()).days
    day = {0: "Today", 1: "Yesterday"}.get(days, f"{then:%d %B %Y}".lstrip("0"))
    return f"{day} at {then:%H:%M}"


def origin(work: LostWork) -> str:
    """The file of the work, or that it was never saved."""
    if work.file is None:
        return "never saved to a file"
    there = "" if Path(work.file).exists() else ", which no longer exists"
    return f"from {work.file.name}{there}"
