"""Replaying the operations that a search returns."""


def replayed(mesh, operations):
    """A copy of the mesh on which the operations are done; it is valid."""
    copy = mesh.copy()
    for operation, h in operations:
        copy.apply(operation, h)
    copy.validate()
    return copy
