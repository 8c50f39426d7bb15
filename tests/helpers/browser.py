"""Notebooks in a real browser for tests: JupyterLab and marimo; console errors are collected."""

import json
from pathlib import Path
from typing import Any

from meshwright.benchmarks.notebook.jupyterlab import LabNotebook
from meshwright.benchmarks.notebook.servers import Server
from meshwright.benchmarks.notebook.widget_driver import MOMENT, Card

MARIMO = """import marimo

app = marimo.App()


@app.cell
def _():
    import json
    import marimo as mo
    from meshwright.notebook import MeshWidget

    return MeshWidget, json, mo


@app.cell
def _(MeshWidget, mo):
    widget = mo.ui.anywidget(MeshWidget({source!r}))
    widget
    return (widget,)


@app.cell
def _(mo, widget):
    mo.Html(f'<p class="follows">s is {{widget.widget.score}}</p>')
    return


@app.cell
def _(mo):
    look = mo.ui.button(label="look")
    look
    return (look,)


@app.cell
def _(json, look, mo, widget):
    look.value
    _mesh = widget.widget.mesh
    _seen = {{
        "looks": [0],
        "score": widget.widget.score,
        "cursor": widget.widget.history.cursor,
        "elements": _mesh.elements().tolist(),
        "allowed": [
            int(h)
            for h in (_mesh.element_ids()[:, None] * _mesh.k + range(_mesh.k)).flat
            if widget.widget.check("{operation}", int(h))
        ],
    }}
    mo.Html(f'<pre class="kernel">{{json.dumps(_seen)}}</pre>')
    return


if __name__ == "__main__":
    app.run()
"""


class WatchedPage:
    """A page whose console errors and uncaught exceptions are collected.

    Attributes:
        complaints: their messages.
    """

    def __init__(self, page: Any) -> None:
        self.page = page
        self.complaints: list[str] = []
        page.on("console", self._on_console)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))

    def _on_console(self, message: Any) -> None:
        if message.type == "error":
            self.complaints.append(f"{message.text} ({message.location['url']})")


class Lab(LabNotebook):
    """A notebook in JupyterLab with a watched page."""

    def __init__(self, watched: WatchedPage, server: Server, name: str = "book.ipynb") -> None:
        super().__init__(watched.page, server, name)
        self.watched = watched

    def card(self, *sources: str, number: int = 0) -> Card:
        """Replace all cells by these; returns the card of the widget in their output."""
        self.show(*sources)
        return Card(self.page, number)

    def spot(self, operation: str, widget: str = "widget") -> int:
        """A half-edge where the operation is allowed."""
        found = self.ask(
            f"next(h for e in {widget}.mesh.element_ids().tolist() for h in"
            f" range(e * {widget}.mesh.k, (e + 1) * {widget}.mesh.k)"
            f" if {widget}.check('{operation}', h))"
        )
        return int(found)

    def elements(self, widget: str = "widget") -> list[list[int]]:
        """The mesh in the kernel: its elements by vertex ids."""
        found: list[list[int]] = self.ask(f"{widget}.mesh.elements().tolist()")
        return found

    def theme(self, name: str) -> None:
        """Set JupyterLab's theme, ``Light`` or ``Dark``."""
        self.page.evaluate(
            "theme => jupyterapp.commands.execute('apputils:change-theme', { theme })",
            f"JupyterLab {name}",
        )


class Marimo:
    """A marimo notebook with one widget and a watched page.

    Besides the widget it has a paragraph that follows the widget's score, and a button that lets a
    cell look at the kernel's mesh.
    """

    def __init__(self, watched: WatchedPage, server: Server) -> None:
        self.watched, self.page = watched, watched.page
        self._server = server
        self.open()

    @staticmethod
    def write(folder: Path, source: str, operation: str = "flip_left") -> Path:
        """Write the notebook with a widget of ``source``; returns its path."""
        path = folder / "book.py"
        path.write_text(MARIMO.format(source=source, operation=operation))
        return path

    def open(self) -> None:
        """Load or reload the page."""
        self.page.goto(self._server.url, wait_until="domcontentloaded")
        self.page.locator("pre.kernel").wait_for(timeout=3 * MOMENT)
        self.card = Card(self.page)

    def kernel(self) -> dict[str, Any]:
        """State of the widget as seen by a cell that runs now."""
        self.page.get_by_role("button", name="look").click()
        self.page.wait_for_timeout(400)
        seen: dict[str, Any] = json.loads(self.page.locator("pre.kernel").inner_text())
        return seen

    @property
    def follows(self) -> str:
        """The paragraph of the cell that depends on the widget."""
        text: str = self.page.locator("p.follows").inner_text()
        return text
