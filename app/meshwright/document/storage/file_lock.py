"""Exclusive locks on files, which the system releases when the process ends for any reason.

A locked file can still be read. A second lock is refused in the same process too.
"""

import os
import sys
from pathlib import Path


def hold(path: Path, fresh: bool = False) -> int | None:
    """Lock the file; returns a descriptor for appending, or None if it is locked already.

    ``fresh`` creates the file, which must not exist. The lock is held until :func:`let_go`. Raises
    OSError if the system refuses.
    """
    flags = os.O_RDWR | os.O_APPEND | getattr(os, "O_BINARY", 0)
    descriptor = os.open(path, flags | (os.O_CREAT | os.O_EXCL if fresh else 0), 0o600)
    if not _lock(descriptor):
        os.close(descriptor)
        return None
    return descriptor


def let_go(descriptor: int) -> None:
    """Close the file and release the lock."""
    os.close(descriptor)


if sys.platform == "win32":
    import msvcrt

    _FAR = 1 << 62  # a byte that no file has

    def _lock(descriptor: int) -> bool:
        os.lseek(descriptor, _FAR, os.SEEK_SET)
        try:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        except PermissionError:
            return False
        finally:
            os.lseek(descriptor, 0, os.SEEK_SET)
        return True

else:
    import fcntl

    def _lock(descriptor: int) -> bool:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            return False
        except OSError:
            return True  # a file system without locks: offering work twice is better than never
        return True
