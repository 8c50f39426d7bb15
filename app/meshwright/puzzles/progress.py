"""Stores the most stars and the fewest operations reached in every level, on disk.

Window and notebook share one file. A damaged file is renamed, and a new one begun.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import platformdirs
from msgspec import Meta, Struct

from meshwright.document.json_records import Count, decoded
from meshwright_core import MeshError
from meshwright_core.io.atomic_write import replacing

VERSION = 1
MOST_STARS = 3
LARGEST_FILE = 1 << 20
"""Limit on the size of the file in bytes."""


@dataclass(frozen=True)
class Best:
    """The best result in a level; none yet if ``stars`` is 0."""

    stars: int = 0
    used: int = 0
    """The fewest operations."""


class _BestRecord(Struct):
    stars: Annotated[int, Meta(ge=1, le=MOST_STARS)]
    used: Count


class _ProgressFile(Struct):
    """The contents of the file."""

    version: Literal[1]
    levels: dict[str, _BestRecord]


def usual_path() -> Path:
    """Path of the file; `MESHWRIGHT_STATE_DIR` overrides the user's state folder."""
    chosen = os.environ.get("MESHWRIGHT_STATE_DIR")
    return Path(chosen or platformdirs.user_state_path("meshwright")) / "levels.json"


class LevelProgress:
    """The file at ``path``, by default the user's; read at the first access."""

    def __init__(self, path: Path | None = None) -> None:
        self.path = path or usual_path()
        self.notice = ""
        """An error in reading the file, as one sentence; empty if there was none."""
        self._found: dict[str, Best] | None = None

    def best(self, name: str) -> Best:
        """The best result in the level of this name."""
        if self._found is None:
            self._found = self._read()
        return self._found.get(name, Best())

    @property
    def stars(self) -> int:
        """The sum of all stars."""
        self.best("")
        return sum(best.stars for best in (self._found or {}).values())

    def note(self, name: str, stars: int, used: int) -> bool:
        """Record a result; True if it is better than before.

        Results that another process has written are merged. Raises MeshError if the file cannot be
        written; the result then still counts in this process.
        """
        found = self._read()
        for known, best in (self._found or {}).items():
            found[known] = _better(found.get(known, Best()), best)
        before = found.get(name, Best())
        found[name] = _better(before, Best(stars, used))
        self._found = found
        if found[name] == before:
            return False
        self._write(found)
        return True

    def _read(self) -> dict[str, Best]:
        try:
            if self.path.stat().st_size > LARGEST_FILE:
                raise ValueError("too large")
            file = decoded(self.path.read_bytes(), _ProgressFile)
            return {name: Best(best.stars, best.used) for name, best in file.levels.items()}
        except FileNotFoundError:
            return {}
        except OSError as error:
            self.notice = f"The stars of the levels cannot be read ({error.strerror}): {self.path}."
        except ValueError:
            self.notice = f"The file with the stars of the levels was broken: {self._put_aside()}"
        return {}

    def _put_aside(self) -> str:
        aside = self.path.with_suffix(".broken")
        try:
            os.replace(self.path, aside)
        except OSError:
            return "all levels start without stars."
        return f"all levels start without stars; it is kept as {aside.name}."

    def _write(self, found: dict[str, Best]) -> None:
        record = {name: {"stars": best.stars, "used": best.used} for name, best in found.items()}
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise MeshError(f"{self.path}: cannot be written ({error.strerror}).") from error
        with replacing(self.path) as temporary:
            text = json.dumps({"version": VERSION, "levels": record}, indent=1)
            temporary.write_text(text, "utf-8")


def _better(one: Best, other: Best) -> Best:
    """The more stars, and the fewer operations of the results that have stars."""
    used = [best.used for best in (one, other) if best.stars]
    return Best(max(one.stars, other.stars), min(used, default=0))
