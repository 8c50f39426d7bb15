"""A dialog with a question, and the answers as buttons."""

from collections.abc import Sequence

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QDialog, QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from meshwright.desktop.widgets.basic import named
from meshwright.graphics.theme import GRID


class QuestionDialog(QDialog):
    """``title`` is the question, ``text`` stands below; :attr:`answer` is the id of the answer.

    ``answers`` are (id, text), the recommended one last; ``aside`` is placed apart at the left, for
    an answer that discards something. Escape gives the empty answer.
    """

    def __init__(
        self,
        title: str,
        text: str,
        answers: Sequence[tuple[str, str]],
        aside: tuple[str, str] | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.answer = ""
        self.answer_text = text
        self.buttons: dict[str, QPushButton] = {}
        self.setWindowTitle("Meshwright")
        self.setFixedWidth(440)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(3 * GRID, 3 * GRID, 3 * GRID, 2 * GRID)
        layout.setSpacing(GRID)
        heading, story = named(title, "Question"), named(text, "Label")
        for part in (heading, story):
            part.setWordWrap(True)
            part.setTextFormat(Qt.TextFormat.PlainText)
            layout.addWidget(part)
        layout.addSpacing(2 * GRID)
        line = QHBoxLayout()
        line.setSpacing(GRID)
        if aside is not None:
            line.addWidget(self._button(*aside))
        line.addStretch(1)
        for answer, word in answers:
            line.addWidget(self._button(answer, word))
        recommended = self.buttons[answers[-1][0]]
        recommended.setObjectName("Primary")
        recommended.setDefault(True)
        recommended.setFocus()
        layout.addLayout(line)

    def _button(self, answer: str, word: str) -> QPushButton:
        button = QPushButton(word)
        button.setAutoDefault(False)
        button.clicked.connect(lambda checked=False: self._take(answer))
        self.buttons[answer] = button
        return button

    def _take(self, answer: str) -> None:
        self.answer = answer
        self.accept()

    def ask(self) -> str:
        """Show the dialog and return the answer."""
        self.exec()
        self.deleteLater()
        return self.answer
