"""The accessor ``dataset.meshwright`` of PyVista's datasets, and its reader of projects.

PyVista finds both by the entry points of this package.

    grid = pyvista.read("plate.vtu")
    solved = grid.meshwright.solve(seconds=3)  # a pyvista.PolyData
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

from meshwright.document.storage import document_file
from meshwright.sources import resolve
from meshwright_core import HalfEdgeMesh


class MeshwrightAccessor:
    """``dataset.meshwright``: a dataset of triangles or quads as a half-edge mesh."""

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def mesh(self) -> HalfEdgeMesh:
        """The half-edge mesh; MeshError if the cells are not those of one."""
        return resolve.mesh(self._dataset)

    def widget(self, **options: Any) -> Any:
        """A notebook widget on the mesh; options as of :class:`meshwright.MeshWidget`."""
        return importlib.import_module("meshwright.notebook").MeshWidget(self.mesh(), **options)

    def solve(self, **options: Any) -> Any:
        """The dataset with better connectivity, as pyvista.PolyData.

        options: as of ``meshwright.solve``.
        """
        solve = importlib.import_module("meshwright.assistant.solve").solve
        return solve(self.mesh(), **options).mesh.to_pyvista()


def read_project(path: str, **_: Any) -> Any:
    """A project file as pyvista.PolyData."""
    return document_file.read_meshed(Path(path), "quad").mesh.to_pyvista()


def register() -> None:
    """Register the accessor; PyVista before 0.48 has none."""
    pyvista = importlib.import_module("pyvista")
    if hasattr(pyvista, "register_dataset_accessor"):
        pyvista.register_dataset_accessor("meshwright", pyvista.DataSet)(MeshwrightAccessor)


register()
