"""Files in the window: open, save, recent, drop, projects, unsaved work and recovery."""

import numpy as np
import pytest
from driving import WAIT, point_at, press
from qtpy.QtCore import QMimeData, QPoint, QPointF, Qt, QTimer, QUrl
from qtpy.QtGui import QDragEnterEvent, QDragLeaveEvent, QDropEvent
from qtpy.QtWidgets import QApplication, QFileDialog, QLabel

from meshwright.desktop.files.recovery_dialog import RecoveryDialog
from meshwright.desktop.files.save_question import QuestionDialog
from meshwright.document.document import Document
from meshwright.document.storage import recovery
from meshwright.document.storage.autosave import Autosave
from meshwright_core import HalfEdgeMesh

CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def watched(open_window, tmp_path):
    """Opens a window with autosave in a folder of the test."""

    def build(mesh: HalfEdgeMesh | None = None, **options):
        window = open_window(mesh, **options)
        window.files.watch(tmp_path / "state")
        return window

    return build


def edit(qtbot, window) -> None:
    """Apply one operation by its key."""
    mesh = window.document.mesh
    halfedge = next(h for h in range(4 * mesh.n_elements) if mesh.check("flip_left", h))
    point_at(qtbot, window, halfedge)
    cursor = window.document.history.cursor
    press(qtbot, window, Qt.Key.Key_F)
    assert window.document.history.cursor == cursor + 1


def when_shown(qtbot, kind, act) -> list:
    """Call ``act(dialog)`` as soon as a dialog of this class opens; returns the list of opened
    dialogs.
    """
    met = []

    def look() -> None:
        dialog = QApplication.activeModalWidget()
        if isinstance(dialog, kind):
            timer.stop()
            met.append(dialog)
            act(dialog)

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(20)
    met_and_timer = met
    qtbot.timers = [*getattr(qtbot, "timers", []), timer]
    return met_and_timer


def answering(qtbot, answer: str) -> list:
    """Click a button of the next question; an empty answer presses Escape."""

    def act(dialog: QuestionDialog) -> None:
        if answer:
            qtbot.mouseClick(dialog.buttons[answer], Qt.MouseButton.LeftButton)
        else:
            qtbot.keyClick(dialog, Qt.Key.Key_Escape)

    return when_shown(qtbot, QuestionDialog, act)


@pytest.mark.parametrize("answer", ["drop", "save", "cancel", ""])
def test_closing_asks_about_unsaved_work(qtbot, watched, star, tmp_path, answer):
    window = watched(star)
    window.document.save(tmp_path / "star.vtk")
    edit(qtbot, window)
    journal = window.files.guard.autosave.path
    assert journal.exists()
    met = answering(qtbot, answer)
    press(qtbot, window, Qt.Key.Key_Q, CONTROL)
    assert len(met) == 1
    closed = answer in ("drop", "save")
    assert window.isVisible() != closed
    assert journal.exists() != closed
    fresh = Document()
    fresh.open(tmp_path / "star.vtk")
    assert (fresh.score == window.document.score) == (answer == "save")


def test_closing_asks_nothing_without_unsaved_work(qtbot, watched, star, tmp_path):
    window = watched(star)
    edit(qtbot, window)
    window.files._save(str(tmp_path / "star.meshwright"))
    assert window.close()
    assert not window.isVisible()


def test_closing_asks_about_steps_that_were_undone(qtbot, watched, star, tmp_path):
    window = watched(star)
    edit(qtbot, window)
    edit(qtbot, window)
    press(qtbot, window, Qt.Key.Key_Z, CONTROL)
    edit(qtbot, window)
    press(qtbot, window, Qt.Key.Key_Home, Qt.KeyboardModifier.AltModifier)
    assert window.document.history.cursor == 0
    assert window.isWindowModified()
    met = []

    def act(dialog: QuestionDialog) -> None:
        met.extend(label.text() for label in dialog.findChildren(QLabel))
        qtbot.keyClick(dialog, Qt.Key.Key_Escape)

    when_shown(qtbot, QuestionDialog, act)
    assert not window.close()
    assert "2 steps, 2 of them undone, and 1 branch" in " ".join(met)
    window.files.leave()  # as after a crash
    (lost,) = recovery.lost(tmp_path / "state")
    assert len(lost.read().history.branches) == 1
    lost.discard()


