"""The main window: constructs the controllers and lays out their widgets."""

from qtpy.QtCore import QSize, Qt, QTimer, Signal
from qtpy.QtGui import QCloseEvent, QKeyEvent, QResizeEvent, QShowEvent
from qtpy.QtWidgets import (
    QApplication,
    QHBoxLayout,
    QMainWindow,
    QMenu,
    QSizePolicy,
    QStackedWidget,
    QToolBar,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from meshwright.assistant.assistant import Assistant
from meshwright.desktop.actions import registry
from meshwright.desktop.actions.context import ActionContext
from meshwright.desktop.actions.dispatcher import ActionDispatcher
from meshwright.desktop.agent.agent_controller import AgentController
from meshwright.desktop.agent.agent_panel import AgentPanel
from meshwright.desktop.agent.hints_controller import HintsController
from meshwright.desktop.application.error_notice import ErrorNotice
from meshwright.desktop.application.kernel_warmup import KernelWarmup
from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.application.preferences_controller import PreferencesController, theme_name
from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.blocks.blocks_controller import BlocksController
from meshwright.desktop.blocks.export_blocks_controller import ExportBlocksController
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Connections, Controller
from meshwright.desktop.editing.cleanable_lines_controller import CleanableLinesController
from meshwright.desktop.editing.click_dispatch import ClickDispatch
from meshwright.desktop.editing.edit_controller import EditController
from meshwright.desktop.editing.hover_controller import HoverController
from meshwright.desktop.editing.inverted_controller import InvertedController
from meshwright.desktop.editing.keyboard_navigation import KeyboardNavigation
from meshwright.desktop.editing.names_controller import NamesController
from meshwright.desktop.editing.selection_controller import SelectionController
from meshwright.desktop.editing.spoken_halfedge import SpokenHalfedge
from meshwright.desktop.editing.unused_keys import UnusedKeys
from meshwright.desktop.editing.vertex_commands import VertexCommands
from meshwright.desktop.files.file_controller import FileController
from meshwright.desktop.help.help_controller import HelpController
from meshwright.desktop.help.tour import TourPlaces
from meshwright.desktop.history.changes_controller import ChangesController
from meshwright.desktop.history.playback_controller import PlaybackController
from meshwright.desktop.levels.level_controller import LevelController
from meshwright.desktop.main_window.empty_page import EmptyPage
from meshwright.desktop.main_window.left_column import LeftColumn
from meshwright.desktop.main_window.sidebar import Section, Sidebar
from meshwright.desktop.quality.colour_controller import ColourController
from meshwright.desktop.quality.quality_controller import QualityController
from meshwright.desktop.widgets.action_set import ActionSet, with_mnemonics
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.event_filters import MENU_KEYS, OwnKeys, PanelInput
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.theme import style_sheet, theme
from meshwright.puzzles.level import Level

WORDS_FROM = 1040
"""Width of the window in pixels from which the toolbar has words beside icons."""
FIRST_FRAME = 50
"""Milliseconds after which the first frame is on its way: what prepares the kernels would delay it.
"""


class MainWindow(QMainWindow):
    """The main window on ``document``.

    The window is the composition root: no other module imports it, and each controller needs only
    objects that are constructed before it. ``ready``: the kernels are loaded already. ``opened()``
    is emitted when the mesh is drawn, shortly after the window itself has appeared.
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
        self.assistant = assistant or Assistant(document, Dispatcher())
        self.readiness = Readiness(editing=ready, agent=ready)
        self.theme = theme(theme_name(self.settings), self.settings.colours)
        self.canvas = Canvas(document, self.theme)
        self.status = StatusBar()
        self.notice = NoticeBar(self.theme)
        self.actions_by_id = ActionSet(
            registry.ACTIONS, registry.MENUS, self, self.canvas, self.theme
        )
        self.warmup = KernelWarmup(self.readiness, self.status, self.notice, self.theme)
        self._connections = Connections()
        self._connections.add(document.replaced, self._clear_messages)
        self.controllers: list[Controller] = [self.warmup]
        self._make_controllers()
        self._arrange()
        self._make_help()
        self.dispatcher = ActionDispatcher(self.actions_by_id, self._action_context(), self.theme)
        self.controllers.append(self.dispatcher)
        self.setStyleSheet(style_sheet(self.theme))
        self._connections.add(document.replaced, self._on_replaced)
        self._on_replaced()

    # Composition

    def _make_controllers(self) -> None:
        document, assistant, settings = self.document, self.assistant, self.settings
        canvas, readiness, actions = self.canvas, self.readiness, self.actions_by_id
        status, notice, colours = self.status, self.notice, self.theme
        self.files = FileController(
            document, assistant, canvas, settings, actions, status, notice, self, colours
        )
        self.playback = PlaybackController(
            document, settings, readiness, actions, status, notice, self, colours
        )
        self.changes = ChangesController(document, assistant, canvas, self.playback, colours)
        self.levels = LevelController(
            document, assistant, canvas, self.files, self.playback, status, notice, self, colours
        )
        self.quality = QualityController(document, canvas, settings, status, colours)
        self.colours = ColourController(
            document, canvas, self.quality.monitor, settings, status, colours
        )
        self.inverted = InvertedController(document, canvas, self.quality.monitor, colours)
        self.hover = HoverController(
            document, assistant, canvas, settings, readiness, status, colours
        )
        self.editing = EditController(
            document, canvas, self.hover, self.levels, readiness, status, self, colours
        )
        self.lines = CleanableLinesController(
            document, canvas, settings, readiness, self.hover, self.editing, status, colours
        )
        self.selection_tools = SelectionController(
            document, canvas, self.levels, readiness, actions, status, self, colours
        )
        self.names = NamesController(document, canvas, status, self, colours)
        self.blocks = BlocksController(
            document, canvas, self.hover, actions, status, notice, colours
        )
        self.block_export = ExportBlocksController(document, status, notice, self, colours)
        self.navigation = KeyboardNavigation(
            document, canvas, self.quality.highlight, status, colours
        )
        self.vertices = VertexCommands(document, canvas, self.levels, readiness, status, colours)
        self.spoken = SpokenHalfedge(document, canvas, self.hover, colours)
        self.unused_keys = UnusedKeys(document, canvas, actions, status, colours)
        self.errors = ErrorNotice(document, notice, colours)
        self.agent_panel = AgentPanel(document, assistant, readiness, settings, actions, colours)
        self.hints = HintsController(
            document, assistant, canvas, self.agent_panel, status, notice, colours
        )
        self.agent = AgentController(
            document,
            assistant,
            canvas,
            settings,
            self.agent_panel,
            self.hints,
            status,
            notice,
            self,
            colours,
        )
        self.clicks = ClickDispatch(
            canvas,
            (
                self.hints.click,
                self.blocks.click,
                self.selection_tools.click,
                self.editing.click_armed,
                self.lines.click,
                self.editing.click_menu,
            ),
            (self.hover.put_down, self.blocks.put_down, self.selection_tools.put_down),
            colours,
        )
        self.preferences = PreferencesController(
            document, canvas, settings, status, self, self.set_theme, colours
        )
        self.controllers += [
            self.files,
            self.playback,
            self.changes,
            self.levels,
            self.quality,
            self.colours,
            self.inverted,
            self.hover,
            self.editing,
            self.lines,
            self.selection_tools,
            self.names,
            self.blocks,
            self.block_export,
            self.navigation,
            self.vertices,
            self.spoken,
            self.unused_keys,
            self.errors,
            self.hints,
            self.agent,
            self.clicks,
            self.preferences,
        ]

    def _make_help(self) -> None:
        places = TourPlaces(
            window=self,
            canvas=self.canvas,
            pages=self.pages,
            columns=(self.left, self.sidebar),
            operations=self.hover.panel,
            score=self.quality.score,
            agent=self.agent_panel,
            history=(
                self.playback.timeline,
                self.playback.panel,
                self.toolbar.widgetForAction(self.actions_by_id["undo"]),
            ),
            reveal=self.reveal,
        )
        self.help = HelpController(
            self.document,
            self.canvas,
            self.settings,
            self.actions_by_id,
            self.status,
            places,
            self.theme,
        )
        self.controllers.append(self.help)

    def _action_context(self) -> ActionContext:
        return ActionContext(
            document=self.document,
            assistant=self.assistant,
            settings=self.settings,
            readiness=self.readiness,
            canvas=self.canvas,
            files=self.files,
            playback=self.playback,
            levels=self.levels,
            hover=self.hover,
            editing=self.editing,
            lines=self.lines,
            quality=self.quality,
            colours=self.colours,
            selection_tools=self.selection_tools,
            names=self.names,
            blocks=self.blocks,
            block_export=self.block_export,
            navigation=self.navigation,
            vertices=self.vertices,
            hints=self.hints,
            agent=self.agent,
            preferences=self.preferences,
            help=self.help,
            open_menus=self._open_menus,
            close=self.close,
        )

    # Layout

    def _arrange(self) -> None:
        self.resize(1280, 800)
        self.setMinimumSize(880, 560)
        self.toolbar = self._make_toolbar()
        self.addToolBar(self.toolbar)
        self.setStatusBar(self.status)
        self.empty = EmptyPage(
            self.actions_by_id["new"].trigger,
            self.actions_by_id["open"].trigger,
            self.files.open,
            self.settings,
        )
        self.pages = QStackedWidget()
        self.pages.addWidget(self.canvas)
        self.pages.addWidget(self.empty)
        middle = QWidget()
        _column(
            middle,
            self.notice,
            self.pages,
            self.block_export.bar,
            self.playback.exporting.bar,
            self.playback.timeline,
        ).setStretchFactor(self.pages, 1)
        self.left = LeftColumn(
            Section("Operations", self.hover.panel, self.settings, self.theme),
            Section("Blocks", self.blocks.panel, self.settings, self.theme),
            self.playback.panel,
        )
        self._connections.add(self.blocks.changed, lambda: self.left.show_other(self.blocks.shown))
        self.sidebar = self._make_sidebar()
        below, whole = QWidget(), QWidget()
        row = QHBoxLayout(below)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.left)
        row.addWidget(middle, 1)
        row.addWidget(self.sidebar)
        _column(whole, self.levels.bar, below).setStretchFactor(below, 1)
        self.setCentralWidget(whole)
        PanelInput(whole, self.canvas.focus)
        OwnKeys(self.menuBar(), MENU_KEYS)

    def _make_sidebar(self) -> Sidebar:
        settings, quality = self.settings, self.quality.quality
        return Sidebar(
            (
                Section("Score", self.quality.score, settings, self.theme),
                Section("Agent", self.agent_panel, settings, self.theme),
                Section("Quality", quality, settings, self.theme, quality.measures),
            )
        )

    def _make_toolbar(self) -> QToolBar:
        self._worded: list[QToolButton] = []
        bar = QToolBar("Tools")
        bar.setMovable(False)
        bar.setIconSize(QSize(20, 20))
        bar.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
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
                if self.actions_by_id.entry(action_id).word and isinstance(button, QToolButton):
                    self._worded.append(button)
        return bar

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Show words in the toolbar where there is room for all of it."""
        super().resizeEvent(event)
        style = Qt.ToolButtonStyle
        shown = self.width() >= WORDS_FROM
        for button in self._worded:
            button.setToolButtonStyle(
                style.ToolButtonTextBesideIcon if shown else style.ToolButtonIconOnly
            )

    def _fill_menus(self) -> None:
        bar = self.menuBar()
        bar.clear()
        listed = self.actions_by_id.menus(self.document.kind)
        titles = with_mnemonics([title for title, _ in listed])
        for title, (_, members) in zip(titles, listed, strict=True):
            menu = bar.addMenu(title)
            for entry in members:
                if entry.id in registry.DIVIDERS:
                    menu.addSeparator()
                menu.addAction(self.actions_by_id[entry.id])

    def _open_menus(self) -> None:
        bar = self.menuBar()
        bar.setActiveAction(bar.actions()[0])

    # Session

    def start_session(self) -> None:
        """Show errors, restore the position, save every step, offer unsaved work, and show the tour
        at the first start: for a window that a user has started.
        """
        self.errors.watch()
        self.preferences.restore_place()
        self.agent.prepare_while_idle(self.readiness)
        self.files.watch()
        self.opened.connect(self.help.welcome)
        # after everything else that starts with the window
        self.opened.connect(lambda: QTimer.singleShot(0, self.files.offer_lost))

    def prepare_agent(self) -> None:
        """Load the policy as soon as the kernels of the editor are loaded."""
        self._connections.add(self.readiness.changed, self._on_readiness_changed)

    def play_level(self, level: Level) -> None:
        """Start a level; no question is asked about the mesh that it replaces."""
        self.levels.play.open(level)

    def leave(self) -> None:
        """Close the window at once, without a question; unsaved work can be recovered."""
        self.files.leave()

    def stop_preparing(self) -> None:
        """End the processes and threads that compile or load kernels."""
        self.warmup.close()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802
        """Build the canvas once the window has been painted."""
        super().showEvent(event)
        if not self.canvas.built:
            QTimer.singleShot(0, self._build)

    def _build(self) -> None:
        QApplication.processEvents()  # let the frame be painted before the slow imports
        if self.canvas.built or not self.isVisible():
            return
        self.canvas.build()
        self.canvas.focus()
        self.opened.emit()
        if not self.readiness.editing:
            QTimer.singleShot(FIRST_FRAME, self.warmup.start)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Escape gives the keyboard focus to the canvas; other keys that nothing has used are
        explained.
        """
        if event.key() == Qt.Key.Key_Escape and not self.canvas.plotter.hasFocus():
            self.canvas.focus()
        else:
            self.unused_keys.explain(event)

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802
        """Ask about unsaved work; then end runs and threads, and free VTK's resources."""
        if not self.files.may_drop():
            event.ignore()
            return
        self._connections.close()
        for controller in self.controllers:
            controller.close()
        self.empty.release()
        self.canvas.release()
        super().closeEvent(event)

    def createPopupMenu(self) -> QMenu | None:  # noqa: N802
        """Disable Qt's menu that hides the toolbar."""
        return None

    # Appearance

    def set_theme(self, name: str) -> None:
        """Use the theme ``"light"`` or ``"dark"``, with the colours of the settings."""
        self.theme = theme(name, self.settings.colours)
        self.setStyleSheet(style_sheet(self.theme))
        for widget in (self.canvas, self.notice, self.left, self.sidebar):
            widget.set_theme(self.theme)
        for controller in self.controllers:
            controller.set_theme(self.theme)

    def reveal(self, panel: QWidget) -> None:
        """Unfold ``panel``, and scroll to it."""
        if panel is self.hover.panel:
            self.left.reveal()
        else:
            self.sidebar.reveal(panel)

    # Following the document and the kernels

    def _clear_messages(self) -> None:
        self.notice.hide()
        self.status.show_message("")

    def _on_replaced(self) -> None:
        self._fill_menus()
        self.pages.setCurrentWidget(self.empty if self.document.empty else self.canvas)

    def _on_readiness_changed(self) -> None:
        if self.readiness.editing and not self.assistant.loading:
            self.assistant.prepare()


def _column(owner: QWidget, *members: QWidget) -> QVBoxLayout:
    """Lay out ``members`` one below the other, without gaps."""
    column = QVBoxLayout(owner)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(0)
    for member in members:
        column.addWidget(member)
    return column
