"""The errors that this package raises on purpose; each carries one sentence for a person."""


class MeshError(ValueError):
    """Bad input, or a mesh that breaks an invariant. The message says what and where."""


class OperationRefused(MeshError):
    """An operation was applied where :meth:`HalfEdgeMesh.check` does not allow it."""


def sentence(text: str) -> str:
    """The text with a capital letter and a full stop, unless it ends in a mark already."""
    text = capitalised(text)
    return text if text.endswith((".", "\u2026", "!", "?")) else text + "."


def capitalised(text: str) -> str:
    """The text with a capital letter at its beginning; the other letters stay as they are."""
    return text[:1].upper() + text[1:]
