"""The film: walking through the history, and exporting it."""

from __future__ import annotations

from app.desktop.action import Action

ACTIONS: tuple[Action, ...] = ()
