"""Levels in a notebook: messages and requests."""

import json

import pytest
from porting import Port, script_agent

from meshwright.notebook import MeshWidget
from meshwright.notebook.protocol.level_bridge import LevelBridge
from meshwright.puzzles import level as levels
from meshwright.puzzles.agent_opponent import OpponentState
from meshwright_core import MeshError


@pytest.fixture(autouse=True)
def _own_stars(monkeypatch, tmp_path):
    monkeypatch.setenv("MESHWRIGHT_STATE_DIR", str(tmp_path))


@pytest.fixture
def widget(monkeypatch, greedy):
    script_agent(monkeypatch, greedy)
    made = MeshWidget(level="two-turns")
    yield made
    made.close()


@pytest.fixture
def port(widget):
    made = Port(widget.session)
    made.ask("hello")
    yield made
    made.close()


def level_state(port):
    """The content of the last level message."""
    return port.of("level")[-1]["level"]


def solve(port):
    for operation, (a, b) in port.session.level.solution:
        port.operate(operation.value, port.session.mesh.halfedge(a, b))


def test_a_new_view_gets_the_level(port):
    message = port.of("level")[-1]
    assert [one["name"] for one in message["all"]] == list(levels.names())
    level = message["level"]
    assert (level["name"], level["goal"], level["par"], level["used"]) == ("two-turns", 0, 2, 0)
    assert (level["stars"], level["best_stars"], level["done"]) == (0, 0, False)
    assert level["next"] == levels.after("two-turns")
    assert message["to"] == port.view
    json.dumps(message)


def test_without_a_level_no_level_state_is_sent(monkeypatch, greedy, strip):
    script_agent(monkeypatch, greedy)
    widget = MeshWidget(strip)
    port = Port(widget.session)
    port.ask("hello")
    assert port.of("level") == []
    port.ask("level", action="open", name="two-turns")
    assert "'level' is not available here" in port.sentence
    assert (widget.level, widget.stars) == (None, 0)
    port.close()
    widget.close()


def test_a_level_is_played_to_three_stars(widget, port):
    heard = []
    widget.on("level", heard.append)
    solve(port)
    level = level_state(port)
    assert (level["used"], level["stars"], level["best_stars"], level["done"]) == (2, 3, 3, True)
    assert level["headline"] == "Proven minimum"
    assert "three stars" in level["remark"]
    assert widget.stars == 3
    assert heard == [widget.level]
    stars = {one["name"]: one["stars"] for one in port.of("level")[-1]["all"]}
    assert stars["two-turns"] == 3
    port.ask("undo")
    assert (
        level_state(port)["used"],
        level_state(port)["done"],
        level_state(port)["stars"],
    ) == (1, False, 0)
    assert "all" not in port.of("level")[-1]


def test_again_next_and_open(port):
    solve(port)
    port.ask("level", action="again")
    assert (level_state(port)["used"], level_state(port)["best_stars"]) == (0, 3)
    port.ask("level", action="next")
    assert level_state(port)["name"] == levels.after("two-turns")
    port.ask("level", action="open", name="star")
    assert level_state(port)["goal"] == 4
    assert port.replica.shows(port.session.mesh, port.session.broadcaster.mesh_sync.frame)
    port.ask("level", action="next")
    assert "last level" in port.sentence
    assert level_state(port)["name"] == "star"


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"action": "open", "name": "no-such"}, "no level named"),
        ({"action": "open", "name": 7}, "expected 'str'"),
        ({"action": "open", "name": "x" * 500}, "length <= 200"),
        ({"action": "win"}, "invalid enum value"),
        ({}, "missing required field"),
        ({"action": "again", "stars": 3}, "unknown field"),
    ],
)
def test_malformed_level_requests_are_refused(port, fields, why):
    before = port.session.document.revision
    port.ask("level", **fields)
    assert why in port.sentence
    assert port.session.document.revision == before
    assert port.session.level.name == "two-turns"


def test_requests_outside_the_rules_of_a_level_are_refused(port):
    port.ask("level", action="open", name="three-blocks")
    for word, fields in (
        ("clean_all", {}),
        ("desired", {"vertex": 0, "degree": 4}),
        ("lock", {"vertex": 0, "on": True}),
        ("corner", {"vertex": 6, "on": True}),
    ):
        port.ask(word, **fields)
        assert "level" in port.sentence
    port.operate("chord_collapse", port.session.mesh.halfedge(0, 1))
    assert "not allowed in levels" in port.sentence
    assert len(port.session.document.history) == 0
    port.ask("smooth")
    assert level_state(port)["used"] == 0


def test_a_hint_costs_a_star(widget, port):
    widget.hint()
    assert level_state(port)["hinted"]
    solve(port)
    assert level_state(port)["stars"] == 2


def test_the_agents_steps_earn_no_stars(widget, port):
    widget.complete()
    level = level_state(port)
    assert (level["helped"], level["stars"]) == (True, 0)
    assert "win no stars" in level["remark"]


def test_the_agent_solves_a_copy_of_the_mesh(widget, port):
    play = LevelBridge.of(widget.session).play
    port.ask("level", action="solve")
    assert level_state(port)["rival"]["standing"] == "asked"
    assert widget.session.loop.pump(lambda: play.rival.standing is not OpponentState.ASKED, 20)
    level = level_state(port)
    assert level["rival"]["standing"] == "done"
    assert level["rival"]["used"] == len(play.rival.operations) > 0
    assert level["answered"]
    assert len(widget.history) == 0
    port.ask("level", action="solve")
    assert len(widget.history) == level["rival"]["used"]
    assert widget.history.cursor == 0
    assert "Redo" in port.sentence


def test_a_solution_is_shown_where_the_agent_cannot_play(widget, port):
    port.ask("level", action="open", name="three-blocks")
    assert level_state(port)["answered"]
    port.ask("level", action="solve")
    assert len(widget.history) == 4


def test_a_read_only_view_cannot_change_levels(widget):
    port = Port(widget.session, read_only=True)
    port.ask("hello")
    port.ask("level", action="next")
    assert "read-only" in port.sentence
    assert widget.level.name == "two-turns"
    port.close()


def test_two_widgets_play_the_same_level(widget, port):
    other = MeshWidget(widget)
    second = Port(other.session)
    second.ask("hello")
    solve(second)
    assert level_state(port)["stars"] == level_state(second)["stars"] == other.stars == 3
    second.close()
    other.close()


def test_level_states_are_small_and_sent_on_change_only(port):
    port.operate("flip_left", next(
        h for h in range(48) if port.session.document.check("flip_left", h)
    ))  # fmt: skip
    count = len(port.of("level"))
    assert len(json.dumps(port.of("level")[-1])) < 1500
    port.ask("smooth")
    port.ask("hover", halfedge=3, operation=None)
    assert len(port.of("level")) == count


def test_source_and_level_exclude_each_other(strip):
    with pytest.raises(MeshError, match="A level brings its own mesh"):
        MeshWidget(strip, level="star")
    with pytest.raises(MeshError, match="no level named"):
        MeshWidget(level="stra")


def test_a_closed_widget_with_a_level_leaves_no_references(monkeypatch, greedy):
    script_agent(monkeypatch, greedy)
    widget = MeshWidget(level="two-turns")
    document, play = widget.document, LevelBridge.of(widget.session).play
    play.ask_agent()
    widget.close()
    assert play.rival is None
    document.submit("flip_left", next(h for h in range(48) if document.check("flip_left", h)))
    assert play.used == 0
