"""The assistant with a scripted policy: no Qt, no torch."""

import subprocess
import sys
import threading
from dataclasses import replace

import pytest

from meshwright.assistant import result_walk
from meshwright.assistant.assistant import Assistant, State
from meshwright.assistant.outcome import shape_wanted
from meshwright.assistant.progress import RunProgress
from meshwright.assistant.run import AgentRun
from meshwright.assistant.search_runner import Effort, ShapeGoal
from meshwright.document.document import Document


@pytest.fixture
def make(desk, greedy):
    made = []

    def build(
        document, load=lambda name: name, patient=False, make_runner=None, ask=None, **options
    ):
        def search(mesh, policy, seed, effort, enough, progress):
            """Find what the greedy run finds; a patient one then waits for the request to stop."""
            found = greedy(mesh, **options)
            progress(1, mesh.optimum)
            if patient:
                assert enough.wait(20)
            return found

        assistant = Assistant(
            document,
            desk.dispatch,
            load=load,
            make_runner=make_runner or (lambda mesh, policy, seed: greedy(mesh, **options)),
            make_search=search,
            ask=ask or (lambda mesh, policy, near: greedy(mesh).look().choices[:5]),
        )
        assistant.policy = "greedy"
        assistant.heard = []
        assistant.message.connect(assistant.heard.append)
        assistant.failed.connect(assistant.heard.append)
        made.append(assistant)
        return assistant

    yield build
    for assistant in made:
        assistant.close()
    threads = [t for t in threading.enumerate() if t.name.startswith("assistant")]
    for thread in threads:
        thread.join(10)
        assert not thread.is_alive()


def test_step_records_the_policy_as_author(make, desk, star):
    document = Document(star)
    assistant = make(document)
    assistant.step()
    assert assistant.state is State.STEPPING
    assert document.history.cursor == 0  # nothing happens before the document's thread has time
    desk.until(lambda: not assistant.running)
    assert document.history.cursor == 1
    assert document.history.last.by == "greedy"
    assert assistant.progress.decisions == 1
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert assistant.progress.decisions == document.history.cursor == 2


def test_the_runner_is_reused_unless_the_user_has_edited(make, desk, star, greedy):
    document = Document(star)
    runners = []

    def make_runner(mesh, policy, seed):
        runners.append(greedy(mesh))
        return runners[-1]

    assistant = make(document, make_runner=make_runner)
    for _ in range(2):
        assistant.step()
        desk.until(lambda: not assistant.running)
    assert len(runners) == 1
    document.undo()
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert len(runners) == 2
    assert document.history.cursor == 2


def test_an_edit_discards_the_runner_of_a_played_run(make, desk, star, greedy):
    document = Document(star)
    runners = []

    def make_runner(mesh, policy, seed):
        runners.append(greedy(mesh))
        return runners[-1]

    assistant = make(document, make_runner=make_runner)
    assistant.speed = 0.2
    assistant.play()
    desk.until(lambda: document.history.cursor == 1)
    document.undo()  # the run waits for its next turn: its runner is ahead of the document now
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert len(runners) == 2
    assert document.history.cursor == 1


def test_a_search_reaches_the_optimum(make, desk, star):
    document = Document(star)
    assistant = make(document)
    assistant.search()
    assert assistant.state is State.SEARCHING
    desk.until(lambda: not assistant.running)
    assert assistant.state is State.IDLE
    assert document.at_optimum
    assert document.normalised_return == 1.0
    assert "At the optimum after" in assistant.heard[-1]
    star.validate()


