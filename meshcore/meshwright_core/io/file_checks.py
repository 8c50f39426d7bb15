"""Checks and error messages shared by all file readers; messages begin with the path."""

from __future__ import annotations

import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from meshwright_core.errors import MeshError, sentence
from meshwright_core.io.atomic_write import reason


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Turn exceptions about a file into a MeshError: one sentence that begins with its path."""
    try:
        yield
    except MeshError as error:
        raise type(error)(f"{path}: {str(error).rstrip('.')}.") from error
    except FileNotFoundError as error:
        raise MeshError(f"{path}: there is no such file.") from error
    except OSError as error:
        raise MeshError(f"{path}: it cannot be read ({reason(error)}).") from error
    except ValueError as error:
        if "\0" in str(path) or isinstance(error, UnicodeEncodeError):
            raise MeshError(f"{str(path)!r} is no name for a file.") from error
        said = sentence(" ".join(str(error).split())).rstrip(".")
        raise MeshError(f"{path}: it cannot be read ({said}).") from error


def size_of(path: Path) -> int:
    """Bytes of an ordinary file that is not empty; MeshError for anything else."""
    status = path.stat()
    if stat.S_ISDIR(status.st_mode):
        raise MeshError("this is a folder, not a file")
    if not stat.S_ISREG(status.st_mode):
        raise MeshError("this is not an ordinary file")
    if status.st_size == 0:
        raise MeshError("the file is empty")
    return int(status.st_size)
