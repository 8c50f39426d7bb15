"""What counts in a level, what is won, and what is kept of it."""

import json

import numpy as np
import pytest

from meshwright.assistant.assistant import Assistant
from meshwright.document.document import Document
from meshwright.document.operation_preview import choices
from meshwright.puzzles import level as levels
from meshwright.puzzles.agent_opponent import OpponentState
from meshwright.puzzles.play import LevelPlay, stars, tally
from meshwright.puzzles.progress import Best, LevelProgress, usual_path
from meshwright_core import MeshError


class Playing:
    """A play on a document, with a fake agent, and its messages."""

    def __init__(self, desk, greedy, path):
        self.desk, self.greedy = desk, greedy
        self.document = Document()
        self.assistant = self.assistant_on(self.document)
        self.play = LevelPlay(
            self.document, self.assistant.hinting, self.assistant_on, LevelProgress(path)
        )
        self.won = []
        self.play.won.connect(self.won.append)

    def assistant_on(self, document):
        made = Assistant(
            document,
            self.desk.dispatch,
            load=lambda name: name,
            make_runner=lambda mesh, policy, seed: self.greedy(mesh),
            make_search=lambda mesh, *_: self.greedy(mesh),
            ask=lambda mesh, policy, near: self.greedy(mesh).look().choices[:3],
        )
        made.policy = "greedy"
        return made

    def solve(self, by="you", first=0, last=None):
        for operation, (a, b) in self.play.level.solution[first:last]:
            self.document.submit(operation, self.document.mesh.halfedge(a, b), by=by)

    def waste(self):
        """Two operations that come to nothing."""
        mesh = self.document.mesh
        names = ("flip_left", "flip_right") if mesh.kind == "quad" else ("flip", "flip")
        for halfedge in (mesh.element_ids()[:, None] * mesh.k + range(mesh.k)).flat:
            if mesh.check(names[0], int(halfedge)):
                self.document.submit(names[0], int(halfedge))
                self.document.submit(names[1], int(halfedge))
                return


@pytest.fixture
def playing(desk, greedy, tmp_path):
    made = Playing(desk, greedy, tmp_path / "levels.json")
    yield made
    made.play.release()
    made.assistant.close()


def test_stars_are_three_at_par_two_a_little_above_one_beyond():
    level = levels.load("ell")  # par 6: two more, a third of par
    assert [stars(level, level.par + more) for more in (-1, 0, 1, 2, 3)] == [3, 3, 2, 2, 1]
    assert [stars(level, used, hinted=True) for used in (6, 8, 9)] == [2, 2, 1]
    assert [stars(levels.load("one-flip"), used) for used in (1, 2, 3, 4)] == [3, 2, 2, 1]


@pytest.mark.parametrize("name", levels.names())
def test_every_level_can_be_solved(playing, name):
    play = playing.play
    play.open(name)
    assert (play.used, play.stars, play.done, play.remark) == (0, 0, False, "")
    playing.solve()
    assert play.done
    assert (play.used, play.stars, playing.won) == (play.level.par, 3, [3])
    assert play.headline.startswith(("Proven minimum", "Equal to"))
    assert play.progress.best(name) == Best(3, play.level.par)


def test_undo_takes_operations_back_and_smoothing_is_free(playing):
    play, document = playing.play, playing.document
    play.open("two-turns")
    playing.waste()
    assert play.used == 2
    document.smooth()
    assert play.used == 2
    document.go_to(0)
    assert play.used == 0
    playing.solve()
    assert (play.used, play.stars) == (2, 3)
    document.undo()
    assert (play.used, play.done, play.stars) == (1, False, 0)
    document.redo()
    assert playing.won == [3, 3]


def test_more_operations_win_fewer_stars_and_the_best_is_kept(playing):
    play = playing.play
    play.open("quarter-turn")
    playing.waste()
    playing.solve()
    assert (play.used, play.stars, play.best) == (3, 2, 2)
    assert "par 1: two stars" in play.remark
    play.again()
    playing.waste()
    playing.waste()
    playing.solve()
    assert (play.used, play.stars, play.best) == (5, 1, 2)
    play.again()
    playing.solve()
    assert (play.stars, play.best) == (3, 3)


def test_the_agents_operations_win_no_stars(playing):
    play, document = playing.play, playing.document
    play.open("two-turns")
    playing.solve(by="quad", last=1)
    playing.solve(first=1)
    assert play.done
    assert (play.stars, playing.won) == (0, [])
    assert play.progress.best("two-turns") == Best()
    assert play.remark.startswith("The agent's operations win no stars")
    document.go_to(0)
    assert play.remark == ""


