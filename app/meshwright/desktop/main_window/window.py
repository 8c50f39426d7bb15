"""The window: its parts and their wiring. What actions do is in its controllers."""

from qtpy.QtCore import QSize, Qt, QTimer, Signal
from qtpy.QtGui import QCloseEvent, QShowEvent
from qtpy.QtWidgets import (
    QApplication,
    QHBoxLayout,
    QLabel,
    QMainWindow,
    QMenu,
    QSizePolicy,
    QStackedWidget,
    QToolBar,
    QVBoxLayout,
    QWidget,
)

from meshwright.assistant.assistant import Assistant
from meshwright.desktop.actions import registry
from meshwright.desktop.agent.agent_controller import AgentControl
from meshwright.desktop.agent.agent_panel import AgentPanel
from meshwright.desktop.application.kernel_warmup import Warmup
from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.application.preferences_controller import Preferences
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.editing.cleanable_lines_controller import Lines
from meshwright.desktop.editing.edit_controller import Editing
from meshwright.desktop.editing.hover_controller import Pointing
from meshwright.desktop.editing.inverted_controller import Inverted
from meshwright.desktop.editing.keyboard_navigation import Walking
from meshwright.desktop.editing.operations_panel import OperationsPanel
from meshwright.desktop.editing.selection_controller import Selecting
from meshwright.desktop.files.file_controller import Files
from meshwright.desktop.help.help_controller import Guide
from meshwright.desktop.history.playback_controller import Film
from meshwright.desktop.levels.level_controller import Levels
from meshwright.desktop.main_window import empty_page
from meshwright.desktop.main_window.left_column import LeftColumn
from meshwright.desktop.main_window.sidebar import Section, Sidebar
from meshwright.desktop.quality.quality_controller import Dashboard
from meshwright.desktop.widgets.basic import Notice
from meshwright.document.document import Document
from meshwright.graphics.theme import style_sheet, theme


