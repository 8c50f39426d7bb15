"""Protection of unsaved work: autosave, recovery, and the question before work is discarded."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from qtpy.QtWidgets import QWidget

from meshwright.desktop.application.settings import Settings
from meshwright.desktop.controller import Connections
from meshwright.desktop.files.save_question import QuestionDialog
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.desktop.widgets.wording import plural
from meshwright.document.branches import every
from meshwright.document.document import Document
from meshwright.document.storage import recovery
from meshwright.document.storage.autosave import Autosave
from meshwright.document.storage.project_file import is_project
from meshwright_core import MeshError

if TYPE_CHECKING:
    from meshwright.document.storage.recovery import LostWork


class Guard(Protocol):
    """Decides whether the mesh may be dropped."""

    def may_drop(self) -> bool:
        """Whether the mesh may be replaced or closed."""
        ...

    def leave(self) -> None:
        """Close the window without a question."""
        ...

    def offer(self) -> None:
        """Offer work that was lost, if there is any."""
        ...

    def ask_for_lost(self) -> None:
        """As :meth:`offer`; shows a message if there is none."""
        ...

    def release(self) -> None:
        """End autosave; called when the window closes."""
        ...


class NoGuard:
    """No autosave and no questions: for windows that a program opens."""

    def __init__(self, window: QWidget) -> None:
        self._window = window

    def may_drop(self) -> bool:
        """Always."""
        return True

    def leave(self) -> None:
        """Close the window."""
        self._window.close()

    def offer(self) -> None:
        """There is nothing to offer."""

    def ask_for_lost(self) -> None:
        """There is nothing to offer."""

    def release(self) -> None:
        """There is nothing to end."""


def counted(document: Document) -> str:
    """What the history holds: ``14 steps, 12 of them undone, and 4 branches``."""
    history = document.history
    undone = len(history) - history.cursor
    words = plural(len(history), "step")
    if undone:
        words += f", {undone:,} of them undone,"
    branches = sum(1 for _ in every(history.branches))
    return (
        f"{words} and {plural(branches, 'branch', 'branches')}" if branches else words.rstrip(",")
    )


class UnsavedWorkGuard:
    """Saves every step of ``document``, and asks before unsaved work is dropped.

    ``save()`` and ``save_as()`` save the document and return whether it is saved, ``show_all()``
    fits the view to a recovered mesh. Autosave writes to ``folder``; None for the user's own.
    """

    def __init__(
        self,
        document: Document,
        settings: Settings,
        status: StatusBar,
        notice: NoticeBar,
        window: QWidget,
        save: Callable[[], bool],
        save_as: Callable[[], bool],
        show_all: Callable[[], None],
        folder: Path | None = None,
    ) -> None:
        self._document, self._settings = document, settings
        self._status, self._notice, self._window = status, notice, window
        self._save, self._save_as, self._show_all = save, save_as, show_all
        self._folder = folder
        self._question: QuestionDialog | None = None
        self._leaving = False
        self.autosave = Autosave(document, folder)
        self.autosave.enabled = settings.autosave
        self.autosave.failed.connect(notice.show_message)
        self.autosave.resumed.connect(status.show_message)
        self._connections = Connections()
        self._connections.add(settings.changed, self._on_setting_changed)

    def release(self) -> None:
        """End autosave; unsaved work is kept for the next start if no question was asked."""
        self._connections.close()
        if self._leaving:
            self.autosave.leave()
        else:
            self.autosave.close()

    def leave(self) -> None:
        """Close the window without a question; unsaved work is offered at the next start."""
        self._leaving = True
        if self._question is not None:
            self._question.reject()
        self._window.close()

    def may_drop(self) -> bool:
        """Whether the mesh may be discarded: nothing is unsaved, or the user has agreed."""
        document = self._document
        if self._leaving or document.empty or not document.modified:
            return True
        if self._question is not None:
            return False
        self._question = self._make_question()
        answer = self._question.ask()
        self._question = None
        if answer in ("save", "save_as"):
            return self._save() if answer == "save" else self._save_as()
        return answer == "drop" or self._leaving

    def _make_question(self) -> QuestionDialog:
        """The question about unsaved work; it says what would be lost."""
        document = self._document
        name, path = document.name or "this mesh", document.path
        history, title = counted(document), f"Save the changes to {name}?"
        project = ("save_as", "Save project\u2026")
        saves = [project]
        if path is not None and is_project(path):
            text = f"Otherwise the changes since {path.name} was saved are lost."
            saves = [("save", "Save")]
        elif not document.mesh_modified:
            title = f"Save the history of {name}?"
            holds = f"{path.name} holds the mesh alone." if path else "The mesh is as it began."
            text = f"{holds} Its history would be lost: {history}. A project keeps it."
        elif path is not None:
            text = (
                f"Otherwise the changes since {path.name} was saved are lost. That file holds the"
                f" mesh alone; a project also keeps its history: {history}."
            )
            saves = [("save", "Save mesh"), project]
        else:
            text = f"It has not been saved yet, and would be lost with its history: {history}."
        return QuestionDialog(
            title, text, (("cancel", "Cancel"), *saves), ("drop", "Don\u2019t save"), self._window
        )

    def offer(self) -> None:
        """Offer unsaved work of ended processes, if there is any."""
        works = recovery.lost(self._folder) if self._window.isVisible() else []
        if works:
            self._offer(works)

    def ask_for_lost(self) -> None:
        """As :meth:`offer`; shows a message if there is none."""
        works = recovery.lost(self._folder)
        if works:
            self._offer(works)
        else:
            self._status.show_message("There is no unsaved work to recover.")

    def _offer(self, works: list[LostWork]) -> None:
        from meshwright.desktop.files.recovery_dialog import RecoveryDialog

        dialog = RecoveryDialog(works, self._window)
        dialog.exec()
        chosen = dialog.chosen
        for work in dialog.works:
            if work is not chosen:
                work.release()
        dialog.deleteLater()
        if chosen is not None:
            self._recover(chosen)

    def _recover(self, work: LostWork) -> None:
        if not self.may_drop():
            work.release()
            return
        try:
            kept = work.read()
        except MeshError as error:
            work.release()
            self._notice.show_message(str(error))
            return
        self._document.adopt(kept)
        self._show_all()
        if self.autosave.begin():
            work.discard()
        else:
            work.release()
        steps = kept.history.cursor
        self._status.show_message(f"Recovered {kept.name or 'the mesh'}, {steps:,} steps.")

    def _on_setting_changed(self, key: str) -> None:
        if key == "files/autosave":
            self.autosave.enabled = self._settings.autosave
