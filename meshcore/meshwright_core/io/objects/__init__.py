"""Meshes from and to objects of PyVista, trimesh, meshio and shapely, which are optional."""

from __future__ import annotations

from typing import Any

from meshwright_core.core.conversions import register


def _converted(library: str, mesh: Any) -> Any:
    # imported late: measuring elements takes modules that reading files does not
    from meshwright_core.io.objects import outgoing

    return getattr(outgoing, f"to_{library}")(mesh)


for _library in ("pyvista", "trimesh", "meshio", "shapely"):
    register(_library, _converted)