@pytest.mark.parametrize("name", ["two-turns", "ell"])
def test_hints_lead_to_par(playing, desk, name):
    """Taking the first hint again and again solves the level with as few operations as known."""
    play, hinting, document = playing.play, playing.assistant.hinting, playing.document
    play.open(name)
    while not play.done:
        assert play.leads
        playing.assistant.hint()
        desk.until(lambda: bool(hinting.hints))
        first = hinting.hints[0]
        assert first is hinting.guided
        before = document.score
        document.submit(first.operation, first.halfedge)
        assert document.score - before == first.change
    assert play.used == play.level.par


def test_off_the_known_way_the_hints_are_those_of_the_policy(playing, desk):
    play, hinting, document = playing.play, playing.assistant.hinting, playing.document
    play.open("two-turns")
    mesh = document.mesh
    wrong = next(
        h for h in range(mesh.k * mesh.n_elements)
        if mesh.check("split", h) and (play.level.solution[0][0] != "split")
    )  # fmt: skip
    document.submit("split", wrong)
    playing.assistant.hint()
    desk.until(lambda: bool(hinting.hints))
    assert hinting.guided is None and not play.leads
    assert play.remark.endswith("undo to where they lead to par.")
    document.undo()
    assert play.leads


def test_a_hint_costs_a_star(playing, desk):
    play = playing.play
    play.open("two-turns")
    playing.assistant.hint()
    desk.until(lambda: bool(playing.assistant.hinting.hints))
    assert play.hinted
    assert play.remark == "With a hint there are two stars at most."
    playing.solve()
    assert play.stars == 2
    play.again()
    playing.solve()
    assert play.stars == 3


@pytest.mark.parametrize("action", ["desired", "locked", "geometric", "clean_all", "strip"])
def test_steps_that_change_the_task_are_not_allowed(playing, action):
    play, document = playing.play, playing.document
    play.open("three-blocks")
    mesh = document.mesh
    inside = int(np.flatnonzero(~mesh.boundary())[0])
    if action == "desired":
        document.set_desired(inside, 5)
    elif action == "locked":
        document.set_locked(inside, True)
    elif action == "geometric":
        document.set_geometric(inside, True)
    elif action == "clean_all":
        document.clean_all()
    else:
        document.submit("chord_collapse", mesh.halfedge(0, 1))
    assert tally(document.history).barred
    assert "Undo it, or restart." in play.remark
    assert not play.done
    document.undo()
    assert play.remark == ""
    playing.solve()
    assert play.stars == 3


def test_refused_steps_have_reasons(playing):
    assert playing.play.refusal("clean_all") == ""
    playing.play.open("three-blocks")
    assert "one by one" in playing.play.refusal("clean_all")
    assert "beyond the paper" in playing.play.refusal("chord_collapse")
    assert playing.play.refusal("cleanup") == ""


def test_excluded_operations_are_not_offered(playing):
    playing.play.open("notch")
    document = playing.play._document
    offers = {str(c.operation): c for c in choices(document.mesh, 0, document.bar)}
    assert not offers["chord_collapse"].allowed
    assert offers["chord_collapse"].verdict.reason.endswith("not allowed in levels")
    playing.play.leave()
    assert document.bar("chord_collapse") == ""
    playing.play.release()
    assert document.bar is None


def test_headline_for_fewer_operations_than_par(playing, monkeypatch):
    import dataclasses

    play = playing.play
    play.open(dataclasses.replace(levels.load("quarter-turn"), par=2))
    playing.solve()
    assert (play.stars, play.headline) == (3, "Better than the best known")


def test_the_agent_solves_a_copy_of_the_level(playing, desk):
    play = playing.play
    play.open("two-flips")
    changes = []
    play.changed.connect(lambda: changes.append(play.rival))
    play.ask_agent()
    assert play.rival.standing is OpponentState.ASKED
    desk.until(lambda: play.rival.standing is not OpponentState.ASKED)
    assert play.rival.standing is OpponentState.DONE
    assert changes
    assert len(playing.document.history) == 0
    assert play.rival.operations
    output = play.show_answer()
    assert "operation" in output
    assert playing.document.history.cursor == 0
    assert len(playing.document.history) == len(play.rival.operations)
    assert play.remark == ""
    playing.document.redo()
    assert play.tally.helped
    play.next()
    assert play.rival is None


