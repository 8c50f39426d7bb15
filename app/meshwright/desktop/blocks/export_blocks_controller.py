"""The export of block grids: dialog, thread, bar with *Cancel*, and a sentence at the end."""

from __future__ import annotations

import logging
import threading
from functools import partial
from pathlib import Path

from qtpy.QtWidgets import QFileDialog, QWidget

from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.blocks.export_blocks_dialog import BlockExport, ExportBlocksDialog
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.export_bar import ExportBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.desktop.widgets.wording import plural
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright_core import MeshError
from meshwright_core.blocks.grid import BlockGrid, block_grid
from meshwright_core.blocks.sizing import Sizing
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.errors import sentence
from meshwright_core.io.grids.block_files import BLOCK_MESH_DICT, check_format, losses, write_blocks

_log = logging.getLogger(__name__)
STAGES = ("Dividing blocks for {}", "Writing {}")


class _CancelledError(Exception):
    """Raised in the thread when the export was cancelled."""


class ExportBlocksController(Controller):
    """Asks for sizes and format, and writes the grid in a thread, one at a time."""

    def __init__(
        self,
        document: Document,
        status: StatusBar,
        notice: NoticeBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document = document
        self._status, self._notice, self._parent = status, notice, parent
        self._dispatch = Dispatcher()
        self._thread: threading.Thread | None = None
        self._stop = threading.Event()
        self._order = BlockExport()
        self.bar = ExportBar()
        self.bar.cancelled.connect(self.cancel)

    @property
    def running(self) -> bool:
        """True while a grid is made or written."""
        return self._thread is not None

    def ask(self) -> None:
        """Show the dialog, ask for a file, and start."""
        if self.running:
            self._status.show_message("An export is already running: wait, or cancel it.")
            return
        mesh = self._document.need_mesh()
        try:
            structure = BlockStructure.of(mesh.copy())
        except MeshError as error:
            self._notice.show_message(sentence(str(error)))
            return
        dialog = ExportBlocksDialog(structure, mesh.grid_plan, self._order, self._parent)
        accepted = bool(dialog.exec())
        plan, self._order = dialog.plan, dialog.order
        dialog.deleteLater()
        if not accepted:
            return
        path = self._ask_path(self._order.ending)
        if path:
            self._document.plan_grid(plan, "Sizes and layers of the grid")
            self.start(self._order, path)

    def _ask_path(self, ending: str) -> str:
        document = self._document
        folder = document.path.parent if document.path else Path()
        name = ending if ending == BLOCK_MESH_DICT else f"{document.name or 'grid'}{ending}"
        shown = name if ending == BLOCK_MESH_DICT else f"{ending[1:].upper()} (*{ending})"
        path, _ = QFileDialog.getSaveFileName(
            self._parent, "Export blocks", str(folder / name), shown
        )
        if path and ending != BLOCK_MESH_DICT and not path.lower().endswith(ending):
            path += ending
        return str(path)

    def start(self, order: BlockExport, path: str) -> None:
        """Make the grid of the present mesh and write it in the background."""
        mesh, name = self._document.need_mesh().copy(), Path(path).name
        if order.ending == BLOCK_MESH_DICT and name != BLOCK_MESH_DICT:
            self._notice.show_message(f"OpenFOAM reads a file that is called {BLOCK_MESH_DICT}.")
            return
        try:
            check_format(path, order.order, order.extrusion is not None)
            structure = BlockStructure.of(mesh)
            sizing = Sizing.planned(structure, mesh.grid_plan)
        except MeshError as error:
            self._notice.show_message(sentence(str(error)))
            return
        self._stop.clear()
        self.bar.show_stage(STAGES[0].format(name))
        self._thread = threading.Thread(
            target=self._work, args=(structure, sizing, order, path), name="block-export",
            daemon=True,
        )  # fmt: skip
        self._thread.start()

    def cancel(self) -> None:
        """Cancel the export before the file is written; it is written whole or not at all."""
        self._stop.set()
        self.bar.show_stage("Cancelling\u2026")

    def close(self) -> None:
        """Cancel, and wait for the present stage."""
        super().close()
        self._stop.set()
        if self._thread is not None:
            self._thread.join(10.0)
            self._thread = None

    def _work(
        self, structure: BlockStructure, sizing: Sizing, order: BlockExport, path: str
    ) -> None:
        """Make and write the grid; runs in the thread and reports through the dispatcher."""
        name = Path(path).name
        try:
            self._give_way()
            grid = block_grid(structure, sizing)
            self._give_way()
            self._dispatch(partial(self._on_stage, STAGES[1].format(name)))
            walls = tuple(wall.name for wall in sizing.walls)
            files = write_blocks(path, grid, order.order, order.extrusion, walls)
        except _CancelledError:
            words, failed = f"Cancelled: {name} was not written.", False
        except MeshError as error:
            words, failed = sentence(str(error)), True
        except Exception as error:  # a thread's boundary: the bar must disappear in any case
            _log.exception("an export broke off")
            words, failed = f"{name} was not written: {type(error).__name__}: {error}", True
        else:
            words, failed = result_words(grid, files), False
            if lost := losses(path, grid):
                words, failed = " ".join((words, *lost)), True
        self._dispatch(partial(self._finish, words, failed))

    def _give_way(self) -> None:
        if self._stop.is_set():
            raise _CancelledError

    def _on_stage(self, words: str) -> None:
        if self.running and not self._stop.is_set():
            self.bar.show_stage(words)

    def _finish(self, words: str, failed: bool) -> None:
        if self._thread is None:
            return  # the window has closed
        self._thread.join()
        self._thread = None
        self.bar.hide()
        if failed:
            self._notice.show_message(words)
        else:
            self._status.show_message(words)


def result_words(grid: BlockGrid, files: list[Path]) -> str:
    """What was written, as a sentence."""
    quality = grid.quality
    names = ", ".join(file.name for file in files)
    blocks = plural(len(grid.shapes), "block")
    worst = f"worst scaled Jacobian {quality.worst_scaled_jacobian:.2f}"
    inverted = f"; {quality.inverted:,} cells are inverted" if quality.inverted else ""
    return f"Written: {names} ({blocks}, {grid.cell_count:,} cells, {worst}{inverted})."
