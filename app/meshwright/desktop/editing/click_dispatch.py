"""Passes clicks on the canvas, and Escape, to the first feature that uses them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.mouse import Click
from meshwright.desktop.controller import Controller
from meshwright.graphics.theme import Theme


class ClickDispatch(Controller):
    """Calls handlers in order until one returns True.

    ``clicks`` are the handlers of a click; ``escapes`` those of Escape, each of which ends one
    thing. If no handler uses it, Escape unpins the half-edge that was chosen by keyboard.
    """

    def __init__(
        self,
        canvas: Canvas,
        clicks: Sequence[Callable[[Click], bool]],
        escapes: Sequence[Callable[[], bool]],
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._canvas, self._clicks, self._escapes = canvas, tuple(clicks), tuple(escapes)
        canvas.clicked.connect(self._on_clicked)
        canvas.escaped.connect(self._on_escaped)

    def _on_clicked(self, click: Click) -> None:
        any(handle(click) for handle in self._clicks)

    def _on_escaped(self) -> None:
        if not any(handle() for handle in self._escapes):
            self._canvas.pin(-1)
