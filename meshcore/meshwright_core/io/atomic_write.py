"""Atomic writing: a file is replaced completely or not at all."""

from __future__ import annotations

import errno
import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from meshwright_core.errors import MeshError


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary file to write; put it in the place of `path` when the block ends well.

    The temporary file lies in the same folder and has the same ending. It is flushed to the disk
    before it takes the place of `path`, in one step; links are followed, and the permissions of
    an old file are kept. If anything is raised the temporary file is removed, and an old file is
    as it was.

    Raises:
        MeshError: the folder does not exist, the disk is full, or any other refusal of the
            system, in one sentence that begins with the path.
    """
    given = os.fspath(path)
    try:
        target = Path(os.path.realpath(given))
        temporary = _create(target, given)
    except OSError as error:
        raise MeshError(f"{given}: cannot be written ({reason(error)}).") from error
    except MeshError:
        raise
    except ValueError as error:
        raise MeshError(f"{given!r} is no name for a file.") from error
    try:
        yield temporary
        _flush(temporary)
        os.replace(temporary, target)
    except OSError as error:
        why = reason(error, target.parent)
        raise MeshError(f"{given}: cannot be written ({why}).") from error
    finally:
        with suppress(FileNotFoundError):
            temporary.unlink()


def reason(error: OSError, folder: Path | None = None) -> str:
    """Return the system's reason in lower case; numpy leaves it out when the disk is full."""
    if error.errno is None and folder is not None and _is_full(folder):
        return os.strerror(errno.ENOSPC).lower()
    return (error.strerror or str(error) or type(error).__name__).strip().rstrip(".").lower()


def _create(target: Path, given: str) -> Path:
    if not target.parent.is_dir():
        raise MeshError(f"{given}: the folder {target.parent} does not exist.")
    mode = None
    if target.exists():
        status = target.stat()
        if stat.S_ISDIR(status.st_mode):
            raise MeshError(f"{given}: this is a folder, not a file.")
        if not stat.S_ISREG(status.st_mode):
            raise MeshError(f"{given}: this is not an ordinary file.")
        mode = stat.S_IMODE(status.st_mode)
    # the ending stays last, because writers look at it
    temporary = target.with_name(f".{secrets.token_hex(6)}{target.suffix}")
    os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    if mode is not None:
        with suppress(PermissionError):
            temporary.chmod(mode)
    return temporary


def _flush(path: Path) -> None:
    descriptor = os.open(path, os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _is_full(folder: Path) -> bool:
    return hasattr(os, "statvfs") and os.statvfs(folder).f_bavail == 0