def test_an_end_at_the_optimum_tells_what_is_wanting(make, desk, star, monkeypatch):
    goal = ShapeGoal(0.1, 0.5)
    monkeypatch.setattr(ShapeGoal, "of", lambda mesh, effort: goal)
    document = Document(star)
    assistant = make(document)
    assistant.search(Effort(seconds=1.0, prefer="shape"))
    desk.until(lambda: not assistant.running)
    assert document.at_optimum and assistant.unfinished
    assert shape_wanted(goal) == "shape .10 of the .50 wanted"
    assert assistant.outcome.endswith(", at the optimum, but shape .10 of the .50 wanted: go on?")
    # the policy has nothing left to do there, but a search goes on
    assistant.play()
    assert assistant.heard[-1].startswith("Already at the optimum") and not assistant.running
    assistant.search(Effort(seconds=1.0, prefer="shape", until_done=True))
    assert assistant.running
    desk.until(lambda: not assistant.running)


def test_nothing_is_searched_where_the_optimum_and_the_shape_are_reached(make, desk, star):
    document = Document(star)
    assistant = make(document)
    assistant.search()
    desk.until(lambda: not assistant.running)
    effort = Effort(prefer="blocks", until_done=True)
    assistant.search(effort)
    assert not assistant.running
    assert "is as good as was asked for" in assistant.heard[-1]
    assistant.search(replace(effort, beyond=True))
    assert assistant.running
    desk.until(lambda: not assistant.running)


def test_the_shape_that_a_search_has_reached_is_part_of_its_progress(star):
    progress = RunProgress()
    run = AgentRun(State.SEARCHING, "p", 0, None, 1.0, False, effort=Effort(until_done=True))
    progress.begin(run, True, score=20, optimum=12)
    assert progress.share == 0.0
    assert progress.found(3, 16) and progress.share == 0.5
    assert progress.found(3, 12, ShapeGoal(0.25, 0.5)) and progress.share == 0.75
    assert not progress.found(3, 12, ShapeGoal(0.25, 0.5))
    assert progress.found(3, 12, ShapeGoal(0.5, 0.5)) and progress.share == 1.0


def test_a_search_reports_its_best_and_applies_it_when_stopped(make, desk, star):
    document = Document(star)
    assistant = make(document, patient=True)
    assistant.search(Effort(seconds=60.0))
    desk.until(lambda: assistant.progress.best is not None)
    assert assistant.progress.best < document.score and document.history.cursor == 0
    assistant.stop()
    assert assistant.running  # what it has found is still to be done
    desk.until(lambda: not assistant.running)
    assert document.history.cursor > 0


def test_a_search_stopped_twice_or_disturbed_does_nothing(make, desk, star):
    document = Document(star)
    assistant = make(document, patient=True)
    assistant.search()
    assistant.stop()
    assistant.stop()
    assert assistant.state is State.IDLE and document.history.cursor == 0
    assistant.search()
    document.set_locked(0, True)  # a person took over
    assert assistant.state is State.IDLE
    assistant.close()
    desk.work()
    assert document.score == 12


def test_play_pause_and_go_on(make, desk, star):
    document = Document(star)
    assistant = make(document, longest=100, bad_steps=100)
    assistant.speed = 60
    assistant.play()
    desk.until(lambda: document.history.cursor >= 3)
    assistant.pause()
    assert assistant.state is State.PAUSED
    kept = document.history.cursor
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert document.history.cursor == kept + 1
    assistant.play()
    desk.until(lambda: document.history.cursor >= kept + 3)
    rows = [row for row in document.history if row.action != "untangle"]
    assert assistant.progress.decisions == len(rows)
    assistant.cancel()
    assert assistant.state is State.IDLE


def test_a_slow_play_is_cancelled_at_once(make, desk, star):
    document = Document(star)
    assistant = make(document)
    assistant.speed = 0.5
    assistant.play()
    desk.until(lambda: document.history.cursor == 1)
    assistant.cancel()
    assistant.step()  # does not wait for the two seconds of the run before
    desk.until(lambda: document.history.cursor == 2, seconds=1.5)


