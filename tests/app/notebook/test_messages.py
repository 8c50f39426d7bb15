"""Malformed requests are refused in one sentence, and leave the mesh unchanged."""

import json
import math

import msgspec
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from porting import Port, allowed

from meshwright.document.document import Document
from meshwright.notebook.protocol.requests import LARGEST, WORDS, RefusedError, parse
from meshwright.notebook.session import Session

GOOD = {
    "hello": {},
    "hover": {"halfedge": -1, "operation": None},
    "operate": {"operation": "flip_left", "halfedge": 3, "ends": [0, 1]},
    "still": {},
    "undo": {},
    "redo": {},
    "smooth": {},
    "untangle": {},
    "clean_all": {},
    "go_to": {"cursor": 0},
    "auto_smooth": {"on": True},
    "desired": {"vertex": 0, "degree": 4},
    "lock": {"vertex": 0, "on": False},
    "corner": {"vertex": 0, "on": False},
    "pin": {"vertex": 0, "on": True},
    "agent": {"action": "pause"},
    "speed": {"value": 4},
    "policy": {"name": "quad"},
    "take_hint": {"index": 0},
    "level": {"action": "again"},
    "blocks": {},
    "chord_count": {"ends": [0, 1], "count": 4},
    "export_blocks": {"ending": ".msh"},
}


def refused(content, buffers=None) -> RefusedError:
    with pytest.raises(RefusedError) as caught:
        parse(content, buffers)
    words = caught.value.sentence
    assert words.endswith(".") and "\n" not in words and len(words) < 300
    return caught.value


def test_every_word_has_an_example_here():
    assert set(GOOD) == set(WORDS)


@pytest.mark.parametrize("word", GOOD)
def test_well_formed_messages_are_parsed(word):
    request = parse({"do": word, "id": 7, "view": "a", **GOOD[word]}, [])
    assert (request.word, request.id, request.view) == (word, 7, "a")
    assert json.loads(msgspec.json.encode(request)) == {
        "do": word,
        "id": 7,
        "view": "a",
        **GOOD[word],
    }


@pytest.mark.parametrize("word", GOOD)
def test_unknown_and_missing_fields_are_refused(word):
    content = {"do": word, "id": 7, "view": "a", **GOOD[word]}
    error = refused({**content, "more": 1})
    assert "'more'" in error.sentence and error.sender.id == 7 and error.sender.view == "a"
    for name in GOOD[word]:
        assert f"'{name}'" in refused({k: v for k, v in content.items() if k != name}).sentence


WRONG = [
    None,
    "x",
    "",
    1.5,
    -7,
    True,
    [],
    [1],
    {},
    [True, False],
    math.nan,
    math.inf,
    2**70,
    "y" * 201,
]


@pytest.mark.parametrize("word", [word for word in GOOD if GOOD[word]])
@pytest.mark.parametrize("value", WRONG, ids=lambda value: str(value)[:12])
def test_wrong_types_are_refused(word, value):
    for name in GOOD[word]:
        content = {"do": word, "id": 7, "view": "a", **GOOD[word], name: value}
        right = (
            (name in ("name", "operation", "ending") and value in ("x", ""))
            or (name == "operation" and word == "hover" and value is None)
            or (word == "chord_count" and name == "count" and value is None)
            or (name == "on" and value is True)
            or (word == "speed" and value == 1.5)
        )
        if right:
            parse(content)
        else:
            assert f"'{name}'" in refused(content).sentence


@pytest.mark.parametrize(
    "content",
    [
        None,
        3,
        "hello",
        ["do", "undo"],
        {},
        {"do": "undo"},
        {"do": "undo", "id": True, "view": "a"},
        {"do": "undo", "id": -1, "view": "a"},
        {"do": "undo", "id": LARGEST + 1, "view": "a"},
        {"do": "undo", "id": 1.0, "view": "a"},
        {"do": "undo", "id": 1},
        {"do": "undo", "id": 1, "view": ""},
        {"do": "undo", "id": 1, "view": 5},
        {"do": "undo", "id": 1, "view": "a" * 201},
        {"do": 5, "id": 1, "view": "a"},
        {"do": ["undo"], "id": 1, "view": "a"},
        {"do": {"undo": 1}, "id": 1, "view": "a"},
        {"do": "__class__", "id": 1, "view": "a"},
        {"do": "UNDO", "id": 1, "view": "a"},
        {"do": "x" * 10**6, "id": 1, "view": "a"},
        {3: 4, "do": "undo", "id": 1, "view": "a"},
        {"do": "undo", "id": 1, "view": "a", **{f"f{i}": i for i in range(10**5)}},
        {"do": "undo", "id": 1, "view": "a", "x" * 10**6: 1},
    ],
    ids=lambda content: str(content)[:40],
)
def test_malformed_envelopes_are_refused(content):
    refused(content)


