"""The dialog of levels: a card for each, with its picture and the stars that were won."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

from qtpy.QtCore import QSize, Qt
from qtpy.QtGui import QFocusEvent, QImage, QPixmap
from qtpy.QtWidgets import (
    QDialog,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.levels.star_rating import StarRating
from meshwright.desktop.widgets.basic import named
from meshwright.graphics.theme import GRID, Theme
from meshwright.puzzles import level as levels
from meshwright.puzzles.level import Level
from meshwright.puzzles.progress import MOST_STARS, LevelProgress

COLUMNS = 4
CARD = QSize(184, 212)
PICTURE = QSize(168, 120)
STORY = (
    "Each level is a mesh with a goal and a par: reach the lowest score with as few operations as"
    " you can. Stars depend on the number of operations; undone operations and smoothing do not"
    " count."
)


class LevelDialog(QDialog):
    """Offers all levels; :attr:`chosen` is the one to play, None for none."""

    def __init__(
        self, progress: LevelProgress, theme: Theme, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.chosen: Level | None = None
        self.cards: list[LevelCard] = []
        self.setWindowTitle("Levels")
        column = QVBoxLayout(self)
        column.setContentsMargins(3 * GRID, 3 * GRID, 3 * GRID, 2 * GRID)
        column.setSpacing(GRID)
        column.addLayout(self._head(progress))
        story = named(STORY, "Label")
        story.setWordWrap(True)
        column.addWidget(story)
        if progress.notice:
            notice = named(progress.notice, "LevelText")
            notice.setProperty("tone", "warns")
            notice.setWordWrap(True)
            column.addWidget(notice)
        column.addSpacing(GRID)
        column.addWidget(self._grid(progress, theme), 1)
        column.addLayout(self._foot())
        width = COLUMNS * CARD.width() + (COLUMNS - 1) * GRID + 8 * GRID
        room = parent.height() if parent is not None else 720
        self.setFixedWidth(width)
        self.resize(width, min(760, max(480, room - 4 * GRID)))
        self._focus_next(progress)

    def _head(self, progress: LevelProgress) -> QHBoxLayout:
        line = QHBoxLayout()
        line.addWidget(named("Levels", "EmptyTitle"), 1)
        total = MOST_STARS * len(levels.names())
        won = sum(progress.best(name).stars for name in levels.names())
        line.addWidget(named(f"{won} of {total} stars", "Label"))
        return line

    def _grid(self, progress: LevelProgress, theme: Theme) -> QScrollArea:
        inside = QWidget()
        inside.setObjectName("CardList")
        inside.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        grid = QGridLayout(inside)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(GRID)
        self._area = QScrollArea()
        for place, level in enumerate(levels.all()):
            card = LevelCard(level, progress, theme, self._area.ensureWidgetVisible)
            card.clicked.connect(partial(self._on_chosen, level))
            self.cards.append(card)
            grid.addWidget(card, place // COLUMNS, place % COLUMNS)
        grid.setColumnStretch(COLUMNS, 1)
        grid.setRowStretch(grid.rowCount(), 1)
        self._area.setWidgetResizable(True)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._area.setWidget(inside)
        return self._area

    def _foot(self) -> QHBoxLayout:
        line = QHBoxLayout()
        line.setContentsMargins(0, GRID, 0, 0)
        line.addStretch(1)
        close = QPushButton("Close")
        close.setToolTip("Close the list of levels")
        close.setAutoDefault(False)
        close.clicked.connect(self.reject)
        line.addWidget(close)
        return line

    def _focus_next(self, progress: LevelProgress) -> None:
        """Give the first level without a star the keyboard focus."""
        fresh = [card for card in self.cards if not progress.best(card.level.name).stars]
        for card in (fresh or self.cards)[:1]:
            card.setFocus()

    def _on_chosen(self, level: Level, checked: bool = False) -> None:
        self.chosen = level
        self.accept()


class LevelCard(QPushButton):
    """One level; a click starts it. ``focused(card)`` is called when it gets the keyboard focus."""

    def __init__(
        self,
        level: Level,
        progress: LevelProgress,
        theme: Theme,
        focused: Callable[[QWidget], None],
    ) -> None:
        super().__init__()
        self.level = level
        self._focused = focused
        best = progress.best(level.name)
        self.setObjectName("LevelCard")
        self.setFixedSize(CARD)
        self.setAutoDefault(False)
        done = f", done in {best.used}" if best.stars else ""
        story = f"{level.story}{done}"
        self.setToolTip(level.text)
        self.setAccessibleName(
            f"Level {level.number}, {level.title}: {story}, {best.stars} of {MOST_STARS} stars"
        )
        column = QVBoxLayout(self)
        column.setContentsMargins(GRID, GRID, GRID, GRID)
        column.setSpacing(2)
        self.picture = named("", "Picture")
        self.picture.setPixmap(picture(level.name, theme, self.devicePixelRatioF()))
        self.title = named(f"{level.number}  {level.title}", "CardTitle")
        self.title.setWordWrap(True)
        self.stars = StarRating(theme, 14)
        self.stars.count = best.stars
        column.addWidget(self.picture)
        column.addStretch(1)
        column.addWidget(self.title)
        column.addWidget(named(story, "Hint"))
        column.addWidget(self.stars)
        for part in (self.picture, self.title, self.stars):
            part.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)

    def focusInEvent(self, event: QFocusEvent) -> None:  # noqa: N802
        """Scroll to the card."""
        super().focusInEvent(event)
        self._focused(self)


@cache
def picture(name: str, theme: Theme, ratio: float) -> QPixmap:
    """A picture of the start of a level."""
    from meshwright.graphics.drawing import raster
    from meshwright.graphics.mesh_figure import FigureOptions, figure

    size = PICTURE * ratio
    look = FigureOptions(
        (size.width(), size.height()), theme.name, numbers=False, score=False, curve=False
    )
    drawn = raster(figure(levels.load(name).mesh(), look)).convert("RGBA")
    image = QImage(
        drawn.tobytes(), drawn.width, drawn.height, 4 * drawn.width, QImage.Format.Format_RGBA8888
    )
    made = QPixmap.fromImage(image.copy())
    made.setDevicePixelRatio(ratio)
    return made
