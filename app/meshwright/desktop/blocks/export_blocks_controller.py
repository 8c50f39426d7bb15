"""The export of block grids: dialog, thread, bar with *Cancel*, and a sentence at the end."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from qtpy.QtWidgets import QWidget

from meshwright.desktop.blocks.export_blocks_dialog import BlockExport, ExportBlocksDialog
from meshwright.desktop.exporting.export_task import ExportTask
from meshwright.desktop.widgets.basic import NoticeBar
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

STAGES = ("Dividing blocks for {}", "Writing {}")


class ExportBlocksController(ExportTask):
    """Asks for sizes and format, and writes the grid in a thread, one at a time."""

    def __init__(
        self,
        document: Document,
        status: StatusBar,
        notice: NoticeBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(document, status, notice, parent, theme)
        self._order = BlockExport()

    def ask(self) -> None:
        """Show the dialog, ask for a file, and start."""
        if self._refused():
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
        ending = self._order.ending
        if ending == BLOCK_MESH_DICT:
            path = self._ask_path("Export blocks", ending, "")
        else:
            name = f"{self._document.name or 'grid'}{ending}"
            path = self._ask_path("Export blocks", name, ending)
        if path:
            self._document.plan_grid(plan, "Sizes and layers of the grid")
            self.start(self._order, path)

    def start(self, order: BlockExport, path: str) -> None:
        """Make the grid of the present mesh and write it in the background."""
        mesh, name = self._document.need_mesh().copy(), Path(path).name
        if order.ending == BLOCK_MESH_DICT and name != BLOCK_MESH_DICT:
            self._notice.show_message(
                f"{name} was not written: OpenFOAM reads a file that is called {BLOCK_MESH_DICT}."
            )
            return
        try:
            check_format(path, order.order, order.extrusion is not None)
            structure = BlockStructure.of(mesh)
            sizing = Sizing.planned(structure, mesh.grid_plan)
        except MeshError as error:
            self._notice.show_message(sentence(str(error)))
            return
        self.bar.show_stage(STAGES[0].format(name))
        self._start(path, partial(self._write, structure, sizing, order, path))

    def _write(
        self, structure: BlockStructure, sizing: Sizing, order: BlockExport, path: str
    ) -> tuple[str, bool]:
        """Make and write the grid, in the thread."""
        self._give_way()
        grid = block_grid(structure, sizing)
        self._give_way()
        words = STAGES[1].format(Path(path).name)
        self._report(partial(self.bar.show_stage, words))
        walls = tuple(wall.name for wall in sizing.walls)
        files = write_blocks(path, grid, order.order, order.extrusion, walls)
        lost = (*grid.remarks, *losses(path, grid))
        return " ".join((result_words(grid, files), *lost)), bool(lost)


def result_words(grid: BlockGrid, files: list[Path]) -> str:
    """What was written, as a sentence."""
    quality = grid.quality
    names = ", ".join(file.name for file in files)
    blocks = plural(len(grid.shapes), "block")
    worst = f"worst scaled Jacobian {quality.worst_scaled_jacobian:.2f}"
    inverted = f"; {quality.inverted:,} cells are inverted" if quality.inverted else ""
    return f"Written: {names} ({blocks}, {grid.cell_count:,} cells, {worst}{inverted})."
