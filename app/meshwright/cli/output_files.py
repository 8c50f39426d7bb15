"""Output files of commands: checked before the work begins, written atomically."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from meshwright.console import UserError


def checked_output(path: str, endings: tuple[str, ...] = (), option: str = "-o") -> Path:
    """Return the path if a file can be written there, or raise UserError with the reason.

    ``endings`` are the allowed ones in lower case with their dot; empty allows any. Commands call
    this before they begin to work, so that a wrong path is reported at once.
    """
    target = Path(path)
    folder = target.parent
    if target.is_dir():
        raise UserError(f"{option} {path}: that is a folder; give the name of a file")
    if not folder.exists():
        raise UserError(f"{option} {path}: the folder {folder} does not exist")
    if not folder.is_dir():
        raise UserError(f"{option} {path}: {folder} is not a folder")
    if endings and target.suffix.lower() not in endings:
        found = f"the ending {target.suffix}" if target.suffix else "a name without an ending"
        raise UserError(f"{option} {path}: cannot write {found}; use one of {' '.join(endings)}")
    if not os.access(target if target.exists() else folder, os.W_OK):
        raise UserError(f"{option} {path}: no permission to write there")
    return target


def checked_folder(path: str, option: str = "-o", parents: bool = False) -> Path:
    """Return the folder if it can be made where it does not exist, or raise UserError with the
    reason. ``parents``: its parent need not exist either.
    """
    folder = Path(path)
    if parents:
        there = next(one for one in (folder, *folder.absolute().parents) if one.exists())
        if not there.is_dir():
            raise UserError(f"{option} {path}: {there} is a file; give the name of a folder")
        if not os.access(there, os.W_OK):
            raise UserError(f"{option} {path}: no permission to write there")
        return folder
    if folder.exists() and not folder.is_dir():
        raise UserError(f"{option} {path}: that is a file; give the name of a folder")
    if not folder.exists() and not folder.absolute().parent.is_dir():
        raise UserError(f"{option} {path}: the folder {folder.parent} does not exist")
    if not os.access(folder if folder.exists() else folder.absolute().parent, os.W_OK):
        raise UserError(f"{option} {path}: no permission to write there")
    return folder


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``target``; it replaces the target if the block succeeds.

    If the block fails, an existing target is unchanged and the temporary file is removed.
    An operating system error becomes a UserError that names the target.
    """
    from meshwright_core.errors import MeshError
    from meshwright_core.io import atomic_write

    try:
        with atomic_write.replacing(target) as temporary:
            yield temporary
    except MeshError as error:
        raise UserError(str(error)) from error
