"""Levels in the window, by its mouse, keys and buttons."""

import pytest
from driving import WAIT, point_at, press
from qtpy.QtCore import Qt, QTimer
from qtpy.QtWidgets import QApplication

from meshwright.assistant.assistant import Assistant
from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.puzzles import level
from meshwright.puzzles.agent_opponent import OpponentState
from meshwright.puzzles.progress import LevelProgress


@pytest.fixture
def window(open_window, tmp_path, greedy):
    made = open_window()
    made.levels.play.progress = LevelProgress(tmp_path / "levels.json")

    def rival(document):
        assistant = Assistant(
            document,
            Dispatcher(),
            load=lambda name: name,
            make_search=lambda mesh, *_: greedy(mesh),
        )
        assistant.policy = "greedy"
        return assistant

    made.levels.make_rival = rival
    return made


def click(qtbot, button):
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def in_dialog(act):
    """Call ``act(dialog)`` once a dialog is open."""

    def look():
        dialog = QApplication.activeModalWidget()
        if dialog is None:
            QTimer.singleShot(20, look)
        else:
            act(dialog)

    QTimer.singleShot(20, look)


def solve(window):
    for operation, (a, b) in window.levels.level.solution:
        window.document.submit(operation, window.document.mesh.halfedge(a, b))


def test_a_level_is_chosen_played_by_mouse_and_key_and_won(qtbot, window):
    bar = window.levels.bar
    assert not bar.isVisible()
    in_dialog(lambda dialog: click(qtbot, dialog.cards[0]))
    press_to_choose(qtbot, window)
    assert window.levels.level.name == "one-flip"
    assert bar.isVisible()
    assert (bar.goal.text, bar.par.text, bar.used.text, bar.stars.count) == ("s = 0", "1", "0", 0)
    assert bar.text.text() == window.levels.level.text
    _, (a, b) = window.levels.level.solution[0]
    point_at(qtbot, window, window.document.mesh.halfedge(a, b))
    press(qtbot, window, Qt.Key.Key_F)
    assert bar.used.text == "1"
    assert bar.stars.count == 3
    assert bar.title.text() == "Proven minimum"
    assert "three stars" in bar.text.text()
    click(qtbot, bar.next)
    assert window.levels.level.name == "quarter-turn"
    assert (bar.used.text, bar.stars.count) == ("0", 0)


def press_to_choose(qtbot, window):
    qtbot.keyClick(
        window,
        Qt.Key.Key_L,
        Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier,
    )


def test_undo_and_restart_reduce_the_count(qtbot, window):
    window.levels.open("two-turns")
    bar = window.levels.bar
    solve(window)
    assert bar.stars.count == 3
    window.actions_by_id["undo"].trigger()
    assert bar.used.text == "1"
    assert bar.title.text() == "Two turns"
    click(qtbot, bar.again)
    assert bar.used.text == "0"
    assert len(window.document.history) == 0
    assert bar.stars.count == 3  # won earlier


def test_level_dialog_shows_stars_and_is_navigated_by_keys(qtbot, window):
    window.levels.play.progress.note("one-flip", 2, 3)
    seen = {}

    def look(dialog):
        first, second = dialog.cards[:2]
        seen["stars"] = [card.stars.count for card in dialog.cards]
        seen["names"] = [card.accessibleName() for card in dialog.cards]
        seen["focus"] = dialog.focusWidget() is second
        seen["cut off"] = [
            card.title.text()
            for card in dialog.cards
            if card.title.heightForWidth(card.title.width()) > card.title.height()
        ]
        assert not first.picture.pixmap().isNull()
        qtbot.keyClick(second, Qt.Key.Key_Space)

    in_dialog(look)
    window.levels.choose()
    assert seen["stars"][:2] == [2, 0]
    assert len(seen["stars"]) == len(level.names())
    assert "done in 3, 2 of 3 stars" in seen["names"][0]
    assert seen["focus"] and not seen["cut off"]
    assert window.levels.level.name == "quarter-turn"


def test_escape_leaves_the_dialog_without_a_level(qtbot, window):
    in_dialog(lambda dialog: qtbot.keyClick(dialog, Qt.Key.Key_Escape))
    window.levels.choose()
    assert window.levels.level is None
    assert window.document.empty


