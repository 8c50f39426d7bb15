"""The guard of a person's work: autosave, recovery, and the question before something is lost."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from meshwright.desktop.files.save_question import Question
from meshwright.document.storage import recovery
from meshwright.document.storage.autosave import Autosave
from meshwright_core import MeshError

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow
    from meshwright.document.storage.recovery import LostWork


class Guard:
    """Keeps every step of one window's document, and asks before unsaved work is dropped.

    ``folder`` is where autosave writes; None for the person's own.
    """

    def __init__(self, window: MainWindow, folder: Path | None = None) -> None:
        self._window = window
        self._folder = folder
        self._question: Question | None = None
        self._leaving = False
        self.autosave = Autosave(window.document, folder)
        self.autosave.enabled = window.settings.autosave
        self.autosave.failed.connect(window.notice.tell)
        self.autosave.resumed.connect(window.say)
        window.settings.changed.connect(self._on_setting_changed)

    def release(self) -> None:
        """The window closes: what is dropped has been agreed on, or is left for the next start."""
        self._window.settings.changed.disconnect(self._on_setting_changed)
        if self._leaving:
            self.autosave.leave()
        else:
            self.autosave.close()

    def leave(self) -> None:
        """Close the window without a question; the next start offers what was not saved."""
        self._leaving = True
        if self._question is not None:
            self._question.reject()
        self._window.close()

    def may_drop(self) -> bool:
        """Whether the mesh may give way: nothing is unsaved, or the person has decided."""
        document = self._window.document
        if self._leaving or document.empty or not document.modified:
            return True
        if self._question is not None:
            return False
        name = document.name or "this mesh"
        self._question = Question(
            f"Save the changes to {name}?",
            f"What has changed since {document.path.name} was saved is lost otherwise."
            if document.path is not None
            else "It has not been saved to a file yet, and is lost otherwise.",
            (("cancel", "Cancel"), ("save", "Save")),
            ("drop", "Don\u2019t save"),
            self._window,
        )
        answer = self._question.ask()
        self._question = None
        if answer == "save":
            return self._window.files.save()
        return answer == "drop" or self._leaving

    def offer(self) -> None:
        """Offer what was lost, if anything was."""
        works = recovery.lost(self._folder) if self._window.isVisible() else []
        if works:
            self._offer(works)

    def ask_for_lost(self) -> None:
        """As :meth:`offer`, for a person who asks."""
        works = recovery.lost(self._folder)
        if works:
            self._offer(works)
        else:
            self._window.say("There is no lost work: everything was saved or dropped.")

    def _offer(self, works: list[LostWork]) -> None:
        from meshwright.desktop.files.recovery_dialog import LostWork

        dialog = LostWork(works, self._window)
        dialog.exec()
        chosen = dialog.chosen
        for work in dialog.works:
            if work is not chosen:
                work.release()
        dialog.deleteLater()
        if chosen is not None:
            self._recover(chosen)

    def _recover(self, work: LostWork) -> None:
        window = self._window
        if not self.may_drop():
            work.release()
            return
        try:
            kept = work.read()
        except MeshError as error:
            work.release()
            window.notice.tell(str(error))
            return
        window.document.adopt(kept)
        window.files.show_all()
        if self.autosave.begin():
            work.discard()
        else:
            work.release()
        steps = kept.history.cursor
        window.say(f"Recovered {kept.name or 'the mesh'}, {steps:,} steps.")

    def _on_setting_changed(self, key: str) -> None:
        if key == "files/autosave":
            self.autosave.enabled = self._window.settings.autosave
