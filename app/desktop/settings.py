"""Preferences that outlive the window, kept by Qt where the platform keeps such things."""

from qtpy.QtCore import QByteArray, QSettings

ORGANISATION, NAME = "meshwright", "meshwright"


class Settings:
    """Typed access to one store; ``path`` names an INI file instead of the user's own store."""

    def __init__(self, path: str | None = None) -> None:
        self._store = (
            QSettings(path, QSettings.Format.IniFormat)
            if path
            else QSettings(
                QSettings.Format.IniFormat, QSettings.Scope.UserScope, ORGANISATION, NAME
            )
        )

    def flag(self, key: str, default: bool) -> bool:
        """A switch."""
        return str(self._store.value(key, default)).lower() == "true"

    def text(self, key: str, default: str = "") -> str:
        """A text."""
        return str(self._store.value(key, default))

    def number(self, key: str, default: float) -> float:
        """A number; the default where the store holds something else."""
        try:
            return float(self._store.value(key, default))
        except (TypeError, ValueError):
            return default

    def texts(self, key: str) -> list[str]:
        """A list of texts."""
        found = self._store.value(key, [])
        return [found] if isinstance(found, str) else [str(one) for one in found or []]

    def raw(self, key: str) -> QByteArray:
        """Bytes as Qt gives them for geometries; empty where there are none."""
        found = self._store.value(key)
        return found if isinstance(found, QByteArray) else QByteArray()

    def put(self, key: str, value: object) -> None:
        """Keep ``value``."""
        self._store.setValue(key, value)
