"""The dialog of the export of block grids: format, size of cells, layers at named sides."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QButtonGroup,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QScrollArea,
    QStackedWidget,
    QWidget,
)

from meshwright.desktop.exporting.export_frame import ExportFrame
from meshwright.desktop.widgets.basic import named, segment
from meshwright.desktop.widgets.number_box import DecimalBox, IntegerBox
from meshwright.desktop.widgets.wording import plural
from meshwright.graphics.theme import GRID
from meshwright_core import MeshError
from meshwright_core.blocks.sizing import STEEPEST, Sizing, division
from meshwright_core.blocks.structure import BlockStructure
from meshwright_core.core.grid_plan import GridPlan, Wall
from meshwright_core.errors import sentence
from meshwright_core.io.grids.block_files import BLOCK_MESH_DICT, HIGHEST_ORDER
from meshwright_core.io.grids.openfoam import Extrusion

FORMATS = (
    (BLOCK_MESH_DICT, "OpenFOAM, blockMeshDict"),
    (".geo", "Gmsh geometry, transfinite"),
    (".msh", "Gmsh mesh"),
    (".cgns", "CGNS, structured zones"),
    (".xyz", "Plot3D, text, with neutral map"),
    (".p3d", "Plot3D, binary, with neutral map"),
    (".vtm", "VTK multiblock"),
    (".vtu", "VTK, mesh of quads"),
    (".su2", "SU2, mesh of quads"),
    (".inp", "Abaqus, mesh of quads"),
    (".bdf", "Nastran, mesh of quads"),
)
PLANE, LAYERS, WEDGE = "plane", "layers", "wedge"
VOLUMES = (
    (PLANE, "One cell thick, for plane flow"),
    (LAYERS, "Extruded in layers"),
    (WEDGE, "Wedge around the x axis"),
)
GEOMETRY, SIZE, DIVIDE = "geometry", "size", "divide"
MODES = ((GEOMETRY, "By geometry"), (SIZE, "Cell size"), (DIVIDE, "Per edge"))
GROWTH = 1.2
USUAL_DIVIDE = 10


@dataclass(frozen=True)
class BlockExport:
    """What is written besides the grid itself."""

    ending: str = BLOCK_MESH_DICT
    """A key of :data:`FORMATS`."""
    order: int = 1
    """Of the cells."""
    volume: str = PLANE
    """A key of :data:`VOLUMES`, for OpenFOAM."""
    thickness: float = 1.0
    layers: int = 1

    @property
    def extrusion(self) -> Extrusion | None:
        """How the plane becomes a volume; None for the usual way, or other formats."""
        if self.ending != BLOCK_MESH_DICT or self.volume == PLANE:
            return None
        if self.volume == WEDGE:
            return Extrusion(wedge=True)
        return Extrusion(self.thickness, self.layers)


class SideRow:
    """The fields of one named side."""

    def __init__(self, name: str, changed: Callable[[], None]) -> None:
        self.name = name
        self.count = IntegerBox()
        self.count.setRange(0, 1_000_000)
        self.count.setSpecialValueText("by size")
        self.count.setAccessibleName(f"Cells on {name}")
        self.height = DecimalBox()
        self.height.setDecimals(6)
        self.height.setRange(0.0, 1e9)
        self.height.setSpecialValueText("none")
        self.height.setAccessibleName(f"First cell at {name}")
        self.ratio = DecimalBox()
        self.ratio.setRange(1.0, STEEPEST)
        self.ratio.setSingleStep(0.05)
        self.ratio.setValue(GROWTH)
        self.ratio.setAccessibleName(f"Growth at {name}")
        for box in (self.count, self.height, self.ratio):
            box.setMinimumWidth(108)
            box.valueChanged.connect(changed)


class ExportBlocksDialog(ExportFrame):
    """Edits a :class:`GridPlan` and a :class:`BlockExport`; says at once what comes of them."""

    def __init__(
        self,
        structure: BlockStructure,
        plan: GridPlan,
        order: BlockExport,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__("Export blocks", parent)
        self._structure = structure
        self.plan, self.order = _titled(plan, structure), order
        self._usual = float(structure.lengths.mean()) / 8.0
        self.format_box = QComboBox()
        self.order_box = QComboBox()
        self.volume_box = QComboBox()
        self.thickness = DecimalBox()
        self.layer_count = IntegerBox()
        self.modes: dict[str, QPushButton] = {}
        self._group = QButtonGroup(self)
        self.cell_size = DecimalBox()
        self.divide = IntegerBox()
        self.sides = {
            patch.title: SideRow(patch.title, self._on_changed) for patch in structure.patches
        }
        self.note.setWordWrap(True)
        self._filled = False
        self._fill()
        self._arrange()
        self._filled = True
        self._on_changed()

    def _fill(self) -> None:
        plan, order = self.plan, self.order
        for ending, title in FORMATS:
            self.format_box.addItem(title, ending)
        self.format_box.setCurrentIndex(self.format_box.findData(order.ending))
        for number, title in ((1, "Straight cells"), (2, "Quadratic cells"), (3, "Cubic cells")):
            self.order_box.addItem(title, number)
        self.order_box.setCurrentIndex(order.order - 1)
        for key, title in VOLUMES:
            self.volume_box.addItem(title, key)
        self.volume_box.setCurrentIndex(self.volume_box.findData(order.volume))
        self.thickness.setDecimals(4)
        self.thickness.setRange(1e-4, 1e9)
        self.thickness.setValue(order.thickness)
        self.thickness.setPrefix("thickness ")
        self.layer_count.setRange(1, 100_000)
        self.layer_count.setValue(order.layers)
        self.layer_count.setSuffix(" layers")
        mode = DIVIDE if plan.divide else SIZE if plan.size else GEOMETRY
        for key, title in MODES:
            button = segment(title)
            button.setChecked(key == mode)
            self._group.addButton(button)
            self.modes[key] = button
        self.cell_size.setDecimals(6)
        self.cell_size.setRange(1e-6, 1e9)
        self.cell_size.setSingleStep(0.1 * self._usual)
        self.cell_size.setValue(plan.size or self._usual)
        self.cell_size.setAccessibleName("Length of a cell")
        self.divide.setRange(1, 100_000)
        self.divide.setValue(plan.divide or USUAL_DIVIDE)
        self.divide.setAccessibleName("Cells along every block edge")
        walls = {wall.name: wall for wall in plan.walls}
        for name, row in self.sides.items():
            row.count.setValue(plan.side_counts.get(name, 0))
            row.height.setSingleStep(0.02 * self._usual)
            if name in walls:
                row.height.setValue(walls[name].height)
                row.ratio.setValue(walls[name].ratio)
        for box in (self.format_box, self.order_box, self.volume_box):
            box.currentIndexChanged.connect(self._on_changed)
        for spin in (self.thickness, self.layer_count, self.cell_size, self.divide):
            spin.valueChanged.connect(self._on_changed)
        self._group.buttonClicked.connect(self._on_changed)

    def _arrange(self) -> None:
        form = QGridLayout()
        form.setHorizontalSpacing(2 * GRID)
        form.setVerticalSpacing(GRID)
        form.setColumnStretch(1, 1)
        kind = QHBoxLayout()
        kind.setSpacing(GRID)
        kind.addWidget(self.format_box, 3)
        kind.addWidget(self.order_box, 2)
        volume = QHBoxLayout()
        volume.setSpacing(GRID)
        volume.addWidget(self.volume_box, 2)
        volume.addWidget(self.thickness, 2)
        volume.addWidget(self.layer_count, 1)
        self._volume = QWidget()
        volume.setContentsMargins(0, 0, 0, 0)
        self._volume.setLayout(volume)
        modes = QHBoxLayout()
        modes.setSpacing(0)
        for button in self.modes.values():
            modes.addWidget(button)
        self._amount = QStackedWidget()
        for field in (named("from size, curves and gaps", "Hint"), self.cell_size, self.divide):
            self._amount.addWidget(field)
        modes.addSpacing(2 * GRID)
        modes.addWidget(self._amount, 1)
        self._volume_label = named("Volume", "Label")
        form.addWidget(named("Format", "Label"), 0, 0)
        form.addLayout(kind, 0, 1)
        form.addWidget(self._volume_label, 1, 0)
        form.addWidget(self._volume, 1, 1)
        form.addWidget(named("Cells", "Label"), 2, 0)
        form.addLayout(modes, 2, 1)
        fields = self._framed()
        fields.addLayout(form)
        fields.addWidget(named("SIDES", "Heading"))
        fields.addWidget(self._side_table(), 1)
        self.resize(640, min(300 + 44 * len(self.sides), 620))

    def _side_table(self) -> QWidget:
        body = QWidget()
        grid = QGridLayout(body)
        grid.setContentsMargins(0, 0, GRID, 0)
        grid.setHorizontalSpacing(GRID)
        grid.setVerticalSpacing(GRID // 2)
        for column, title in enumerate(
            ("Name", "Cells in all", "First cell at the wall", "Growth")
        ):
            grid.addWidget(named(title, "Hint"), 0, column)
        for number, row in enumerate(self.sides.values(), 1):
            grid.addWidget(named(row.name, "Value"), number, 0)
            for column, field in enumerate((row.count, row.height, row.ratio), 1):
                grid.addWidget(field, number, column)
        grid.setColumnStretch(0, 1)
        grid.setRowStretch(len(self.sides) + 1, 1)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(body)
        area.viewport().setAutoFillBackground(False)
        body.setAutoFillBackground(False)
        return area

    @property
    def mode(self) -> str:
        """What decides the size of cells, a key of :data:`MODES`."""
        return next(key for key, button in self.modes.items() if button.isChecked())

    def _on_changed(self) -> None:
        """Read the fields, and say what comes of them."""
        if not self._filled:
            return
        ending = str(self.format_box.currentData())
        highest = HIGHEST_ORDER.get(ending, 1)
        self.order_box.setEnabled(highest > 1)
        model = self.order_box.model()
        for place in range(3):
            model.item(place).setEnabled(place < highest)  # type: ignore[attr-defined]
        order = min(int(self.order_box.currentData()), highest)
        if order != self.order_box.currentData():
            self.order_box.setCurrentIndex(order - 1)  # comes back here
            return
        volume = str(self.volume_box.currentData())
        for part in (self._volume, self._volume_label):
            part.setVisible(ending == BLOCK_MESH_DICT)
        for part in (self.thickness, self.layer_count):
            part.setVisible(volume == LAYERS)
        self.order = BlockExport(
            ending, order, volume, self.thickness.value(), self.layer_count.value()
        )
        mode = self.mode
        self._amount.setCurrentIndex([key for key, _ in MODES].index(mode))
        rows = self.sides.values()
        kept = tuple(wall for wall in self.plan.walls if wall.name not in self.sides)
        self.plan = replace(
            self.plan,
            size=round(self.cell_size.value(), 6) if mode == SIZE else None,
            divide=self.divide.value() if mode == DIVIDE else None,
            walls=kept + tuple(
                Wall(row.name, row.height.value(), row.ratio.value())
                for row in rows if row.height.value() > 0.0
            ),
            side_counts={row.name: row.count.value() for row in rows if row.count.value()},
        )  # fmt: skip
        for row in rows:
            row.ratio.setEnabled(row.height.value() > 0.0)
        self._tell()

    def _tell(self) -> None:
        """Say how many cells it makes, or why it cannot be."""
        try:
            counts = division(self._structure, Sizing.planned(self._structure, self.plan)).counts
        except MeshError as error:
            self.note.setText(sentence(str(error)))
            self._warn(True)
            return
        cells = int(counts[self._structure.crossing].prod(axis=1).sum())
        quads = len(self._structure.corners)
        self.note.setText(f"{plural(quads, 'quad')}, each a block; {cells:,} cells.")
        self._warn(False)

    def _warn(self, warns: bool) -> None:
        self.export.setEnabled(not warns)
        self.note.setObjectName("NoticeText" if warns else "Hint")
        self.note.style().polish(self.note)


def _titled(plan: GridPlan, structure: BlockStructure) -> GridPlan:
    """The plan with the drawn names of sides in place of their plain ones."""
    title = {patch.name: patch.title for patch in structure.patches}
    return replace(
        plan,
        walls=tuple(wall._replace(name=title.get(wall.name, wall.name)) for wall in plan.walls),
        side_counts={title.get(name, name): count for name, count in plan.side_counts.items()},
    )
