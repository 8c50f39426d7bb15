"""Drives the widget in a page by real mouse and key events, and reads its pixels."""

from __future__ import annotations

import io
import re
import time
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

MOMENT = 60_000
"""Timeout, in milliseconds, of anything that should happen at once."""


class Card:
    """One view of a MeshWidget in a page.

    Attributes:
        page: Playwright's page.
        root: the card's outermost element.
    """

    def __init__(self, page: Page, number: int = 0) -> None:
        """The card with this number from the top; waits until its mesh is painted."""
        self.page = page
        self.root: Locator = page.locator(".meshwright").nth(number)
        self.root.wait_for(timeout=MOMENT)
        self.until("root => root.dataset.painted !== undefined")

    # State of the widget

    def look(self, function: str, given: Any = None) -> Any:
        """Value of a JavaScript function of the card's element and of ``given``."""
        return self.root.evaluate(function, given)

    def until(self, function: str, given: Any = None) -> None:
        """Wait until such a function is true; AssertionError if it does not become so."""
        last = time.monotonic() + MOMENT / 1000
        while not self.look(function, given):
            assert time.monotonic() < last, f"this did not come: {function} {given or ''}"
            self.page.wait_for_timeout(15)

    @property
    def revision(self) -> int:
        """Revision of the mesh that is painted."""
        return int(self.look("root => root.dataset.revision"))

    @property
    def head(self) -> dict[str, Any]:
        """The head that Python sent last: score, cursor and so on."""
        found: dict[str, Any] = self.look("root => root.meshwright.replica.head")
        return found

    def await_head(self, **wanted: Any) -> None:
        """Wait until the head has these values and the mesh of that revision is painted."""
        self.until(
            "(root, wanted) => { const { replica } = root.meshwright; return"
            " Object.entries(wanted).every(([name, value]) => replica.head[name] === value)"
            " && Number(root.dataset.revision) === replica.revision; }",
            wanted,
        )

    def await_other(self, revision: int) -> None:
        """Wait until a mesh of another revision is painted."""
        self.until("(root, old) => Number(root.dataset.revision) !== old", revision)

    # Where things are, and what is done there

    def place(self, halfedge: int) -> tuple[float, float]:
        """Position of a half-edge in CSS pixels of the viewport."""
        self.root.scroll_into_view_if_needed()
        at = self.look("(root, h) => root.meshwright.screenOf(h)", halfedge)
        return at["x"], at["y"]

    def hover(self, halfedge: int) -> None:
        """Move the mouse to a half-edge in several steps."""
        self.page.mouse.move(*self.place(halfedge), steps=2)
        self.until("(root, h) => Number(root.dataset.halfedge) === h", halfedge)

    def click(self, halfedge: int) -> None:
        """Move the mouse there and click."""
        self.hover(halfedge)
        self.page.mouse.click(*self.place(halfedge))

    def aside(self) -> None:
        """Move the mouse off the card, so that pictures show the mesh alone."""
        self.page.mouse.move(2, 2)
        self.until("root => Number(root.dataset.halfedge) === -1")

    def press(self, *keys: str) -> None:
        """Press keys one after the other, wherever the focus is."""
        for key in keys:
            self.page.keyboard.press(key)

    def button(self, name: str) -> Locator:
        """A button of the card by its text, or by the start of its accessible name."""
        return self.root.get_by_role("button", name=re.compile(rf"^{name}\b")).first

    def agent(self, name: str) -> Locator:
        """A button of the agent's by the words on it."""
        panel = self.root.locator(".mw-part-agent")
        return panel.locator("button", has_text=re.compile(rf"^{name}$"))

    def row(self, operation: str) -> Locator:
        """The operation's row in the panel."""
        return self.root.locator(".mw-part-operations button", has_text=self.title(operation))

    def choice(self, operation: str) -> Locator:
        """The operation's row in the menu at the pointer."""
        return self.root.locator(".mw-popup .mw-row", has_text=self.title(operation))

    def title(self, operation: str) -> str:
        """The title of the operation."""
        found: str = self.look(
            "(root, name) => root.meshwright.replica.catalogue"
            ".find(row => row.operation === name).title",
            operation,
        )
        return found

    def arm(self, operation: str) -> None:
        """Choose the operation that clicks on the mesh do, by a click on its row."""
        row = self.row(operation)
        if row.get_attribute("aria-pressed") != "true":
            row.click()

    def send(self, content: Any, buffers: list[int] | None = None) -> None:
        """Send a message to Python directly, with zeroed buffers of these lengths."""
        self.look(
            "(root, [content, sizes]) => root.meshwright.link._model.send(content, undefined,"
            " sizes.map(size => new ArrayBuffer(size)))",
            [content, buffers or []],
        )

    # What is to be seen

    def picture(self) -> np.ndarray:
        """Screenshot of the mesh's area, (height, width, 3) uint8."""
        return pixels(self.root.locator(".mw-stage").screenshot(animations="disabled"))

    def layer(self, name: str) -> np.ndarray:
        """The pixels of one canvas, (height, width, 4) uint8.

        The ``lower`` shows the mesh, the ``upper`` what is pointed at.
        """
        url = self.root.locator(f"canvas.mw-{name}").evaluate(
            "canvas => canvas.toDataURL('image/png')"
        )
        return pixels(_decoded(url), "RGBA")


def pixels(png: bytes, mode: str = "RGB") -> np.ndarray:
    """A PNG's pixels, (height, width, channels) uint8."""
    from PIL import Image

    return np.asarray(Image.open(io.BytesIO(png)).convert(mode))


def differing(first: np.ndarray, second: np.ndarray, least: int = 24) -> int:
    """Number of pixels that differ by at least so much in some channel; all, if the sizes do."""
    if first.shape != second.shape:
        return max(first.size, second.size)
    apart = np.abs(first.astype(int) - second.astype(int)).max(axis=2)
    return int((apart >= least).sum())


def _decoded(url: str) -> bytes:
    import base64

    return base64.b64decode(url.split(",", 1)[1])
