"""Texts that a screen reader speaks."""

from qtpy import QtGui
from qtpy.QtGui import QAccessible
from qtpy.QtWidgets import QWidget


def announce(widget: QWidget, text: str) -> None:
    """Let a screen reader speak ``text``; nothing happens where none is running.

    Announcements need Qt 6.8; before, a change of the accessible description is reported.
    """
    if not text or not QAccessible.isActive():
        return
    if hasattr(QtGui, "QAccessibleAnnouncementEvent"):
        QAccessible.updateAccessibility(QtGui.QAccessibleAnnouncementEvent(widget, text))
    else:
        event = QtGui.QAccessibleEvent(widget, QAccessible.Event.DescriptionChanged)
        QAccessible.updateAccessibility(event)