class MainWindow(QMainWindow):
    """A view on ``document``; the mesh is changed by the document only.

    Controllers say what happens: ``files``, ``editing``, ``film``, ``agent``, ``guide``.
    ``opened()`` comes when the canvas is there too, shortly after the window itself.
    """

    opened = Signal()

    def __init__(
        self,
        document: Document,
        assistant: Assistant | None = None,
        ready: bool = False,
        settings: Settings | None = None,
    ) -> None:
        super().__init__()
        self.document = document
        self.settings = settings or Settings()
        self.theme = theme("light", self.settings.colours)
        self.assistant = assistant or Assistant(document, Dispatcher())
        self.ready = self.agent_ready = ready
        self.files, self.editing, self.film = Files(self), Editing(self), Film(self)
        self.agent, self.guide = AgentControl(self), Guide(self)
        self.dashboard, self.preferences = Dashboard(self), Preferences(self)
        self.pointing, self.selecting = Pointing(self), Selecting(self)
        self.lines, self.walking = Lines(self), Walking(self)
        self.inverted, self.levels = Inverted(self), Levels(self)
        self.controllers = (
            self.files,
            self.editing,
            self.pointing,
            self.selecting,
            self.lines,
            self.walking,
            self.inverted,
            self.levels,
            self.film,
            self.agent,
            self.guide,
            self.dashboard,
            self.preferences,
        )
        self.canvas = Canvas(document, self.theme)
        self.actions_by_id = registry.ActionSet(self)
        self.score_panel = self.dashboard.score
        self.agent_panel = AgentPanel(document, self.assistant, self.actions_by_id, self.theme)
        self.operations_panel = OperationsPanel(document, self.theme)
        self.notice = Notice(self.theme)
        self.warmup = Warmup(self)
        self._arrange()
        self._connect()
        self._on_replaced()

    # Putting it together

    def _arrange(self) -> None:
        self.resize(1280, 800)
        self.setMinimumSize(880, 560)
        self.toolbar = self._make_toolbar()
        self.addToolBar(self.toolbar)
        self._fill_menus()
        self.empty = empty_page.EmptyPage(
            self.actions_by_id["new"].trigger,
            self.actions_by_id["open"].trigger,
            self.files.open,
        )
        self.pages = QStackedWidget()
        self.pages.addWidget(self.canvas)
        self.pages.addWidget(self.empty)
        middle = QWidget()
        self.column = QVBoxLayout(middle)  # the canvas and what stands above and below it
        self.column.setContentsMargins(0, 0, 0, 0)
        self.column.setSpacing(0)
        self.column.addWidget(self.notice)
        self.column.addWidget(self.pages, 1)
        whole, below = QWidget(), QWidget()
        self.head = QVBoxLayout(whole)  # what stands over all of it
        self.head.setContentsMargins(0, 0, 0, 0)
        self.head.setSpacing(0)
        self.head.addWidget(below, 1)
        self.row = QHBoxLayout(below)  # what stands left of the canvas, the canvas, the sidebar
        self.row.setContentsMargins(0, 0, 0, 0)
        self.row.setSpacing(0)
        self.left = LeftColumn(
            Section("Operations", self.operations_panel, self.settings, self.theme)
        )
        self.row.addWidget(self.left)
        self.row.addWidget(middle, 1)
        self.sidebar = self._make_sidebar()
        self.row.addWidget(self.sidebar)
        self.setCentralWidget(whole)
        self.said = QLabel()
        self.pointed = QLabel()
        self.preparing = QLabel()
        bar = self.statusBar()
        bar.setSizeGripEnabled(False)
        bar.addWidget(self.said, 1)
        bar.addPermanentWidget(self.preparing)
        bar.addPermanentWidget(self.pointed)

    def _make_sidebar(self) -> Sidebar:
        settings, quality = self.settings, self.dashboard.quality
        return Sidebar(
            (
                Section("Score", self.score_panel, settings, self.theme),
                Section("Agent", self.agent_panel, settings, self.theme),
                Section("Quality", quality, settings, self.theme, quality.measures),
            )
        )

    def _make_toolbar(self) -> QToolBar:
        bar = QToolBar("Tools")
        bar.setMovable(False)
        bar.setIconSize(QSize(20, 20))
        bar.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
        words = {action.id: action.word for action in registry.ACTIONS}
        for number, group in enumerate(registry.TOOLBAR):
            if not group:
                space = QWidget()
                space.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
                bar.addWidget(space)
            elif number and registry.TOOLBAR[number - 1]:
                bar.addSeparator()
            for action_id in group:
                bar.addAction(self.actions_by_id[action_id])
                button = bar.widgetForAction(self.actions_by_id[action_id])
                button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
                if words[action_id]:
                    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        return bar

    def _fill_menus(self) -> None:
        bar = self.menuBar()
        bar.clear()
        for title, members in registry.groups(self):
            menu = bar.addMenu(title)
            for action in members:
                menu.addAction(self.actions_by_id[action.id])

    def _connect(self) -> None:
        self.document.replaced.connect(self._on_replaced)
        self.document.history_changed.connect(self.refresh)
        for controller in self.controllers:
            controller.connect()
        self.warmup.noted.connect(self.preparing.setText)
        self.warmup.ready.connect(self._on_ready)
        self.warmup.agent_ready.connect(self._on_agent_ready)
        self.warmup.failed.connect(self._on_warmup_failed)

    def _release(self) -> None:
        self.document.replaced.disconnect(self._on_replaced)
        self.document.history_changed.disconnect(self.refresh)
        for part in (
            *self.controllers,
            self.canvas,
            self.agent_panel,
            self.operations_panel,
        ):
            part.release()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802
        """The canvas is built once the window has been painted."""
        super().showEvent(event)
        if self.canvas.plotter is None:
            QTimer.singleShot(0, self._build)

    def _build(self) -> None:
        QApplication.processEvents()  # let the frame be seen before the slow imports
        if self.canvas.plotter is not None or not self.isVisible():
            return
        self.canvas.build()
        self.canvas.plotter.setFocus()
        self.opened.emit()
        if not self.ready:
            QTimer.singleShot(0, self.warmup.start)

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802
        """Ask for what is not saved; then end runs and threads, free VTK's resources."""
        if not self.files.may_drop():
            event.ignore()
            return
        self.warmup.stop()
        self._release()
        super().closeEvent(event)

    # Words and looks

    def say(self, sentence: str) -> None:
        """One sentence in the status line."""
        self.said.setText(sentence)

    def set_theme(self, name: str) -> None:
        """``"light"`` or ``"dark"``, in the colours that the settings say."""
        self.theme = theme(name, self.settings.colours)
        self.setStyleSheet(style_sheet(self.theme))
        self.actions_by_id.set_theme(self.theme)
        for part in (
            self.canvas,
            self.dashboard,
            self.film,
            self.guide,
            self.levels,
            self.left,
            self.sidebar,
            self.agent_panel,
            self.operations_panel,
            self.notice,
        ):
            part.set_theme(self.theme)

    def reveal(self, panel: QWidget) -> None:
        """Unfold ``panel``, and scroll to it."""
        if panel is self.left.section.panel:
            self.left.reveal()
        else:
            self.sidebar.reveal(panel)

    def refresh(self) -> None:
        """Enable what makes sense now."""
        self.actions_by_id.refresh()
        self.agent_panel.refresh()

    def createPopupMenu(self) -> QMenu | None:  # noqa: N802
        """No menu that hides the toolbar."""
        return None

    # What document and warm-up say

    def _on_replaced(self) -> None:
        self._fill_menus()
        self.pages.setCurrentWidget(self.empty if self.document.empty else self.canvas)
        self.notice.hide()
        self.say("")
        self.refresh()

    def _on_ready(self) -> None:
        self.ready = True
        self.refresh()
        self.pointing.refresh()
        self.lines.find()

    def _on_agent_ready(self) -> None:
        self.agent_ready = True
        self.preparing.setText("")
        self.refresh()

    def _on_warmup_failed(self, sentence: str) -> None:
        self.preparing.setText("")
        self.notice.tell(sentence)
