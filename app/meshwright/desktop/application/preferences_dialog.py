"""The preferences dialog; every change is applied and saved at once."""

from collections.abc import Callable

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QComboBox,
    QDialog,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.application.settings import SYSTEM, Settings
from meshwright.desktop.widgets.basic import named, segment
from meshwright.graphics.theme import COLOURS, GRID

_THEMES = (
    (SYSTEM, "System", "The theme of the desktop"),
    ("light", "Light", "Dark lines on an off-white background"),
    ("dark", "Dark", "Light lines on a near-black background"),
)
_SWITCHES = (
    (
        "auto_smooth",
        "Smooth around every operation",
        "The vertices near an operation are smoothed. Corners, locked and pinned ones are fixed, "
        "boundary vertices stay on their side.",
    ),
    (
        "autosave",
        "Autosave every step",
        "After a crash the work can be recovered at the next start; at most the last step is lost.",
    ),
)


class PreferencesDialog(QDialog):
    """Shows and changes ``settings``."""

    def __init__(self, settings: Settings, parent: QWidget) -> None:
        super().__init__(parent)
        self._settings = settings
        self.setWindowTitle("Preferences")
        self.setMinimumWidth(480)
        self.themes: dict[str, QPushButton] = {}
        self.colours = QComboBox()
        self.switches: dict[str, QCheckBox] = {}
        layout = QVBoxLayout(self)
        layout.setContentsMargins(4 * GRID, 3 * GRID, 4 * GRID, 3 * GRID)
        layout.setSpacing(12)
        layout.addWidget(named("APPEARANCE", "Heading"))
        layout.addLayout(self._look())
        layout.addWidget(
            self._switch(
                "numbers",
                "Numbers on irregular vertices",
                "Degree minus desired degree, in each disc.",
            )
        )
        layout.addSpacing(GRID)
        layout.addWidget(named("EDITING", "Heading"))
        for name, title, story in _SWITCHES:
            layout.addWidget(self._switch(name, title, story))
        layout.addStretch(1)
        layout.addSpacing(GRID)
        layout.addLayout(self._buttons())
        self._show_kept()

    def _look(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(2 * GRID)
        grid.setVerticalSpacing(12)
        grid.setColumnStretch(1, 1)
        group = QButtonGroup(self)
        line = QHBoxLayout()
        line.setSpacing(0)
        for name, word, tooltip in _THEMES:
            button = segment(word)
            button.setToolTip(tooltip)
            button.clicked.connect(self._keeper("theme", name))
            group.addButton(button)
            self.themes[name] = button
            line.addWidget(button)
        line.addStretch(1)
        self.colours.setToolTip(
            "Colours of too high and too low degrees; safe for colour-blind users"
        )
        self.colours.setAccessibleName("Colours of irregular vertices")
        for name, (title, *_) in COLOURS.items():
            self.colours.addItem(title, name)
        self.colours.activated.connect(self._on_colours_chosen)
        grid.addWidget(named("Theme", "Label"), 0, 0)
        grid.addLayout(line, 0, 1)
        grid.addWidget(named("Irregular vertices", "Label"), 1, 0)
        grid.addWidget(self.colours, 1, 1)
        return grid

    def _switch(self, name: str, title: str, story: str) -> QWidget:
        box = QCheckBox(title)
        box.setToolTip(story)
        box.setAccessibleDescription(story)
        box.clicked.connect(lambda checked: setattr(self._settings, name, checked))
        self.switches[name] = box
        words = named(story, "Hint")
        words.setWordWrap(True)
        words.setContentsMargins(3 * GRID, 0, 0, 0)
        part = QWidget()
        column = QVBoxLayout(part)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        column.addWidget(box)
        column.addWidget(words)
        return part

    def _buttons(self) -> QHBoxLayout:
        reset = QPushButton("Defaults")
        reset.setToolTip("Reset all settings on this page")
        reset.setAutoDefault(False)
        reset.clicked.connect(lambda checked=False: self._reset())
        close = QPushButton("Close")
        close.setToolTip("Close; changes take effect at once")
        close.setDefault(True)
        close.clicked.connect(self.accept)
        line = QHBoxLayout()
        line.setSpacing(GRID)
        line.addWidget(reset)
        line.addStretch(1)
        line.addWidget(close)
        line.setAlignment(close, Qt.AlignmentFlag.AlignRight)
        return line

    def _keeper(self, name: str, value: str) -> Callable[[bool], None]:
        def keep(checked: bool = False) -> None:
            setattr(self._settings, name, value)

        return keep

    def _on_colours_chosen(self, row: int) -> None:
        self._settings.colours = self.colours.itemData(row)

    def _reset(self) -> None:
        self._settings.clear("look")
        self._settings.clear("editing")
        self._settings.autosave = True
        self._show_kept()

    def _show_kept(self) -> None:
        self.themes[self._settings.theme].setChecked(True)
        self.colours.setCurrentIndex(self.colours.findData(self._settings.colours))
        for name, box in self.switches.items():
            box.setChecked(getattr(self._settings, name))
