"""What tells whether a file was changed by someone else: its time of modification and its size."""

from pathlib import Path

Stamp = tuple[int, int]

MISSING: Stamp = (0, 0)
"""The stamp of no file, or of one that cannot be looked at."""


def of(path: Path | None) -> Stamp:
    """Time of modification in nanoseconds, and size in bytes."""
    if path is None:
        return MISSING
    try:
        found = path.stat()
    except OSError:
        return MISSING
    return found.st_mtime_ns, found.st_size
