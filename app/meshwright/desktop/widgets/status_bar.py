"""The window's status bar: the last message, the state of compilation, the hovered half-edge."""

from qtpy.QtWidgets import QLabel, QStatusBar

from meshwright.desktop.widgets.announcements import announce


class StatusBar(QStatusBar):
    """Three texts: the message at the left, preparation and half-edge at the right."""

    def __init__(self) -> None:
        super().__init__()
        self._message = QLabel()
        self._preparation = QLabel()
        self._halfedge = QLabel()
        self.setSizeGripEnabled(False)
        self.addWidget(self._message, 1)
        self.addPermanentWidget(self._preparation)
        self.addPermanentWidget(self._halfedge)

    @property
    def message(self) -> str:
        """The message that is shown."""
        return self._message.text()

    @property
    def preparation(self) -> str:
        """What is being compiled or loaded; empty when nothing is."""
        return self._preparation.text()

    @property
    def halfedge(self) -> str:
        """The description of the half-edge under the mouse; empty without one."""
        return self._halfedge.text()

    def show_message(self, sentence: str) -> None:
        """Replace the message."""
        self._message.setText(sentence)
        announce(self._message, sentence)

    def show_preparation(self, text: str) -> None:
        """Show what is being compiled or loaded."""
        self._preparation.setText(text)

    def show_halfedge(self, text: str) -> None:
        """Describe the half-edge under the mouse."""
        self._halfedge.setText(text)
