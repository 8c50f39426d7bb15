"""Meshwright in Python and in notebooks: the names that are used most, from one import.

    import meshwright as mw

    mesh = mw.mesh("star")
    solved = mw.solve(mesh, seconds=3)
    mw.write("star.vtk", solved.mesh)
    mw.MeshWidget(solved.mesh)

Each name is imported when it is first used: importing this package imports nothing else.
"""

from __future__ import annotations

import importlib
from typing import Any

_HOMES = {
    "Document": "meshwright.document.document",
    "Domain": "meshwright_core.domains.domain",
    "HalfEdgeMesh": "meshwright_core",
    "MeshError": "meshwright_core",
    "MeshWidget": "meshwright.notebook",
    "Operation": "meshwright_core",
    "OperationRefused": "meshwright_core",
    "WallLayer": "meshwright_core.blocks.sizing",
    "block_count": "meshwright_core.analysis.blocks",
    "block_of": "meshwright_core.analysis.blocks",
    "block_view": "meshwright.experiments",
    "blocks": "meshwright.graphics.block_grids",
    "compare": "meshwright.experiments",
    "exercise": "meshwright.teaching",
    "improve": "meshwright.assistant.solve",
    "learning_curves": "meshwright.experiments",
    "mesh": "meshwright.sources.resolve",
    "patch": "meshwright.teaching",
    "policy_view": "meshwright.experiments",
    "random_polygon": "meshwright_core.domains.gallery",
    "read": "meshwright_core",
    "shape": "meshwright_core.domains.gallery",
    "side_by_side": "meshwright.experiments",
    "small_multiples": "meshwright.experiments",
    "solve": "meshwright.assistant.solve",
    "table_row": "meshwright.experiments",
    "write": "meshwright_core",
}
"""The module that defines each name."""

_OTHER_NAMES = {
    "block_grids": ("meshwright_core.analysis.block_grids", "grids"),
    "levels": ("meshwright.puzzles.level", "all"),
    "shapes": ("meshwright_core.domains.gallery", "names"),
}
"""Names that are different in their module: module and name there."""

__all__ = sorted([*_HOMES, *_OTHER_NAMES])


def __getattr__(name: str) -> Any:
    home, real = (_HOMES[name], name) if name in _HOMES else _OTHER_NAMES.get(name, ("", ""))
    if not home:
        raise AttributeError(f"module 'meshwright' has no attribute {name!r}")
    value = globals()[name] = getattr(importlib.import_module(home), real)
    return value


def __dir__() -> list[str]:
    return list(__all__)
