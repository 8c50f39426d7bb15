"""The exceptions of this package; each message is one sentence for the user."""


class MeshError(ValueError):
    """Invalid input, or a mesh that breaks an invariant; the message names what and where."""


class OperationRefused(MeshError):
    """An operation was applied where :meth:`HalfEdgeMesh.check` does not allow it."""
