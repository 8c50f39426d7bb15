"""Preferences that outlive the window, kept by Qt where the platform keeps such things.

What is kept has a property here when more than one place asks for it; panels keep what is theirs
alone by :meth:`Settings.flag` and its like, under a key that begins with the panel's name.
"""

from qtpy.QtCore import QByteArray, QSettings

from meshwright.graphics.theme import COLOURS, THEMES
from meshwright.signals import Signal

ORGANISATION, NAME = "meshwright", "meshwright"
SYSTEM = "system"
"""The theme that follows the desktop's."""
RECENT = 10
"""Files that are remembered."""


class Settings:
    """Typed access to one store; ``path`` names an INI file instead of the user's own store.

    ``changed(key)`` is emitted when something is kept that was not so before. A store that holds
    nonsense, from another version or another program, gives the defaults.
    """

    def __init__(self, path: str | None = None) -> None:
        self.changed = Signal()
        self._store = (
            QSettings(path, QSettings.Format.IniFormat)
            if path
            else QSettings(
                QSettings.Format.IniFormat, QSettings.Scope.UserScope, ORGANISATION, NAME
            )
        )

    # What is kept

    @property
    def theme(self) -> str:
        """``"system"``, ``"light"`` or ``"dark"``."""
        return self.choice("look/theme", (SYSTEM, *THEMES))

    @theme.setter
    def theme(self, name: str) -> None:
        self.put("look/theme", name)

    @property
    def colours(self) -> str:
        """The pair of colours of irregular vertices, a key of
        :data:`meshwright.graphics.theme.COLOURS`.
        """
        return self.choice("look/colours", tuple(COLOURS))

    @colours.setter
    def colours(self, name: str) -> None:
        self.put("look/colours", name)

    @property
    def numbers(self) -> bool:
        """Whether irregular vertices carry their number."""
        return self.flag("look/numbers", True)

    @numbers.setter
    def numbers(self, shown: bool) -> None:
        self.put("look/numbers", shown)

    @property
    def auto_smooth(self) -> bool:
        """Whether the neighbourhood is smoothed after every operation."""
        return self.flag("editing/auto_smooth", True)

    @auto_smooth.setter
    def auto_smooth(self, on: bool) -> None:
        self.put("editing/auto_smooth", on)

    @property
    def autosave(self) -> bool:
        """Whether every step is written down at once, to be found again after a crash."""
        return self.flag("files/autosave", True)

    @autosave.setter
    def autosave(self, on: bool) -> None:
        self.put("files/autosave", on)

    @property
    def recent(self) -> list[str]:
        """Paths of files opened or saved lately, the last one first."""
        return self.texts("files/recent")[:RECENT]

    @recent.setter
    def recent(self, paths: list[str]) -> None:
        self.put("files/recent", list(dict.fromkeys(paths))[:RECENT])

    @property
    def toured(self) -> bool:
        """Whether the tour has been shown."""
        return self.flag("guide/toured", False)

    @toured.setter
    def toured(self, shown: bool) -> None:
        self.put("guide/toured", shown)

    @property
    def geometry(self) -> QByteArray:
        """Where the window was, as ``QWidget.saveGeometry`` says it; empty if unknown."""
        return self.raw("window/geometry")

    @geometry.setter
    def geometry(self, geometry: QByteArray) -> None:
        self.put("window/geometry", geometry)

    # By key

    def flag(self, key: str, default: bool) -> bool:
        """A switch."""
        found = str(self._store.value(key, default)).lower()
        return found == "true" if found in ("true", "false") else default

    def text(self, key: str, default: str = "") -> str:
        """A text."""
        return str(self._store.value(key, default))

    def choice(self, key: str, choices: tuple[str, ...]) -> str:
        """One of ``choices``, the first where the store holds something else."""
        found = self.text(key, choices[0])
        return found if found in choices else choices[0]

    def number(self, key: str, default: float) -> float:
        """A number; the default where the store holds something else."""
        try:
            return float(self.text(key, str(default)))
        except ValueError:
            return default

    def texts(self, key: str) -> list[str]:
        """A list of texts."""
        found = self._store.value(key, [])
        found = [found] if isinstance(found, str) else found
        return [str(one) for one in found] if isinstance(found, list) else []

    def raw(self, key: str) -> QByteArray:
        """Bytes as Qt gives them for geometries; empty where there are none."""
        found = self._store.value(key)
        return found if isinstance(found, QByteArray) else QByteArray()

    def put(self, key: str, value: object) -> None:
        """Keep ``value``."""
        before = self._store.value(key)
        self._store.setValue(key, value)
        if before is None or self._store.value(key) != before:
            self.changed.emit(key)

    def clear(self, group: str = "") -> None:
        """Forget what is kept under keys that begin with ``group/``, or everything."""
        for key in self._store.allKeys():
            if not group or key.startswith(f"{group}/"):
                self._store.remove(key)
                self.changed.emit(key)
