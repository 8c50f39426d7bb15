"""The desktop window: a view on a document. Needs Qt and a display."""

from pathlib import Path

from meshwright.document.document import Document
from meshwright.puzzles.level import Level


def run(
    source: Document | str | Path | None = None,
    kind: str = "quad",
    demo: bool = False,
    level: Level | None = None,
) -> int:
    """Open the window and return its exit code when it is closed.

    ``source`` is a document, the name of a gallery shape, or a mesh file; shapes are meshed with
    elements of ``kind`` ("tri" or "quad"). ``demo`` loads the policy at once, and uses the star
    where there is no source. ``level`` is played instead of a source. Raises MeshError or OSError
    if the source cannot be read, and KeyboardInterrupt after the window was closed by Ctrl-C in the
    terminal.
    """
    from meshwright.desktop.application.sigint import on_interrupt
    from meshwright.desktop.main_window.startup import application, open_window

    app = application()
    window = open_window(source, kind, demo, guided=True, level=level)
    with on_interrupt(window.leave):
        code = int(app.exec())
    window.stop_preparing()
    return code