def test_arrays_are_refused():
    refused({"do": "undo", "id": 1, "view": "a"}, [b"x" * 10**7])


def deep(levels: int):
    value: object = 1
    for _ in range(levels):
        value = [value]
    return value


def test_deep_nesting_is_refused():
    for name in ("halfedge", "ends", "operation"):
        content = {"do": "operate", "id": 1, "view": "a", **GOOD["operate"], name: deep(5000)}
        refused(content)


SHORT = st.text(max_size=8)
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(SHORT, inner, max_size=4),
    max_leaves=8,
)
ODD = st.sampled_from([2**31 - 1, 2**31, "flip_left", "", True, None])
NEARLY = st.integers(-2, 200) | ODD | JSON


@pytest.fixture
def port(star):
    session = Session.of(Document(star, "star"))
    port = Port(session)
    yield port
    port.close()


@settings(
    max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_refused_messages_leave_the_mesh_unchanged(port, data):
    """Random fields: either the message is well formed, or nothing changes."""
    word = data.draw(st.sampled_from([w for w in WORDS if w not in ("agent", "level")]))
    names = [name for name in WORDS[word].__struct_fields__ if name not in ("id", "view")]
    fields = {name: data.draw(NEARLY, label=name) for name in names}
    if data.draw(st.integers(0, 9)) == 0:
        other = st.text(max_size=5).filter(lambda name: name not in ("do", "self"))
        fields[data.draw(other)] = data.draw(JSON)
    document = port.session.document
    before, steps = arrays(port.session.mesh), document.history.given
    port.packets.clear()
    if not port.replica.revision >= 0:
        port.ask("hello")
        port.packets.clear()
    port.ask(word, **fields)
    tones = [notice["tone"] for notice in port.of("notice")]
    assert "failed" not in tones
    if "refused" in tones:
        assert arrays(port.session.mesh) == before and document.history.given == steps
    else:
        assert port.replica.shows(port.session.mesh, port.session.broadcaster.mesh_sync.frame)


def arrays(mesh) -> list[bytes]:
    """The arrays of a mesh as bytes."""
    held = mesh.arrays
    return [
        held.edge.tobytes(),
        held.vertex.tobytes(),
        held.points.tobytes(),
        held.counters.tobytes(),
    ]


@settings(
    max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(content=JSON, buffers=st.none() | st.lists(st.binary(), max_size=2))
def test_any_value_is_answered_with_a_notice(port, content, buffers):
    before = arrays(port.session.mesh)
    port.session.receive(port, content, buffers)
    assert arrays(port.session.mesh) == before
    assert port.packets[-1].content["type"] == "notice"


def test_dead_and_unknown_ids_are_refused(port):
    port.ask("hello")
    mesh = port.session.mesh
    operation, halfedge = allowed(mesh, ("collapse",))
    ends = [mesh.origin(halfedge), mesh.target(halfedge)]
    dead_vertex, dead_half = mesh.origin(halfedge), halfedge
    port.operate(operation, halfedge)
    if mesh.degree()[dead_vertex]:
        dead_vertex = ends[1] if not mesh.degree()[ends[1]] else int(mesh.degree().argmin())
    before = arrays(mesh)
    for asked in (
        {"do": "operate", "operation": operation, "halfedge": dead_half, "ends": ends},
        {"do": "operate", "operation": operation, "halfedge": 10**6, "ends": ends},
        {"do": "operate", "operation": "flip", "halfedge": 4, "ends": ends},
        {"do": "operate", "operation": "__init__", "halfedge": 4, "ends": ends},
        {"do": "hover", "halfedge": dead_half, "operation": None},
        {"do": "hover", "halfedge": 10**6, "operation": None},
        {"do": "lock", "vertex": dead_vertex, "on": True},
        {"do": "corner", "vertex": 10**6, "on": True},
        {"do": "desired", "vertex": dead_vertex, "degree": 4},
        {"do": "go_to", "cursor": 10**6},
        {"do": "take_hint", "index": 0},
        {"do": "policy", "name": "/etc/passwd"},
        {"do": "level", "action": "again"},
    ):
        port.packets.clear()
        port.ask(**asked)
        [notice] = port.of("notice")
        assert notice["tone"] == "refused", asked
        assert notice["to"] == "v" and notice["reply"] > 0
        assert arrays(mesh) == before
        assert len(port.packets) == 1