def test_saving_a_mesh_file_does_not_save_the_history(qtbot, watched, star, tmp_path, monkeypatch):
    window = watched(star)
    edit(qtbot, window)
    window.files._save(str(tmp_path / "star.vtk"))
    assert window.windowTitle().startswith("star[*], history not saved")
    assert "1 step" in window.status.message
    journal = window.files.guard.autosave.path
    assert journal.exists()
    asked = []

    def name(parent, title, start, filters, chosen):
        asked.append((start, chosen))
        return str(tmp_path / "kept"), chosen

    monkeypatch.setattr(QFileDialog, "getSaveFileName", name)
    met = answering(qtbot, "save_as")
    assert window.close()
    assert len(met) == 1
    assert asked[0][0] == str(tmp_path / "star.meshwright")
    assert asked[0][1].startswith("Meshwright projects")
    fresh = Document()
    fresh.open(tmp_path / "kept.meshwright")
    assert len(fresh.history) == 1
    assert not journal.exists()


@pytest.mark.parametrize("answer", ["cancel", "reload", "overwrite", "save_as"])
def test_two_windows_on_one_project_do_not_overwrite_each_other(
    qtbot, watched, star, tmp_path, monkeypatch, answer
):
    path = tmp_path / "star.meshwright"
    window = watched(star)
    window.files._save(str(path))
    other = Document()
    other.open(path)
    other.smooth()
    other.save()
    edit(qtbot, window)
    edit(qtbot, window)
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "b"), "Mesh"))
    met = answering(qtbot, answer)
    press(qtbot, window, Qt.Key.Key_S, CONTROL)
    assert len(met) == 1
    assert len(window.document.history) == (1 if answer == "reload" else 2)
    on_disk = Document()
    on_disk.open(path)
    assert len(on_disk.history) == (2 if answer == "overwrite" else 1)
    assert (tmp_path / "b.meshwright").exists() == (answer == "save_as")
    assert window.document.modified == (answer == "cancel")
    if answer in ("reload", "overwrite"):
        window.activateWindow()  # there is no window manager to do it
        qtbot.waitUntil(window.isActiveWindow, timeout=WAIT)
        edit(qtbot, window)
        press(qtbot, window, Qt.Key.Key_S, CONTROL)  # without a question
        assert not window.document.modified


def test_project_stores_history_view_and_policy(qtbot, watched, star, tmp_path, monkeypatch):
    window = watched(star)
    edit(qtbot, window)
    edit(qtbot, window)
    seen = window.canvas.viewport.zoomed(2.0, 100, 100)
    window.canvas.see(seen)
    asked = []

    def name(parent, title, start, filters, chosen):
        asked.append((start, chosen))
        return str(tmp_path / "work"), chosen

    monkeypatch.setattr(QFileDialog, "getSaveFileName", name)
    press(qtbot, window, Qt.Key.Key_S, CONTROL)
    assert asked[0][0] == "star.meshwright"
    assert (tmp_path / "work.meshwright").exists()
    assert window.status.message == "Saved work.meshwright."
    assert not window.isWindowModified()
    assert window.files.guard.autosave.path is None
    assert window.windowTitle().startswith("work")
    other = watched()
    other.files.open(tmp_path / "work.meshwright")
    assert other.document.history.cursor == 2
    assert np.array_equal(other.document.mesh.points, star.points)
    assert other.canvas.viewport.centre == pytest.approx(seen.centre)
    press(qtbot, other, Qt.Key.Key_Z, CONTROL)
    press(qtbot, other, Qt.Key.Key_Z, CONTROL)
    assert other.document.score == 12
    other.document.go_to(2)
    assert not other.isWindowModified()


def test_saving_reports_what_the_format_does_not_store(
    qtbot, open_window, star, triangles, tmp_path
):
    window = open_window(triangles)
    window.files._save(str(tmp_path / "a.stl"))
    assert "store no corners" in window.status.message
    window.files._save(str(tmp_path / "a.vtk"))
    assert window.status.message == "Saved a.vtk."


