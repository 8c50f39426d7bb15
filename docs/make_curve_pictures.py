"""Ten pictures of curves, and one contact sheet of them: window, widget and files, light and dark.

    xvfb-run -s "-screen 0 1920x1200x24" python docs/make_curve_pictures.py [FOLDER]

writes them into FOLDER (build/curves if none is named). A display is needed for the window and
Chromium for the widget.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from contact_scenes import fewest, shot
from make_contact_sheet import put_together
from make_notebook_pictures import plain
from PIL import Image
from qtpy.QtWidgets import QApplication
from stage import SMALL, Stage, allowed, shape

from meshwright.benchmarks.notebook.chromium import browser
from meshwright.benchmarks.notebook.jupyterlab import LabNotebook
from meshwright.benchmarks.notebook.servers import jupyterlab
from meshwright.benchmarks.notebook.widget_driver import Card
from meshwright.desktop.main_window.startup import application
from meshwright.graphics.export.export_job import save_mesh_picture
from meshwright_core import HalfEdgeMesh, warm_up
from meshwright_core.domains import gallery

BRACKET = "filleted-bracket"
SHEET, COLOURS = 1700, 160
"""Width in pixels and colours of curves-sheet.png, which docs/architecture.md shows."""
SETTLE = 800
"""Milliseconds until all animations of the page have ended."""


def fillet() -> tuple[float, float]:
    """The middle of the arc between the arms of the bracket: it turns to the right."""
    outline = gallery.shape(BRACKET).boundary[0]
    arc = next(curve for curve in outline if curve.data.get("sweep", 0.0) < 0.0)
    x, y = arc.point(0.5 * arc.length).tolist()
    return x, y


def window(mesh: HalfEdgeMesh, name: str, theme: str) -> Image.Image:
    """The window with a mesh."""
    return shot(Stage(mesh, name, SMALL, theme))


def zoomed(name: str, place: tuple[float, float], times: float, theme: str) -> Image.Image:
    """The window, zoomed in at a place: its curves are made anew, finer."""
    stage = Stage(shape(name), name, SMALL, theme)
    seen = stage.window.canvas.viewport
    stage.window.canvas.see(replace(seen, centre=place, pixels=times * seen.pixels))
    stage.rest(0.6)
    return shot(stage)


def preview(name: str, theme: str) -> Image.Image:
    """The pointer over an edge: the preview of an operation between curved sides."""
    stage = Stage(shape(name), name, SMALL, theme)
    stage.point_at(allowed(stage.window.document.mesh, "split")[0])
    return shot(stage)


def picture_file(name: str, folder: Path) -> Image.Image:
    """What ``--png`` writes."""
    path = folder / f"file-{name}.png"
    save_mesh_picture(shape(name), path)
    with Image.open(path) as image:
        return image.convert("RGB")


def widgets(folder: Path) -> dict[str, Image.Image]:
    """The widget in JupyterLab, light and dark."""
    found = {}
    with browser() as started, jupyterlab() as server:
        for theme, name in (("light", "pipe"), ("dark", "nozzle")):
            context = started.new_context(viewport={"width": 1180, "height": 860})
            page = context.new_page()
            book = LabNotebook(page, server)
            plain(page)
            book.show(f'import meshwright as mw\n\nmw.MeshWidget("{name}", theme="{theme}")')
            Card(page)
            page.wait_for_timeout(SETTLE)
            path = folder / f"widget-{name}.png"
            page.screenshot(path=path, animations="disabled")
            context.close()
            with Image.open(path) as image:
                found[f"widget, {name}, {theme}"] = image.convert("RGB")
    return found


def main(folder: Path) -> None:
    """Make all pictures, then the sheet."""
    folder.mkdir(parents=True, exist_ok=True)
    application()
    warm_up.warm()
    QApplication.setQuitOnLastWindowClosed(False)
    scenes: dict[str, Callable[[], Image.Image]] = {
        "window, bracket, light": lambda: window(
            shape("filleted-bracket"), "filleted-bracket", "light"
        ),
        "window, bracket, dark": lambda: window(
            shape("filleted-bracket"), "filleted-bracket", "dark"
        ),
        "a fillet, 8 times": lambda: zoomed(BRACKET, fillet(), 8.0, "light"),
        "the same, 200 times": lambda: zoomed(BRACKET, fillet(), 200.0, "dark"),
        "preview between arcs": lambda: preview("plate-with-round-hole", "light"),
        "three regions": lambda: window(shape("motor-segment"), "motor-segment", "dark"),
        "--png, airfoil": lambda: picture_file("airfoil-in-box", folder),
        "fewest quads, a pipe": lambda: window(fewest("pipe"), "pipe", "light"),
    }
    sheet = []
    for caption, make in scenes.items():
        image = make()
        image.save(folder / f"{len(sheet)}.png")
        sheet.append((caption, image))
        sys.stderr.write(f"{caption}\n")
    sheet += widgets(folder).items()
    whole = put_together(sheet)
    whole.save(folder / "contact-sheet.png", optimize=True)
    small = whole.resize((SHEET, whole.height * SHEET // whole.width), Image.Resampling.LANCZOS)
    small.quantize(COLOURS).save(folder / "curves-sheet.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "build/curves"))
