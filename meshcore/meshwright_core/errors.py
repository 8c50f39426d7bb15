"""The exceptions of this package; each message is one sentence for the user."""


class MeshError(ValueError):
    """Invalid input, or a mesh that breaks an invariant; the message names what and where."""


class MixedElementsError(MeshError):
    """A mesh file holds triangles and quads, and was not to be made all quads."""


class OperationRefused(MeshError):
    """An operation was applied where :meth:`HalfEdgeMesh.check` does not allow it."""


class FileWarning(UserWarning):
    """What reading a file leaves out, or writing one loses; one sentence that names the file."""


class GridWarning(UserWarning):
    """A wish for a block grid that has no effect; one sentence."""


def sentence(text: str) -> str:
    """The text with a capital letter and a full stop, unless it ends in a mark already."""
    text = capitalised(text)
    return text if text.endswith((".", "\u2026", "!", "?")) else text + "."


def capitalised(text: str) -> str:
    """The text with a capital letter at its beginning; the other letters stay as they are."""
    return text[:1].upper() + text[1:]
