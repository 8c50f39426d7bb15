"""The export dialog: format, size, frame rate and content."""

from dataclasses import replace

from qtpy.QtCore import Qt, QTimer
from qtpy.QtGui import QImage, QPixmap
from qtpy.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.exporting.export_frame import ExportFrame
from meshwright.desktop.widgets.basic import named, segment
from meshwright.desktop.widgets.number_box import DecimalBox, IntegerBox
from meshwright.graphics.drawing import raster
from meshwright.graphics.export.export_job import SIZES, ExportOptions
from meshwright.graphics.export.film import FIRST, LAST, Film
from meshwright.graphics.mesh_figure import figure
from meshwright.graphics.theme import GRID, THEMES

FORMATS = (
    (".gif", "Animation, GIF", "Plays anywhere, also inside a README or a slide"),
    (".mp4", "Video, MP4", "Smaller and sharper; for talks and web pages"),
    (".png", "Image, PNG", "The current state as pixels"),
    (".svg", "Image, SVG", "The current state as vector graphics, which stay sharp in print"),
)
PARTS = (
    ("score", "Score and step above the mesh"),
    ("curve", "Score curve below the mesh"),
    ("numbers", "Numbers in the discs"),
    ("changes", "Changes of each step"),
)
PREVIEW = (480, 360)
LARGE = 20_000
"""There is no preview of meshes with more elements than this."""
LATER = 80
"""Milliseconds between a change and the update of the preview."""