def test_an_edit_by_the_user_ends_the_run(make, desk, star):
    document = Document(star)
    assistant = make(document, longest=100, bad_steps=100)
    assistant.speed = 60
    assistant.play()
    desk.until(lambda: document.history.cursor >= 2)
    document.set_locked(0, True)
    assert assistant.state is State.IDLE
    kept = document.history.cursor
    desk.work()
    assert document.history.cursor == kept  # late decisions are dropped, what was done stays
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert document.history.cursor == kept + 1
    star.validate()


def test_another_mesh_ends_the_run(make, desk, star, triangles):
    document = Document(star)
    assistant = make(document, longest=100, bad_steps=100)
    assistant.search()
    document.replace(triangles, "star")
    assert not assistant.running
    desk.work()
    assert document.history.cursor == 0


def test_nothing_to_do(make, desk, strip, star):
    assistant = make(Document(strip))
    assistant.search()
    assert not assistant.running
    assert "optimum" in assistant.heard[-1]
    assistant = make(Document())
    assistant.step()
    assert not assistant.running
    assert assistant.heard == ["There is no mesh to work on."]
    assistant = make(Document(star))
    assistant.policy = ""
    assistant.step()
    assert assistant.heard == ["Choose a policy."]


def test_a_policy_that_cannot_be_loaded_is_reported(make, desk, star):
    def load(name):
        raise ValueError("greedy.safetensors is cut off.")

    assistant = make(Document(star), load=load)
    assistant.search()
    assert assistant.loading
    desk.until(lambda: not assistant.running)
    assert assistant.heard == ["greedy.safetensors is cut off."]
    assert assistant.state is State.IDLE
    assert not assistant.loading


def test_an_unexpected_error_in_a_runner_is_reported(make, desk, star, monkeypatch, greedy):
    monkeypatch.setattr(greedy, "step", lambda self: 1 / 0)
    assistant = make(Document(star))
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert "ZeroDivisionError" in assistant.heard[-1]


def test_a_runner_in_another_state_than_the_mesh_is_detected(make, desk, star, greedy, monkeypatch):
    monkeypatch.setattr(greedy, "step", lambda self: [("flip_left", 10**6)])
    document = Document(star)
    assistant = make(document)
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert "refused" in assistant.heard[-1]
    assert document.history.cursor == 0


def test_prepare_loads_without_running(make, desk, star):
    loaded = []
    assistant = make(Document(star), load=lambda name: loaded.append(name) or name)
    assistant.prepare()
    assert assistant.loading
    desk.until(lambda: not assistant.loading)
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert loaded == ["greedy"]


def hinted(assistant, desk):
    desk.until(lambda: not assistant.hinting.asking)
    return assistant.hinting.hints


def test_hints_hold_until_the_document_changes(make, desk, star):
    document = Document(star)
    assistant = make(document)
    received = []
    assistant.hinting.changed.connect(lambda: received.append(assistant.hinting.hints))
    assistant.hint()
    assert assistant.hinting.asking and assistant.hinting.hints == ()
    hints = hinted(assistant, desk)
    assert 1 <= len(hints) <= 5 and received == [hints]
    assert assistant.state is State.IDLE and document.history.cursor == 0
    document.submit(hints[0].operation, hints[0].halfedge)
    assert document.history.last.change == hints[0].change
    assert assistant.hinting.hints == () and received[-1] == ()


def test_a_hint_that_comes_too_late_is_dropped(make, desk, star):
    document = Document(star)
    assistant = make(document)
    assistant.hint()
    document.set_locked(0, True)
    assert not assistant.hinting.asking
    assistant.close()
    desk.work()
    assert assistant.hinting.hints == ()


def test_a_hint_pauses_a_played_run_but_not_a_search(make, desk, star):
    document = Document(star)
    assistant = make(document, longest=100, bad_steps=100)
    assistant.speed = 60
    assistant.play()
    desk.until(lambda: document.history.cursor >= 2)
    assistant.hint()
    assert assistant.state is State.PAUSED
    assert hinted(assistant, desk)
    assistant = make(Document(star.copy()), patient=True)
    assistant.search()
    assistant.hint()
    assert assistant.state is State.SEARCHING and not assistant.hinting.asking


