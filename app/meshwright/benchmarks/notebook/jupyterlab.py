"""A notebook open in JupyterLab, in a page of a browser."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from meshwright.benchmarks.notebook.servers import Server

if TYPE_CHECKING:
    from playwright.sync_api import Page

BOOK = {
    "cells": [],
    "metadata": {
        "kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}
    },
    "nbformat": 4,
    "nbformat_minor": 5,
}
PANEL = """const panel = [...jupyterapp.shell.widgets('main')].find(
    widget => widget.sessionContext && widget.content && widget.content.model);"""
READY = f"""() => {{
    if (!window.jupyterapp || !jupyterapp.shell) return false;
    {PANEL}
    const kernel = panel && panel.context.isReady && panel.sessionContext.session
        && panel.sessionContext.session.kernel;
    return Boolean(kernel && kernel.connectionStatus === 'connected' && kernel.status === 'idle');
}}"""
FILL = f"""([sources, kind]) => {{
    {PANEL}
    const shared = panel.content.model.sharedModel;
    const old = shared.cells.length;
    shared.insertCells(0, sources.map(source => ({{cell_type: 'code', source}})));
    if (old) shared.deleteCellRange(sources.length, sources.length + old);
    jupyterapp.shell.activateById(panel.id);
}}"""
RUN = f"""async number => {{
    {PANEL}
    panel.content.activeCellIndex = number;
    panel.content.deselectAll();
    await jupyterapp.commands.execute('notebook:run-cell');
    const cell = panel.content.model.cells.get(number);
    return [...cell.sharedModel.outputs].filter(output => output.output_type === 'error')
        .map(output => output.ename + ': ' + output.evalue);
}}"""
ASK = f"""async code => {{
    {PANEL}
    const kernel = panel.sessionContext.session.kernel;
    const printed = [];
    const future = kernel.requestExecute({{code, store_history: false}});
    future.onIOPub = message => {{
        if (message.header.msg_type === 'stream') printed.push(message.content.text);
    }};
    const reply = await future.done;
    const failed = reply.content.status !== 'ok';
    return {{failed, text: failed ? reply.content.evalue : printed.join('')}};
}}"""


class LabNotebook:
    """One notebook with a kernel, in one page.

    Attributes:
        page: Playwright's page.
        name: file name of the notebook in the server's folder.
        folder: that folder.
    """

    def __init__(self, page: Page, server: Server, name: str = "book.ipynb") -> None:
        """Make the notebook, empty, and open it; returns when its kernel is idle."""
        self.page = page
        self.name = name
        self.folder = server.folder
        self._server = server
        path = server.folder / name
        if not path.exists():
            path.write_text(json.dumps(BOOK))
        self.open()

    def open(self) -> None:
        """Load or reload the page; the kernel keeps running."""
        address = f"{self._server.url}/lab/tree/{self.name}?token={self._server.token}"
        self.page.goto(address, wait_until="domcontentloaded")
        self.wait()

    def wait(self) -> None:
        """Wait until the kernel is connected and idle."""
        self.page.wait_for_function(READY, timeout=60_000)

    def fill(self, *sources: str) -> None:
        """Replace the cells of the notebook."""
        self.page.evaluate(FILL, [list(sources), "code"])

    def run(self, number: int = 0) -> None:
        """Run one cell by its keyboard shortcut; RuntimeError if it raised."""
        errors = self.page.evaluate(RUN, number)
        if errors:
            raise RuntimeError(errors[0])

    def show(self, *sources: str) -> None:
        """Replace the cells and run them in order."""
        self.fill(*sources)
        for number in range(len(sources)):
            self.run(number)

    def ask(self, expression: str, before: str = "") -> Any:
        """Value of an expression in the kernel, as JSON carries it; RuntimeError if it raises.

        ``before`` is a line of code that is run first.
        """
        code = f"{before}\nimport json\nprint(json.dumps({expression}))"
        answer = self.page.evaluate(ASK, code)
        if answer["failed"]:
            raise RuntimeError(answer["text"])
        return json.loads(answer["text"])

    def save(self) -> None:
        """Save the notebook with its outputs and its widgets' state."""
        self.page.evaluate("async () => { await jupyterapp.commands.execute('docmanager:save'); }")
