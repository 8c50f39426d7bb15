"""Persistent settings, stored by Qt where the platform stores settings.

Settings that several modules use are properties; a panel stores its own by :meth:`Settings.flag`
and the like, under a key that begins with the panel's name.
"""

import json
from collections.abc import Mapping
from typing import Any

from qtpy.QtCore import QByteArray, QSettings

from meshwright.graphics.theme import COLOURS, THEMES
from meshwright.signals import Signal

ORGANISATION, NAME = "meshwright", "meshwright"
SYSTEM = "system"
"""The theme setting that follows the desktop."""
RECENT = 10
"""Length of the list of recent files."""


class Settings:
    """Typed access to one store; ``path`` names an INI file instead of the user's own store.

    ``changed(key)`` is emitted when a value has changed. Invalid values, for example from another
    version, read as the defaults.
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

    # Properties

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
        """Whether irregular vertices show their irregularity as a number."""
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
        """Whether every step is saved at once, so that it can be recovered after a crash."""
        return self.flag("files/autosave", True)

    @autosave.setter
    def autosave(self, on: bool) -> None:
        self.put("files/autosave", on)

    @property
    def recent(self) -> list[str]:
        """Paths of recently opened or saved files, the latest first."""
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
        """Position and size of the window as returned by ``QWidget.saveGeometry``; empty if
        unknown.
        """
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
        """One of ``choices``; the first one if the stored value is invalid."""
        found = self.text(key, choices[0])
        return found if found in choices else choices[0]

    def number(self, key: str, default: float) -> float:
        """A number; the default if the stored value is invalid."""
        try:
            return float(self.text(key, str(default)))
        except ValueError:
            return default

    def texts(self, key: str) -> list[str]:
        """A list of texts."""
        found = self._store.value(key, [])
        found = [found] if isinstance(found, str) else found
        return [str(one) for one in found] if isinstance(found, list) else []

    def record(self, key: str) -> dict[str, Any]:
        """What :meth:`put_record` stored; empty if there is nothing, or it is damaged."""
        try:
            found = json.loads(self.text(key, "{}"))
        except ValueError:
            return {}
        return found if isinstance(found, dict) else {}

    def put_record(self, key: str, value: Mapping[str, Any]) -> None:
        """Store what JSON can hold."""
        self.put(key, json.dumps(value))

    def raw(self, key: str) -> QByteArray:
        """Bytes, such as a window's geometry; empty if there are none."""
        found = self._store.value(key)
        return found if isinstance(found, QByteArray) else QByteArray()

    def put(self, key: str, value: object) -> None:
        """Store ``value``, and emit ``changed`` if it is another one."""
        before = self._store.value(key)
        self._store.setValue(key, value)
        if before is None or self._store.value(key) != before:
            self.changed.emit(key)

    def clear(self, group: str = "") -> None:
        """Remove the values whose keys begin with ``group/``, or all values."""
        for key in self._store.allKeys():
            if not group or key.startswith(f"{group}/"):
                self._store.remove(key)
                self.changed.emit(key)
