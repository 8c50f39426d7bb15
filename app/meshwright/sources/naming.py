"""How a word on the command line or in a notebook is read: as a name or as a path.

Imports pathlib only, so that the command line answers quickly.
"""

from pathlib import Path


def looks_like_path(text: str) -> bool:
    """Whether the text has a file ending or a folder in it, so that a file is meant."""
    return bool(Path(text).suffix) or "/" in text or "\\" in text
