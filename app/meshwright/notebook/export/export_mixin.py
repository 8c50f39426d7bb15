"""What a widget gives away: a frozen page, pictures, films, and the still that a notebook keeps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from meshwright.document.document import Document
from meshwright.graphics.export import mimebundle
from meshwright.notebook.export import html_page, images
from meshwright.notebook.export.images import SECONDS, SIZE, File


class Exports:
    """The half of :class:`meshwright.notebook.widget.MeshWidget` that writes.

    Where a path is given the file is written whole or not at all. All raise MeshError, in one
    sentence, where there is no mesh or the file cannot be written.
    """

    document: Document
    theme: Any
    reachable: Any
    _do: Callable[[Callable[[], Any]], Any]

    def to_html(self, path: File = None, *, title: str = "") -> str:
        """One HTML file that goes through the film of the history, without Python or a network."""
        return self._do(lambda: html_page.page(self.document, str(title), path))

    def to_png(self, path: File = None, size: tuple[int, int] = SIZE) -> bytes:
        """A picture of the mesh as it is now, ``size`` in pixels."""
        return self._do(lambda: images.png(self.document, size, path, self._colours))

    def to_svg(self, path: File = None, size: tuple[int, int] = SIZE) -> str:
        """The same picture as vectors."""
        return self._do(lambda: images.svg(self.document, size, path, self._colours))

    def to_gif(
        self, path: File = None, seconds: float = SECONDS, size: tuple[int, int] = SIZE
    ) -> bytes:
        """The film of the history; each frame stays for so many seconds."""
        return self._do(lambda: images.gif(self.document, seconds, size, path, self._colours))

    def to_mp4(
        self, path: File = None, seconds: float = SECONDS, size: tuple[int, int] = SIZE
    ) -> bytes:
        """The film of the history as MP4."""
        return self._do(lambda: images.mp4(self.document, path, seconds, size, self._colours))

    @property
    def _colours(self) -> str:
        """A picture does not know where it will be looked at: light unless the widget is dark."""
        return "dark" if self.theme == "dark" else "light"

    def _repr_mimebundle_(self, **options: Any) -> tuple[dict[str, Any], dict[str, Any]] | None:
        """The widget, and a still picture for whoever shows the saved notebook without Python."""
        bundle = super()._repr_mimebundle_(**options)  # type: ignore[misc]
        if bundle is None or self.document.mesh is None or not self.reachable:
            return bundle
        data, metadata = bundle
        still, told = self._do(lambda: mimebundle.still(self.document.mesh))
        return data | still, metadata | told