def test_the_stored_solution_is_shown_before_the_agent_has_one(playing):
    play = playing.play
    play.open("two-turns")
    play.show_answer()
    assert len(playing.document.history) == 2
    playing.document.go_to(2)
    assert play.done
    assert (play.stars, playing.won) == (0, [])


def test_a_failed_agent_can_be_started_again(playing, desk, monkeypatch):
    play = playing.play
    play.open("two-turns")

    def failing(document):
        def breaks(mesh, *_):
            raise ValueError("no such policy")

        made = Assistant(document, desk.dispatch, load=lambda name: name, make_search=breaks)
        made.policy = "greedy"
        return made

    monkeypatch.setattr(play, "_make_rival", failing)
    play.ask_agent()
    desk.until(lambda: play.rival.standing is not OpponentState.ASKED)
    assert (play.rival.standing, play.rival.reason) == (OpponentState.FAILED, "no such policy")
    monkeypatch.setattr(play, "_make_rival", playing.assistant_on)
    play.ask_agent()
    desk.until(lambda: play.rival.standing is not OpponentState.ASKED)
    assert play.rival.standing is OpponentState.DONE


def test_levels_follow_each_other_to_the_last(playing):
    play = playing.play
    with pytest.raises(MeshError, match="choose one first"):
        play.again()
    play.open(levels.names()[-2])
    play.next()
    assert play.level.name == levels.names()[-1]
    with pytest.raises(MeshError, match="last level"):
        play.next()


def test_another_mesh_ends_the_level(playing, strip):
    play, document = playing.play, playing.document
    play.open("two-turns")
    assert (document.passing, document.modified) == (True, False)
    playing.solve(last=1)
    assert not document.modified
    document.replace(strip, "strip")
    assert play.level is None
    assert not document.passing


def test_leaving_a_level_keeps_its_mesh(playing):
    play, document = playing.play, playing.document
    play.open("two-turns")
    playing.solve(last=1)
    play.leave()
    assert play.level is None
    assert not document.modified
    document.undo()
    assert document.modified


def test_no_step_of_a_level_is_autosaved(playing, tmp_path):
    from meshwright.document.storage.autosave import Autosave

    autosave = Autosave(playing.document, tmp_path / "autosave")
    playing.play.open("two-turns")
    playing.solve()
    assert autosave.path is None
    playing.play.leave()
    playing.document.undo()
    assert autosave.path is not None
    autosave.close()


def test_progress_is_shared_between_processes(tmp_path):
    path = tmp_path / "deep" / "levels.json"
    one, other = LevelProgress(path), LevelProgress(path)
    assert other.best("ell") == Best()
    assert one.note("ell", 2, 8)
    assert other.note("star", 3, 4)
    assert one.note("ell", 1, 12) is False
    assert LevelProgress(path).best("ell") == Best(2, 8)
    assert LevelProgress(path).best("star") == Best(3, 4)
    assert LevelProgress(path).stars == 5
    assert [file.name for file in path.parent.iterdir()] == ["levels.json"]


@pytest.mark.parametrize(
    "contents",
    [
        "",
        "[]",
        "{",
        '{"version": 2}',
        '{"version": 1, "levels": 3}',
        '{"version": 1, "levels": {"ell": {"stars": 9, "used": 1}}}',
        '{"version": 1, "levels": {"ell": {"stars": "3", "used": 1}}}',
        "\ufeff\x00",
        "[" * 50_000,
    ],
)
def test_a_damaged_file_is_renamed(tmp_path, contents):
    path = tmp_path / "levels.json"
    path.write_text(contents)
    progress = LevelProgress(path)
    assert progress.best("ell") == Best()
    assert "start without stars" in progress.notice
    assert (tmp_path / "levels.broken").read_text() == contents
    progress.note("ell", 3, 6)
    assert json.loads(path.read_text())["levels"] == {"ell": {"stars": 3, "used": 6}}


def test_a_level_can_be_played_when_progress_cannot_be_written(playing, tmp_path):
    (tmp_path / "file").write_text("")
    play = playing.play
    play.progress = LevelProgress(tmp_path / "file" / "levels.json")
    play.open("one-flip")
    playing.solve()
    assert play.stars == 3
    assert "cannot be" in play.notice or "cannot be" in play.progress.notice
    assert play.best == 3


def test_tests_do_not_touch_the_users_progress(monkeypatch, tmp_path):
    monkeypatch.setenv("MESHWRIGHT_STATE_DIR", str(tmp_path))
    assert usual_path() == tmp_path / "levels.json"