def test_file_errors_are_reported_in_one_sentence(qtbot, open_window, star, tmp_path, monkeypatch):
    window = open_window(star)
    place = str(tmp_path / "nowhere" / "a.vtk")
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (place, "Meshes (*.vtk)"))
    assert not window.files.save()
    assert "does not exist" in window.notice.text
    broken = tmp_path / "broken.meshwright"
    broken.write_text("no zip at all")
    window.files.open(broken)
    assert window.notice.text.endswith("not a whole one.")
    assert window.document.mesh is star


def test_a_drawing_opens_in_the_dialog(qtbot, open_window, star, tmp_path):
    window = open_window(star)
    drawing = tmp_path / "parts.svg"
    shape = '<circle cx="{}" cy="5" r="5"/>'
    form = '<svg xmlns="http://www.w3.org/2000/svg">{}</svg>'
    drawing.write_text(form.format(shape.format(5) + shape.format(50) + "<text>5 mm</text>"))
    seen = {}

    def accept():
        dialog = QApplication.activeModalWidget()
        seen["page"], seen["path"] = dialog.tabs.key, dialog.file.chosen
        qtbot.waitUntil(lambda: dialog.made is not None, timeout=WAIT)
        seen["rows"] = dialog.file.found.table.rowCount()
        seen["said"] = " ".join(dialog.file.found.sentences)
        dialog.make.click()

    QTimer.singleShot(200, accept)
    window.files.open(drawing)
    assert (seen["page"], seen["path"], seen["rows"]) == ("file", str(drawing), 2)
    assert "text" in seen["said"].lower()
    assert window.document.name.startswith("parts")
    assert window.document.mesh.off_curve().max() < 1e-12
    assert window.settings.recent[0] == str(drawing)


