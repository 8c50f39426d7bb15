"""The window: canvas, panels, menus; what actions do is here, what a mesh does is not."""

from pathlib import Path

from qtpy.QtCore import QPoint, QSize, Qt, QTimer, Signal
from qtpy.QtGui import QCloseEvent, QShowEvent
from qtpy.QtWidgets import (
    QApplication,
    QFileDialog,
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

from app.assistant import Assistant, State
from app.desktop import actions, pages
from app.desktop.agent_panel import AgentPanel
from app.desktop.canvas import Canvas
from app.desktop.dispatch import Dispatcher
from app.desktop.operation_menu import OperationMenu
from app.desktop.operations_panel import OperationsPanel
from app.desktop.score_panel import ScorePanel
from app.desktop.sidebar import sidebar
from app.desktop.vertex_menu import vertex_menu
from app.desktop.warmup import Warmup
from app.desktop.widgets import Notice, sentence
from app.document import Document
from app.history import YOU, Row
from app.markers import label
from app.theme import THEMES, style_sheet, theme
from meshcore import Operation, io
from meshcore.operations import of_kind

PREPARING = "Still preparing the operations: a moment, please."
POINT_FIRST = "Point at a half-edge first, then press the key."


class MainWindow(QMainWindow):
    """A view on ``document``; the mesh is changed by the document only.

    ``opened()`` comes when the canvas is there too, shortly after the window itself.
    """

    opened = Signal()

    def __init__(
        self,
        document: Document,
        theme_name: str = "light",
        assistant: Assistant | None = None,
        ready: bool = False,
    ) -> None:
        super().__init__()
        self.document = document
        self.theme = theme(theme_name)
        self.assistant = assistant or Assistant(document, Dispatcher())
        self.ready = self.agent_ready = ready
        self.canvas = Canvas(document, self.theme)
        self.actions_by_id = actions.ActionSet(self)
        self.score_panel = ScorePanel(document, self.theme)
        self.agent_panel = AgentPanel(document, self.assistant, self.actions_by_id, self.theme)
        self.operations_panel = OperationsPanel(document)
        self.operations_panel.ready = ready
        self.notice = Notice(self.theme)
        self.menu: OperationMenu | None = None
        self.warmup = Warmup(self)
        self._arrange()
        self._connect()
        self.set_theme(theme_name)
        self._on_replaced()
        self._on_saved_changed()

    # Putting it together

    def _arrange(self) -> None:
        self.resize(1280, 800)
        self.setMinimumSize(880, 560)
        self.toolbar = self._make_toolbar()
        self.addToolBar(self.toolbar)
        self._fill_menus()
        self.empty = pages.EmptyPage(
            self.actions_by_id["new"].trigger, self.actions_by_id["open"].trigger
        )
        self.pages = QStackedWidget()
        self.pages.addWidget(self.canvas)
        self.pages.addWidget(self.empty)
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.notice)
        column.addWidget(self.pages, 1)
        whole = QWidget()
        row = QHBoxLayout(whole)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(left, 1)
        row.addWidget(sidebar(self.score_panel, self.agent_panel, self.operations_panel))
        self.setCentralWidget(whole)
        self.said = QLabel()
        self.pointed = QLabel()
        self.preparing = QLabel()
        bar = self.statusBar()
        bar.setSizeGripEnabled(False)
        bar.addWidget(self.said, 1)
        bar.addPermanentWidget(self.preparing)
        bar.addPermanentWidget(self.pointed)

    def _make_toolbar(self) -> QToolBar:
        bar = QToolBar("Tools")
        bar.setMovable(False)
        bar.setIconSize(QSize(20, 20))
        bar.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
        words = {action.id: action.word for action in actions.ACTIONS}
        for number, group in enumerate(actions.TOOLBAR):
            if not group:
                space = QWidget()
                space.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
                bar.addWidget(space)
            elif number and actions.TOOLBAR[number - 1]:
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
        for title, members in actions.groups(self):
            menu = bar.addMenu(title)
            for action in members:
                menu.addAction(self.actions_by_id[action.id])

    def _connect(self) -> None:
        document, assistant = self.document, self.assistant
        document.replaced.connect(self._on_replaced)
        document.history_changed.connect(self._on_history_changed)
        document.saved_changed.connect(self._on_saved_changed)
        document.hover_changed.connect(self._on_hover_changed)
        assistant.changed.connect(self._refresh)
        assistant.said.connect(self.say)
        assistant.failed.connect(self.notice.tell)
        self.canvas.halfedge_chosen.connect(self.offer)
        self.canvas.vertex_chosen.connect(self._offer_vertex)
        self.warmup.noted.connect(self.preparing.setText)
        self.warmup.ready.connect(self._on_ready)
        self.warmup.agent_ready.connect(self._on_agent_ready)
        self.warmup.failed.connect(self._on_warmup_failed)

    def _disconnect(self) -> None:
        document, assistant = self.document, self.assistant
        document.replaced.disconnect(self._on_replaced)
        document.history_changed.disconnect(self._on_history_changed)
        document.saved_changed.disconnect(self._on_saved_changed)
        document.hover_changed.disconnect(self._on_hover_changed)
        assistant.changed.disconnect(self._refresh)
        assistant.said.disconnect(self.say)
        assistant.failed.disconnect(self.notice.tell)
        for part in (self.canvas, self.score_panel, self.agent_panel, self.operations_panel):
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
        """End runs and threads, free VTK's resources."""
        if self.menu is not None:
            self.menu.close()
        self.assistant.close()
        self.warmup.stop()
        self._disconnect()
        super().closeEvent(event)

    # Words and looks

    def say(self, sentence: str) -> None:
        """One sentence in the status line."""
        self.said.setText(sentence)

    def set_theme(self, name: str) -> None:
        """``"light"`` or ``"dark"``."""
        self.theme = theme(name)
        self.setStyleSheet(style_sheet(self.theme))
        self.actions_by_id.set_theme(self.theme)
        for part in (self.canvas, self.score_panel, self.agent_panel, self.notice):
            part.set_theme(self.theme)

    def toggle_theme(self) -> None:
        """The other theme."""
        names = list(THEMES)
        self.set_theme(names[1 - names.index(self.theme.name)])

    def _refresh(self) -> None:
        self.actions_by_id.refresh()
        self.agent_panel.refresh()

    # What the document says

    def _on_replaced(self) -> None:
        self._fill_menus()
        self.pages.setCurrentWidget(self.empty if self.document.empty else self.canvas)
        self.notice.hide()
        self.say("")
        self._refresh()

    def _on_history_changed(self) -> None:
        self._refresh()

    def _on_saved_changed(self) -> None:
        name = self.document.name or "No mesh"
        self.setWindowTitle(f"{name}[*] \u2013 Meshwright")
        self.setWindowModified(self.document.modified)

    def _on_hover_changed(self, halfedge: int) -> None:
        mesh = self.document.mesh
        if mesh is None or halfedge < 0:
            self.pointed.setText("")
            return
        ends = f"{mesh.origin(halfedge)} \u2192 {mesh.target(halfedge)}"
        self.pointed.setText(f"Half-edge {halfedge}:  {ends}")

    def _on_ready(self) -> None:
        self.ready = self.operations_panel.ready = True
        self._refresh()

    def _on_agent_ready(self) -> None:
        self.agent_ready = True
        self.preparing.setText("")
        self._refresh()

    def _on_warmup_failed(self, sentence: str) -> None:
        self.preparing.setText("")
        self.notice.tell(sentence)

    # Operations

    def operate(self, operation: Operation) -> None:
        """Do ``operation`` on the half-edge under the mouse, or say why not."""
        halfedge = self.canvas.under_mouse
        if halfedge < 0:
            self.say(POINT_FIRST)
        elif not self.ready:
            self.say(PREPARING)
            self.canvas.refuse(PREPARING)
        else:
            self._submit(operation, halfedge)

    def offer(self, halfedge: int, where: QPoint) -> None:
        """Open the menu of operations of ``halfedge`` at ``where`` on the screen."""
        mesh = self.document.mesh
        if mesh is None:
            return
        if not self.ready:
            self.say(PREPARING)
            self.canvas.refuse(PREPARING)
            return
        verdicts = self.document.allowed(halfedge)
        offers = [(info, verdicts[info.operation]) for info in of_kind(mesh.kind)]
        ends = f"{mesh.origin(halfedge)} \u2192 {mesh.target(halfedge)}"
        revision = self.document.revision
        self.menu = OperationMenu(f"Half-edge {ends}", offers, self)
        self.menu.chosen.connect(lambda operation: self._take(operation, halfedge, revision))
        self.menu.closed.connect(self._on_menu_closed)
        self.canvas.freeze(True)
        self.menu.popup(where)

    def _take(self, operation: Operation, halfedge: int, revision: int) -> None:
        if revision == self.document.revision:  # an agent may have gone on behind the menu
            self._submit(operation, halfedge)

    def _submit(self, operation: Operation, halfedge: int) -> None:
        verdict = self.document.check(operation, halfedge)
        if not verdict:
            self.say(sentence(verdict.reason))
            self.canvas.refuse(sentence(verdict.reason))
            return
        self.document.submit(operation, halfedge)
        self.say(told(self.document.history.last))

    def _on_menu_closed(self) -> None:
        self.menu = None
        self.canvas.freeze(False)

    def _offer_vertex(self, vertex: int, where: QPoint) -> None:
        menu = vertex_menu(self.document, vertex, self.ready, self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(where)

    def clean_all(self) -> None:
        """Remove all global lines that can be removed."""
        if not self.ready:
            self.say(PREPARING)
            return
        count = self.document.clean_all()
        lines = "1 line" if count == 1 else f"{count} lines"
        self.say(f"Removed {lines}." if count else "There is no line that can be removed.")

    def smooth(self) -> None:
        """Smooth the whole mesh."""
        if not self.ready:
            self.say(PREPARING)
            return
        self.document.smooth()
        self.say("Smoothed.")

    def undo(self) -> None:
        """Take back one step."""
        row = self.document.undo()
        if row is not None:
            self.say(f"Undone: {row.title}.")

    def redo(self) -> None:
        """Do one step again."""
        row = self.document.redo()
        if row is not None:
            self.say(f"Done again: {row.title}.")

    # Agent

    def play_or_pause(self) -> None:
        """Pause a played run; else play."""
        if self.assistant.state is State.PLAYING:
            self.assistant.pause()
        else:
            self.assistant.play()

    # Files and shapes

    def choose_file(self) -> None:
        """Ask for a file and open it."""
        folder = str(self.document.path.parent) if self.document.path else ""
        path, _ = QFileDialog.getOpenFileName(self, "Open a mesh", folder, _files())
        if path:
            self.open(path)

    def open(self, path: str | Path) -> None:
        """Open a mesh file; what is wrong with it is one sentence in the notice bar."""
        try:
            self.document.open(path)
        except (ValueError, OSError) as error:
            self.notice.tell(_one_line(error))
        else:
            self.canvas.fit()

    def save(self) -> None:
        """Write the mesh to its file, or ask for one."""
        if self.document.path is None:
            self.save_as()
        else:
            self._save(None)

    def save_as(self) -> None:
        """Ask for a file and write the mesh to it."""
        start = str(self.document.path or f"{self.document.name or 'mesh'}.vtk")
        path, _ = QFileDialog.getSaveFileName(self, "Save the mesh as", start, _files())
        if path:
            self._save(path)

    def _save(self, path: str | None) -> None:
        try:
            written = self.document.save(path)
        except (ValueError, OSError) as error:
            self.notice.tell(_one_line(error))
        else:
            self.say(f"Saved {written.name}.")

    def choose_shape(self) -> None:
        """Ask for a shape of the gallery and mesh it."""
        from app.desktop.gallery import Gallery

        dialog = Gallery(self.document.kind, self.theme, self)
        if dialog.exec():
            self.make(dialog.shape, dialog.kind)
        dialog.deleteLater()

    def make(self, shape: str, kind: str) -> None:
        """Mesh a gallery shape with elements of ``kind``."""
        from meshcore import generate, shapes

        try:
            mesh = generate.mesh_domain(shapes.shape(shape), kind)
        except ValueError as error:
            self.notice.tell(_one_line(error))
        else:
            self.document.replace(mesh, shape)

    # Help

    def show_keys(self) -> None:
        """All keys, and what the mouse does."""
        pages.KeysDialog(actions.groups(self), self).exec()

    def show_about(self) -> None:
        """Version and licences."""
        pages.AboutDialog(self).exec()

    def createPopupMenu(self) -> QMenu | None:  # noqa: N802
        """No menu that hides the toolbar."""
        return None


def told(row: Row | None) -> str:
    """``Flip left: s 8 to 6 (-2)``, for the status line."""
    if row is None:
        return ""
    who = "" if row.by == YOU else f" by {row.by}"
    return f"{row.title}{who}:  s {row.before} \u2192 {row.after}  ({label(row.change)})"


def _files() -> str:
    endings = " ".join(f"*{ending}" for ending in io.endings())
    return f"Meshes ({endings});;All files (*)"


def _one_line(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        name = Path(error.filename).name if error.filename else "The file"
        return f"{name}: {error.strerror}."
    return sentence(" ".join(str(error).split()))