class ExportDialog(ExportFrame):
    """Edits :class:`meshwright.graphics.export.export_job.ExportOptions`, with a preview of the
    state where ``film`` stands.
    """

    def __init__(
        self,
        film: Film,
        order: ExportOptions,
        parent: QWidget | None = None,
        pointed_at: int = -1,
    ) -> None:
        """`pointed_at`: the half-edge that a picture may show, -1 for none."""
        super().__init__("Export video or image", parent)
        self._film = film
        self._state = film.state
        self._moment = film.moment(film.state)
        if len(film.rows) == 0 and order.moving:
            order = replace(order, ending=".png")  # there is nothing to animate
        self.order = order
        self._pointed_at = pointed_at
        self.halfedge = QCheckBox("Half-edge pointed at")
        self._group = QButtonGroup(self)
        self.formats: dict[str, QPushButton] = {}
        self.size_box = QComboBox()
        self.theme_box = QComboBox()
        self.seconds = DecimalBox()
        self.every = IntegerBox()
        self.parts: dict[str, QCheckBox] = {}
        self.length = named("", "Hint")
        self.preview = QLabel()
        self._later = QTimer(self, singleShot=True, interval=LATER)
        self._later.timeout.connect(self._draw)
        self._fill()
        self._arrange()
        self._on_changed()
        self._draw()

    def _fill(self) -> None:
        order = self.order
        for ending, title, hint in FORMATS:
            button = segment(title)
            button.setToolTip(hint)
            button.setChecked(ending == order.ending)
            self._group.addButton(button)
            self.formats[ending] = button
        for width, height in SIZES:
            self.size_box.addItem(f"{width} \u00d7 {height}", (width, height))
        self.size_box.setCurrentIndex(SIZES.index(order.size) if order.size in SIZES else 1)
        for name in THEMES:
            self.theme_box.addItem(name.capitalize(), name)
        self.theme_box.setCurrentIndex(list(THEMES).index(order.theme))
        self.seconds.setRange(0.05, 5.0)
        self.seconds.setSingleStep(0.05)
        self.seconds.setSuffix(" s")
        self.seconds.setValue(order.seconds)
        self.every.setRange(1, max(len(self._film.rows), 1))
        self.every.setValue(order.stride(self._film))
        for name, title in PARTS:
            self.parts[name] = QCheckBox(title)
            self.parts[name].setChecked(getattr(order, name))
            self.parts[name].toggled.connect(self._on_changed)
        self.halfedge.setToolTip(
            "In images: point at a half-edge, by mouse or keys, then open this dialog by its keys"
        )
        self.halfedge.toggled.connect(self._on_changed)
        self._group.buttonClicked.connect(self._on_changed)
        for box in (self.size_box, self.theme_box):
            box.currentIndexChanged.connect(self._on_changed)
        for spin in (self.seconds, self.every):
            spin.valueChanged.connect(self._on_changed)

    def _arrange(self) -> None:
        formats = QHBoxLayout()
        formats.setSpacing(0)
        for button in self.formats.values():
            formats.addWidget(button, 1)
        grid = QGridLayout()
        grid.setHorizontalSpacing(2 * GRID)
        grid.setVerticalSpacing(GRID)
        self._pace = [named("Time per frame", "Label"), named("One frame for every", "Label")]
        rows = (
            (named("Size", "Label"), self.size_box),
            (named("Theme", "Label"), self.theme_box),
            (self._pace[0], self.seconds),
            (self._pace[1], self.every),
        )
        for part in (*self._pace, self.seconds, self.every):
            policy = part.sizePolicy()
            policy.setRetainSizeWhenHidden(True)
            part.setSizePolicy(policy)
        for number, (label, field) in enumerate(rows):
            label.setBuddy(field)
            grid.addWidget(label, number, 0)
            grid.addWidget(field, number, 1)
        fields = QVBoxLayout()
        fields.setSpacing(GRID)
        fields.addLayout(grid)
        fields.addSpacing(GRID)
        for box in self.parts.values():
            fields.addWidget(box)
        fields.addWidget(self.halfedge)
        fields.addStretch(1)
        self.length.setWordWrap(True)
        self.length.setMinimumHeight(36)
        self.length.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignBottom)
        fields.addWidget(self.length)
        self.preview.setFixedSize(*PREVIEW)
        self.preview.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.preview.setAccessibleName("Preview")
        middle = QHBoxLayout()
        middle.setSpacing(3 * GRID)
        middle.addWidget(self.preview)
        middle.addLayout(fields, 1)
        framed = self._framed()
        framed.addLayout(formats)
        framed.addLayout(middle, 1)

    def _on_changed(self) -> None:
        """Update the order from the fields."""
        ending = next(e for e, button in self.formats.items() if button.isChecked())
        self.order = replace(
            self.order,
            ending=ending,
            size=tuple(self.size_box.currentData()),
            theme=str(self.theme_box.currentData()),
            seconds=round(self.seconds.value(), 2),
            every=self.every.value(),
            score=self.parts["score"].isChecked(),
            curve=self.parts["curve"].isChecked(),
            numbers=self.parts["numbers"].isChecked(),
            changes=self.parts["changes"].isChecked(),
            halfedge=self._pointed_at if self.halfedge.isChecked() else -1,
        )
        moving = self.order.moving
        self.halfedge.setEnabled(not moving and self._pointed_at >= 0)
        for part in (*self._pace, self.seconds, self.every):
            part.setVisible(moving)
        self.every.setSuffix(" step" if self.every.value() == 1 else " steps")
        self.note.setText(f"{self.formats[ending].toolTip()}.")
        self.length.setText(self._words())
        self.export.setEnabled(not moving or len(self._film.rows) > 0)
        self._later.start()

    def done(self, result: int) -> None:
        """Close; the preview is not drawn any more."""
        self._later.stop()
        super().done(result)

    def _words(self) -> str:
        """Number of frames and duration of the video, or the state of the image."""
        if not self.order.moving:
            return f"The state after step {self._state:,}." if self._state else "The start."
        if len(self._film.rows) == 0:
            return "The history is empty: there is nothing to animate."
        frames = len(self._film.stops(self.order.every))
        inside = max(frames - 2, 0) * self.order.seconds
        ends = max(FIRST, self.order.seconds) + max(LAST, self.order.seconds)
        return f"{frames:,} frames, {inside + ends:.0f} seconds."

    def _draw(self) -> None:
        """Draw the preview: the current state as exported."""
        if self._film.mesh.n_elements > LARGE:
            self.preview.setText("No preview of so many elements.")
            return
        order = self.order
        image = raster(figure(self._film.mesh, order.figure_options, self._moment), samples=2)
        ratio = self.devicePixelRatioF()
        scale = min(PREVIEW[0] / image.width, PREVIEW[1] / image.height) * ratio
        image = image.resize((round(image.width * scale), round(image.height * scale)))
        data = image.tobytes()
        pixels = QImage(
            data, image.width, image.height, 3 * image.width, QImage.Format.Format_RGB888
        )
        shown = QPixmap.fromImage(pixels.copy())
        shown.setDevicePixelRatio(ratio)
        self.preview.setPixmap(shown)