def test_failed_hints_are_reported(make, desk, star):
    def ask(mesh, policy, near):
        raise ValueError("This policy is for other meshes.")

    assistant = make(Document(star), ask=ask)
    assistant.hint()
    assert hinted(assistant, desk) == ()
    assert assistant.heard == ["This policy is for other meshes."]
    assistant = make(Document(star), ask=lambda *_: (), longest=0)
    assistant.hint()
    assert hinted(assistant, desk) == ()
    assert "no allowed operation" in assistant.heard[-1]


def test_the_insight_shows_the_next_decision(make, desk, star):
    document = Document(star)
    assistant = make(document)
    assistant.watch = True
    desk.until(lambda: assistant.insight is not None)
    assert assistant.state is State.IDLE and document.history.cursor == 0
    for count in (1, 2):
        wanted = assistant.insight.wanted
        assistant.step()
        desk.until(lambda: not assistant.running)
        assert document.history.cursor == count
        assert document.history.last.halfedge == wanted.halfedge
        assert assistant.insight.wanted is not wanted
    assistant.watch = False
    assert assistant.insight is None
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert assistant.insight is None


def test_the_insight_follows_edits(make, desk, star):
    document = Document(star)
    assistant = make(document)
    assistant.watch = True
    desk.until(lambda: assistant.insight is not None)
    seen = []
    assistant.insight_changed.connect(lambda: seen.append(assistant.insight))
    choice = assistant.insight.choices[0]
    document.submit(choice.operation, choice.halfedge)
    assert assistant.insight is None
    desk.until(lambda: assistant.insight is not None)
    document.undo()
    desk.until(lambda: assistant.insight is not None)
    assert [insight is None for insight in seen] == [True, False, True, False]


def test_pausing_a_watched_run_keeps_its_next_decision(make, desk, star):
    document = Document(star)
    assistant = make(document, longest=100, bad_steps=100)
    assistant.speed = 60
    assistant.watch = True
    assistant.play()
    desk.until(lambda: document.history.cursor >= 3)
    assistant.pause()
    wanted = assistant.insight.wanted
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert document.history.last.halfedge == wanted.halfedge
    assistant.cancel()
    desk.work()
    assert not assistant.running


def test_progress_of_runs_and_searches(make, desk, star):
    document = Document(star)
    assistant = make(document)
    assert assistant.progress.share is None and assistant.progress.best is None
    assistant.speed = 60
    assistant.play()
    desk.until(lambda: document.history.cursor >= 2)
    assert assistant.progress.best == document.best_score and assistant.progress.elapsed > 0
    assistant.pause()
    held = assistant.progress.elapsed
    assert assistant.progress.elapsed == held
    document.undo()
    assistant = make(document, patient=True)
    assistant.search(Effort(rollouts=4, seconds=None))
    desk.until(lambda: assistant.progress.rollouts == 1)
    assert assistant.progress.share == 0.25 and not assistant.stopping
    assistant.stop()
    assert assistant.stopping
    desk.until(lambda: not assistant.running)
    assert assistant.progress.share is None


def test_a_chosen_policy_is_used_once_it_is_loaded(make, desk, star):
    def load(name):
        if "bad" in name:
            raise ValueError(f"{name}: this is no policy file.")
        return name

    document = Document(star)
    assistant = make(document, load=load)
    assistant.choose("/somewhere/mine.safetensors")
    assert assistant.loading and assistant.policy == "greedy"
    desk.until(lambda: not assistant.loading)
    assert assistant.policy == "/somewhere/mine.safetensors"
    assistant.step()
    desk.until(lambda: not assistant.running)
    assert document.history.last.by == "mine"
    assistant.choose("bad.safetensors")
    desk.until(lambda: not assistant.loading)
    assert assistant.policy == "/somewhere/mine.safetensors"
    assert assistant.heard[-1] == "bad.safetensors: this is no policy file."


