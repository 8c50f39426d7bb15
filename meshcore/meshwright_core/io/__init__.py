"""Mesh files, snapshots and drawings."""

from meshwright_core.io import objects as objects  # registers its conversions
from meshwright_core.io.mesh_files import endings, read, write

__all__ = ["endings", "read", "write"]