def test_a_drawing_without_a_shape_is_refused_without_a_dialog(open_window, star, tmp_path):
    window = open_window(star)
    (tmp_path / "empty.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"></svg>')
    window.files.open(tmp_path / "empty.svg")
    assert "empty.svg" in window.notice.text
    assert window.document.mesh is star


def test_recent_files(qtbot, open_window, star, tmp_path):
    window = open_window(star)
    assert not window.actions_by_id["recent"].isEnabled()
    for name in ("a.vtk", "b & c.meshwright"):
        window.files._save(str(tmp_path / name))
    assert window.actions_by_id["recent"].isEnabled()
    window.files.show_recent()
    menu = window.files.recent
    assert menu.isVisible()
    texts = [entry.text() for entry in menu.actions()]
    assert texts[0].startswith("&1  b && c.meshwright\t")
    assert texts[1].startswith("&2  a.vtk\t")
    qtbot.keyClick(menu, Qt.Key.Key_2)
    assert window.document.path == tmp_path / "a.vtk"
    assert window.settings.recent[0] == str(tmp_path / "a.vtk")
    (tmp_path / "b & c.meshwright").unlink()
    window.files.open(tmp_path / "b & c.meshwright")
    assert "no such file" in window.notice.text
    assert window.settings.recent == [str(tmp_path / "a.vtk")]
    menu.fill()
    menu.actions()[-1].trigger()
    assert window.settings.recent == []


def dragged(path) -> QMimeData:
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    return data


def send(window, kind, data) -> bool:
    """Send a drag event; returns whether it was accepted."""
    actions = Qt.DropAction.CopyAction
    buttons, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    where = QPoint(300, 300) if kind is QDragEnterEvent else QPointF(300, 300)
    event = kind(where, actions, data, buttons, keys)
    event.setAccepted(False)
    QApplication.sendEvent(window, event)
    return event.isAccepted()


def test_dropped_file_is_opened(qtbot, open_window, star, tmp_path):
    Document(star.copy(), "star").save(tmp_path / "dropped.vtk")
    window = open_window()
    assert not window.canvas.plotter.acceptDrops()
    data = dragged(tmp_path / "dropped.vtk")
    veil = window.files.dropping.veil
    assert send(window, QDragEnterEvent, data)
    assert veil.isVisible()
    assert veil.text == "Drop to open dropped.vtk"
    QApplication.sendEvent(window, QDragLeaveEvent())
    assert not veil.isVisible()
    send(window, QDragEnterEvent, data)
    assert send(window, QDropEvent, data)
    assert not veil.isVisible()
    assert window.document.name == "dropped"
    text = QMimeData()
    text.setText("no file")
    assert not send(window, QDragEnterEvent, text)


def left_behind(folder, mesh, name="lost", seeds=(1, 2, 3)) -> Document:
    """Write the state of a process that was killed."""
    from document_edits import wander

    document = Document(mesh, name)
    keeper = Autosave(document, folder)
    for seed in seeds:
        wander(document, 1, seed)
    keeper.leave()
    return document


def test_unsaved_work_of_a_dead_process_is_recovered(qtbot, watched, star, triangles, tmp_path):
    lost = left_behind(tmp_path / "state", triangles)
    window = watched(star)
    met = when_shown(
        qtbot,
        RecoveryDialog,
        lambda dialog: qtbot.mouseClick(dialog.cards[0].recover, Qt.MouseButton.LeftButton),
    )
    window.files.guard.offer()
    assert len(met) == 1
    assert np.array_equal(window.document.mesh.points, lost.mesh.points)
    assert window.document.history.cursor == 3
    assert window.status.message == "Recovered lost, 3 steps."
    assert window.isWindowModified()
    # this window keeps it until it is saved
    (journal,) = (tmp_path / "state").iterdir()
    assert journal == window.files.guard.autosave.path
    window.activateWindow()  # there is no window manager to do it
    qtbot.waitUntil(window.isActiveWindow, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_Z, CONTROL)
    window.files.leave()
    (again,) = recovery.lost(tmp_path / "state")
    assert again.now["steps"] == 2
    again.release()


def test_unsaved_work_is_discarded_by_two_clicks_or_kept(qtbot, watched, star, tmp_path):
    folder = tmp_path / "state"
    left_behind(folder, star.copy(), "first")
    left_behind(folder, star.copy(), "second", (4,))
    window = watched(star)
    output = []

    def discard_one(dialog: RecoveryDialog) -> None:
        output.extend(
            (card.title.text(), card.story.text(), card.place.text()) for card in dialog.cards
        )
        card = dialog.cards[0]
        qtbot.mouseClick(card.discard, Qt.MouseButton.LeftButton)
        assert len(list(folder.iterdir())) == 2
        assert card.discard.text() == "Delete permanently?"
        qtbot.mouseClick(card.discard, Qt.MouseButton.LeftButton)
        assert len(list(folder.iterdir())) == 1
        qtbot.mouseClick(dialog.later, Qt.MouseButton.LeftButton)

    met = when_shown(qtbot, RecoveryDialog, discard_one)
    window.actions_by_id["recover"].trigger()
    assert len(met) == 1
    assert {title for title, _, _ in output} == {"first", "second"}
    assert any(story.startswith("3 steps, s ") for _, story, _ in output)
    assert all(place.startswith("Today at") and "never saved" in place for _, _, place in output)
    assert len(list(folder.iterdir())) == 1
    (left,) = recovery.lost(folder)
    left.discard()
    window.actions_by_id["recover"].trigger()
    assert window.status.message.startswith("There is no unsaved work")


def test_recovering_asks_about_the_current_unsaved_mesh(qtbot, watched, star, tmp_path):
    left_behind(tmp_path / "state", star.copy())
    window = watched(star)
    edit(qtbot, window)
    when_shown(
        qtbot,
        RecoveryDialog,
        lambda dialog: qtbot.mouseClick(dialog.cards[0].recover, Qt.MouseButton.LeftButton),
    )
    met = answering(qtbot, "cancel")
    window.files.guard.offer()
    qtbot.waitUntil(lambda: bool(met), timeout=WAIT)
    assert window.document.mesh is star
    (left,) = recovery.lost(tmp_path / "state")
    left.release()


def test_autosave_follows_the_setting_and_reports_failure(qtbot, watched, star, tmp_path):
    (tmp_path / "state").write_text("in the way")
    window = watched(star)
    edit(qtbot, window)
    assert window.notice.text.startswith("Autosave cannot write to")
    assert window.document.history.cursor == 1
    window.settings.autosave = False
    assert not window.files.guard.autosave.enabled


def test_ctrl_c_closes_without_a_question_and_keeps_the_work(qtbot, watched, star, tmp_path):
    window = watched(star)
    edit(qtbot, window)
    met = when_shown(qtbot, QuestionDialog, lambda dialog: window.files.leave())
    assert window.close()
    assert len(met) == 1
    assert not window.isVisible()
    (left,) = recovery.lost(tmp_path / "state")
    assert left.now["steps"] == 1
    left.release()
