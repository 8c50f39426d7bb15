"""Set-up of the QApplication, and opening of the window."""

import sys
from pathlib import Path

from qtpy.QtGui import QFont, QFontDatabase, QSurfaceFormat
from qtpy.QtWidgets import QApplication

from meshwright.desktop.main_window.window import MainWindow
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import tabular
from meshwright.document.document import Document
from meshwright.graphics.theme import FONTS
from meshwright.puzzles.level import Level

DEMO_SHAPE = "star"


def application() -> QApplication:
    """The QApplication, constructed if there is none yet."""
    app = QApplication.instance()
    if not isinstance(app, QApplication):
        QSurfaceFormat.setDefaultFormat(surface_format())
        app = QApplication(sys.argv[:1])
    app.setApplicationName("Meshwright")
    app.setDesktopFileName("meshwright")
    app.setWindowIcon(icons.app_icon())
    app.setStyle("Fusion")
    app.setFont(font())
    return app


def surface_format() -> QSurfaceFormat:
    """The OpenGL format of the plotter; some systems need it set before the first window."""
    made = QSurfaceFormat()
    made.setRenderableType(QSurfaceFormat.RenderableType.OpenGL)
    made.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    made.setVersion(3, 2)
    made.setSwapBehavior(QSurfaceFormat.SwapBehavior.DoubleBuffer)
    for set_size in (made.setRedBufferSize, made.setGreenBufferSize, made.setBlueBufferSize):
        set_size(8)
    made.setAlphaBufferSize(8)
    made.setDepthBufferSize(8)
    made.setStencilBufferSize(0)
    made.setSamples(0)
    return made


def font() -> QFont:
    """The interface's font: the first of the theme's families that is installed."""
    installed = {name.partition(" [")[0] for name in QFontDatabase.families()}
    family = next((name for name in FONTS if name in installed), "")  # "Name [foundry]" counts too
    made = QFont(family) if family else QFont()
    made.setPixelSize(13)
    return tabular(made)


def open_window(
    source: Document | str | Path | None = None,
    kind: str = "quad",
    demo: bool = False,
    guided: bool = False,
    level: Level | None = None,
) -> MainWindow:
    """Construct and show the window on ``source``, as in :func:`meshwright.desktop.run`.

    ``guided`` is for a window that a user has started: see :meth:`MainWindow.start_session`.
    """
    if source is None and demo:
        source = DEMO_SHAPE
    document = source if isinstance(source, Document) else Document()
    window = MainWindow(document)
    if source is not None and not isinstance(source, Document):
        load(document, source, kind)
    if level is not None:
        window.play_level(level)
    if demo:
        window.prepare_agent()
    if guided:
        window.start_session()
    window.show()
    window.activateWindow()
    return window


def load(document: Document, source: str | Path, kind: str) -> None:
    """Put a gallery shape or a mesh file into ``document``."""
    from meshwright.sources.resolve import resolve
    from meshwright_core.domains import meshing

    found = resolve(source)
    if isinstance(found, Document):
        document.adopt(found.state())
    else:
        document.replace(meshing.mesh_domain(found, kind), found.name)
