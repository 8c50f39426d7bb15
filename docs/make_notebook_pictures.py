"""Makes README's pictures of the notebook, in JupyterLab and a real browser, into docs/images/.

    python docs/make_notebook_pictures.py            all of them
    python docs/make_notebook_pictures.py levels     only this one: notebook, levels

Chromium must be installed; no display is needed.
"""

import sys
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, Page

from meshwright.benchmarks.notebook.chromium import browser
from meshwright.benchmarks.notebook.jupyterlab import LabNotebook
from meshwright.benchmarks.notebook.servers import Server, jupyterlab
from meshwright.benchmarks.notebook.widget_driver import Card

IMAGES = Path(__file__).parent / "images"
SIZE = (1180, 860)
COLOURS = 192
SETTLE = 800
"""Milliseconds until all animations have ended."""


def notebook(page: Page, server: Server) -> None:
    """A run on the star at an earlier state of its history, with the preview of an operation."""
    book = LabNotebook(page, server)
    plain(page)
    book.show(
        "import meshwright as mw\n\n"
        'widget = mw.MeshWidget("star")\n'
        "widget.complete()\n"
        "widget.go_to(2)\n"
        "widget"
    )
    card = Card(page)
    mesh = card.look("root => root.meshwright.replica.halfedges")
    card.hover(_inside(card, mesh))
    card.root.locator(".mw-notice").wait_for(state="hidden", timeout=120_000)
    card.until("root => root.meshwright.hoverState.ghost")
    page.wait_for_timeout(SETTLE)


def levels(page: Page, server: Server) -> None:
    """A solved level, beside the solution of the agent."""
    book = LabNotebook(page, server)
    plain(page)
    book.show('import meshwright as mw\n\nwidget = mw.MeshWidget(level="two-turns")\nwidget')
    card = Card(page)
    card.button("Ask the agent").click()
    card.button("Show a solution").wait_for(timeout=120_000)
    book.ask(
        "[widget.apply(name, widget.mesh.halfedge(a, b)).score_change"
        " for name, (a, b) in widget.level.solution]"
    )
    card.await_head(at_optimum=True)
    page.wait_for_timeout(SETTLE)


PICTURES: dict[str, Callable[[Page, Server], None]] = {"notebook": notebook, "levels": levels}


def plain(page: Page) -> None:
    """Hide the list of files."""
    page.evaluate("() => jupyterapp.commands.execute('application:toggle-left-area')")
    page.wait_for_timeout(SETTLE)


def _inside(card: Card, halfedges: int) -> int:
    """The half-edge nearest to the middle of the stage."""
    found: int = card.look(
        """(root, count) => {
            const stage = root.querySelector('.mw-stage').getBoundingClientRect();
            const x = stage.x + stage.width / 2, y = stage.y + stage.height / 2;
            let nearest = -1, least = Infinity;
            for (let h = 0; h < count; h++) {
                const at = root.meshwright.screenOf(h);
                if (!at) continue;
                const far = Math.hypot(at.x - x, at.y - y);
                if (far < least) { least = far; nearest = h; }
            }
            return nearest;
        }""",
        halfedges,
    )
    return found


def _make(name: str, started: Browser, server: Server) -> None:
    context = started.new_context(viewport={"width": SIZE[0], "height": SIZE[1]})
    page = context.new_page()
    PICTURES[name](page, server)
    path = IMAGES / f"{name}.png"
    page.screenshot(path=path, animations="disabled")
    context.close()
    with Image.open(path) as image:
        image.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
    sys.stdout.write(f"{path}\n")


def main(names: list[str]) -> int:
    """Make the pictures named on the command line, or all."""
    unknown = sorted(set(names) - set(PICTURES))
    if unknown:
        sys.stderr.write(f"There is no picture {unknown[0]!r}; there are {', '.join(PICTURES)}.\n")
        return 2
    with browser() as started:
        for name in names or PICTURES:
            with jupyterlab() as server:  # a server of its own: JupyterLab opens what was open
                _make(name, started, server)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
