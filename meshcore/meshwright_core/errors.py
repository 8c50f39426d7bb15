"""The errors that this package raises on purpose; each carries one sentence for a person."""


class MeshError(ValueError):
    """Bad input, or a mesh that breaks an invariant. The message says what and where."""


class OperationRefused(MeshError):
    """An operation was applied where :meth:`HalfEdgeMesh.check` does not allow it."""