def test_forbidden_actions_of_a_level_are_refused_with_a_reason(qtbot, window):
    window.levels.open("three-blocks")
    window.actions_by_id["clean_all"].trigger()
    assert "one by one" in window.status.message
    window.editing.submit("chord_collapse", window.document.mesh.halfedge(0, 1))
    assert "beyond the paper" in window.status.message
    assert len(window.document.history) == 0
    menu = window.selection_tools.menus.of_vertex(0)
    titles = {action.text(): action.isEnabled() for action in menu.actions()}
    assert titles["Locked (not moved or removed)"] is False
    menu.deleteLater()
    window.levels.leave()
    window.actions_by_id["clean_all"].trigger()
    assert "Removed 4 lines" in window.status.message


def test_agent_solves_a_copy_and_shows_its_solution(qtbot, window):
    window.levels.open("two-turns")
    bar = window.levels.bar
    assert not bar.agent.isVisible()
    assert bar.answer.text() == "Ask the agent"
    click(qtbot, bar.answer)
    assert bar.agent.isVisible()
    rival = window.levels.play.rival
    qtbot.waitUntil(lambda: rival.standing is not OpponentState.ASKED, timeout=WAIT)
    assert bar.agent.text.startswith(str(len(rival.operations)))
    assert bar.answer.text() == "Show a solution"
    assert len(window.document.history) == 0
    click(qtbot, bar.answer)
    assert len(window.document.history) == len(rival.operations)
    window.playback.hold()
    window.playback.go_to(len(rival.operations))
    assert "win no stars" in bar.text.text()


def test_leaving_a_level_asks_nothing(qtbot, window, tmp_path, monkeypatch):
    window.files.watch(tmp_path / "autosave")
    monkeypatch.setattr(
        "meshwright.desktop.files.unsaved_work.QuestionDialog", None
    )  # a question would fail the test
    window.levels.open("two-turns")
    solve(window)
    assert not window.isWindowModified()
    window.levels.next()
    assert window.levels.level.name == level.after("two-turns")
    window.files.make("star", "quad")
    assert window.levels.level is None
    assert not window.levels.bar.isVisible()
    assert window.document.name == "star"


def test_starting_a_level_asks_about_unsaved_work(window, star, monkeypatch):
    window.document.replace(star, "star")
    with monkeypatch.context() as patch:
        patch.setattr(window.files, "may_drop", lambda: False)
        window.levels.open("two-turns")
    assert window.levels.level is None
    assert window.document.mesh is star


def test_invalid_level_is_reported(window):
    window.levels.open("no-such-level")
    assert "no level named" in window.notice.text
    assert window.document.empty


def test_level_actions_are_enabled_only_in_a_level(window):
    action = window.actions_by_id
    assert action["levels"].isEnabled()
    assert not action["level.again"].isEnabled()
    window.levels.open(level.names()[-1])
    assert action["level.again"].isEnabled()
    assert not action["level.next"].isEnabled()
    action["level.leave"].trigger()
    assert not action["level.leave"].isEnabled()
    assert not window.levels.bar.isVisible()
    assert not window.document.empty


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_bar_keeps_its_height(qtbot, window, theme):
    window.set_theme(theme)
    heights = set()
    for name in ("two-turns", "three-blocks", "plate"):
        window.levels.open(name)
        heights.add(window.levels.bar.sizeHint().height())
        solve(window)
        heights.add(window.levels.bar.sizeHint().height())
    assert len(heights) == 1


@pytest.mark.needs("window")
@pytest.mark.usefixtures("_own_settings")
def test_the_window_opens_on_a_level(qtbot):
    from meshwright.desktop.main_window.startup import open_window as open_on

    window = open_on(level=level.load("two-turns"))
    qtbot.addWidget(window)
    qtbot.waitUntil(lambda: window.canvas.built, timeout=WAIT)
    assert window.levels.bar.isVisible()
    assert window.document.mesh.score == 6
    window.close()


def test_the_bar_fits_the_smallest_window_after_the_longest_texts(qtbot, window):
    window.resize(window.minimumSize())
    play, bar = window.levels.play, window.levels.bar
    play.open("three-blocks")
    widest = bar.goal.minimumSizeHint().width()
    solve(window)
    play.show_answer()
    window.document.go_to(len(window.document.history))
    assert play.tally.helped and play.headline
    QApplication.processEvents()
    assert bar.title.width() >= bar.title.sizeHint().width()
    play.open("star")
    QApplication.processEvents()
    assert bar.goal.minimumSizeHint().width() < widest
    assert bar.minimumSizeHint().width() <= window.minimumSize().width()
