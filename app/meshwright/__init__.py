"""Meshwright in Python and in notebooks: one import for what people use most.

    import meshwright as mw
    mw.MeshWidget("star")

Each name is fetched when it is first used, so that importing this package imports nothing else.
"""

from __future__ import annotations

import importlib
from typing import Any

_HOMES = {
    "Document": "app.document",
    "Domain": "meshcore.domain",
    "HalfEdgeMesh": "meshcore",
    "MeshError": "meshcore",
    "MeshWidget": "app.notebook",
    "Operation": "meshcore",
    "OperationRefused": "meshcore",
    "block_count": "meshcore.blocks",
    "block_of": "meshcore.blocks",
    "block_view": "app.experiments",
    "compare": "app.experiments",
    "exercise": "app.teaching",
    "learning_curves": "app.experiments",
    "mesh": "app.sources",
    "patch": "app.teaching",
    "policy_view": "app.experiments",
    "random_polygon": "meshcore.shapes",
    "read": "meshcore",
    "shape": "meshcore.shapes",
    "side_by_side": "app.experiments",
    "small_multiples": "app.experiments",
    "table_row": "app.experiments",
    "write": "meshcore",
}
"""The module that each name comes from."""

_OTHER_NAMES = {
    "block_grids": ("meshcore.block_grids", "grids"),
    "levels": ("app.levels", "all"),
    "shapes": ("meshcore.shapes", "names"),
}
"""Names that are called otherwise at home."""

__all__ = sorted([*_HOMES, *_OTHER_NAMES])


def __getattr__(name: str) -> Any:
    home, real = (_HOMES[name], name) if name in _HOMES else _OTHER_NAMES.get(name, ("", ""))
    if not home:
        raise AttributeError(f"module 'meshwright' has no attribute {name!r}")
    value = globals()[name] = getattr(importlib.import_module(home), real)
    return value


def __dir__() -> list[str]:
    return list(__all__)
