"""Half-edge meshes of triangles or quads: operations, history, geometry, files."""

from meshwright_core.errors import MeshError, OperationRefused
from meshwright_core.io.mesh_files import read, write
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import Operation
from meshwright_core.operations.verdicts import Edit, Verdict

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
