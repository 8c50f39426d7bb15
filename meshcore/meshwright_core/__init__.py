"""The half-edge mesh and all that changes it. Knows neither torch nor Qt."""

from meshcore.errors import MeshError, OperationRefused
from meshcore.io import read, write
from meshcore.mesh import HalfEdgeMesh
from meshcore.operations import Operation
from meshcore.verdicts import Edit, Verdict

__all__ = [
    "Edit",
    "HalfEdgeMesh",
    "MeshError",
    "Operation",
    "OperationRefused",
    "Verdict",
    "read",
    "write",
]