def test_an_exiting_program_does_not_wait_for_a_run():
    """A worker waits until its decision is applied, but must end with the program."""
    code = """if True:
        import time
        from meshwright.assistant.assistant import Assistant
        from meshwright.document.document import Document
        from meshwright_core.domains import gallery, meshing

        class Runner:
            finished, reason = False, ""
            look = staticmethod(lambda: None)
            step = staticmethod(lambda: [("flip_left", 0)])

        mesh = meshing.mesh_domain(gallery.shape("star"), "quad")
        calls = []
        assistant = Assistant(
            Document(mesh), calls.append, lambda name: name, lambda *_: Runner()
        )
        assistant.policy = "any"
        assistant.play()
        while len(calls) < 2:
            time.sleep(0.01)
        raise SystemExit(3)
    """
    done = subprocess.run([sys.executable, "-c", code], timeout=60, check=False)
    assert done.returncode == 3


def test_the_first_hint_is_the_next_step(make, desk, star):
    document = Document(star)
    assistant = make(document)
    for _ in range(2):
        assistant.hint()
        desk.until(lambda: bool(assistant.hinting.hints))
        first = assistant.hinting.hints[0]
        assert first is assistant.hinting.next_step
        pairs = [(hint.operation, hint.halfedge) for hint in assistant.hinting.hints]
        assert len(set(pairs)) == len(pairs)
        assistant.step()
        desk.until(lambda: not assistant.running)
        assert document.history.last.halfedge == first.halfedge
        assert document.history.last.action == first.operation.value


def test_a_search_that_ends_above_the_optimum_asks_to_go_on(make, desk, star):
    document = Document(star)
    assistant = make(document, longest=1)
    assistant.search(Effort(seconds=1.0))
    desk.until(lambda: not assistant.running)
    above = document.score - document.optimum
    assert above and assistant.unfinished
    assert assistant.outcome == f"Out of steps, {above} above the optimum: go on?"
    assert assistant.outcome == assistant.heard[-1]
    seen = []
    assistant.changed.connect(lambda: seen.append(assistant.unfinished))
    document.set_locked(0, True)
    assert not assistant.unfinished and not assistant.outcome
    assert seen[-1:] == [False]


def test_stop_on_the_way_to_a_result_stops_at_once(make, desk, star, monkeypatch):
    monkeypatch.setattr(result_walk, "SLICE", -1.0)
    monkeypatch.setattr(result_walk, "LONGEST", -1.0)
    document = Document(star)
    assistant = make(document)
    assistant.search()
    desk.until(lambda: assistant.state is State.GOING and document.history.cursor == 1)
    assert assistant.progress.way[0] == 1 < assistant.progress.way[1]
    assistant.stop()
    assert assistant.state is State.IDLE and document.history.cursor == 1
    assert "Stopped after 1 of" in assistant.heard[-1]
    document.go_to(len(document.history))
    assert document.at_optimum


def test_skip_goes_to_the_result_at_once(make, desk, star, monkeypatch):
    monkeypatch.setattr(result_walk, "SLICE", -1.0)
    monkeypatch.setattr(result_walk, "LONGEST", -1.0)
    document = Document(star)
    assistant = make(document)
    assistant.search()
    desk.until(lambda: assistant.state is State.GOING and document.history.cursor == 1)
    assistant.skip()
    assert assistant.state is State.IDLE and document.at_optimum
    desk.work()
    assert document.at_optimum


def test_counts_of_a_run_are_forgotten_with_its_mesh(make, desk, star, triangles):
    document = Document(star)
    assistant = make(document)
    assistant.step()
    desk.until(lambda: not assistant.running)
    document.replace(triangles)
    assert assistant.progress.decisions == 0 and assistant.progress.best is None
