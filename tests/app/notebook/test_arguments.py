"""Invalid arguments to the widget: one sentence, no change, no connection left."""

import gc

import numpy as np
import pytest

from meshwright.document.document import Document
from meshwright.notebook import MeshWidget
from meshwright.notebook.session import Session
from meshwright_core import MeshError

WRONG = [
    (lambda w: w.apply("flip_lef", 4), "did you mean flip_left"),
    (lambda w: w.check(None, 4), "There is no operation None"),
    (lambda w: w.check("flip_left", 1.5), "half-edge must be a whole number, not 1.5"),
    (lambda w: w.apply("flip_left", 2**70), "no half-edge"),
    (lambda w: w.go_to("1"), "step must be a whole number"),
    (lambda w: w.set_desired(10**6, 4), "no vertex 1000000"),
    (lambda w: w.set_desired(0.5, 4), "vertex must be a whole number"),
    (lambda w: w.set_desired(0, 101), "from 1 to 100, not 101"),
    (lambda w: w.lock("a"), "vertex must be a whole number"),
    (lambda w: w.corner(10**6), "no vertex 1000000"),
    (lambda w: w.play(speed="fast"), "speed must be a number above 0, not 'fast'"),
    (lambda w: w.play(speed=float("nan")), "speed must be a number above 0"),
    (lambda w: w.play(3), "A policy must be a name or a file"),
    (lambda w: w.complete("long"), "seconds must be a number above 0, not 'long'"),
    (lambda w: w.on("score", None), "callable, not None"),
]


@pytest.fixture
def widget(star):
    made = MeshWidget(star)
    yield made
    made.close()


@pytest.mark.parametrize(("call", "words"), WRONG)
def test_invalid_arguments_raise_one_sentence_and_change_nothing(widget, call, words):
    before, speed = widget.mesh.arrays.points.tobytes(), widget.assistant.speed
    with pytest.raises(MeshError) as caught:
        call(widget)
    assert words in str(caught.value) and "\n" not in str(caught.value)
    assert widget.mesh.arrays.points.tobytes() == before and len(widget.history) == 0
    assert widget.assistant.speed == speed and not widget.assistant.running


@pytest.mark.parametrize(
    ("source", "options", "words"),
    [
        (None, {}, "There is nothing to show"),
        (" ", {}, "There is nothing to show"),
        (np.array([[0, 0], [np.nan, 0], [4, 3]]), {}, "not a finite place"),
        (np.array([[0, 0], [4j, 0], [4, 3]]), {}, "pairs of numbers"),
        (Document(), {"policy": "quad"}, "There is no mesh yet"),
        ("star", {"policy": 3}, "A policy must be a name or a file, not 3."),
        (None, {"level": 3}, "A level must be the name of one, not 3."),
        (None, {"level": "two-turns", "kind": "tri"}, "leave source and kind out"),
    ],
)
def test_invalid_constructor_arguments(source, options, words, recwarn):
    with pytest.raises(MeshError) as caught:
        MeshWidget(source, **options)
    assert words in str(caught.value) and "\n" not in str(caught.value)
    del caught
    gc.collect()
    assert not recwarn.list


@pytest.mark.parametrize("options", [{"policy": "nobody"}, {"height": 3}, {"name": 5}])
def test_a_failed_constructor_leaves_no_connection_to_the_document(star, options):
    document = Document(star)
    with pytest.raises(Exception, match=r"nobody|height|label"):
        MeshWidget(document, **options)
    assert id(document) not in Session._all
    widget = MeshWidget(document)
    assert widget.session.broadcaster.ports == [widget]
    widget.close()


def test_policy_files(widget, tmp_path):
    from importlib.resources import files

    whole = (files("meshwright_assets") / "policies" / "quad.safetensors").read_bytes()
    path = tmp_path / "mine.safetensors"
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(MeshError, match=r"mine\.safetensors: this policy file is cut off\."):
        MeshWidget(widget, policy=path)
    path.write_bytes(whole)
    other = MeshWidget(widget, policy=path)
    assert other.assistant.policy == str(path)
    other.close()


def test_the_run_after_an_interrupt_is_complete(widget, monkeypatch, greedy):
    """Without an event loop, as in a plain Python shell."""
    from porting import script_agent

    script_agent(monkeypatch, greedy)
    pump = widget.session.loop.pump

    def interrupted(until, timeout=None):
        raise KeyboardInterrupt

    monkeypatch.setattr(widget.session.loop, "pump", interrupted)
    with pytest.raises(KeyboardInterrupt):
        widget.play(wait=True)
    assert not widget.assistant.running
    monkeypatch.setattr(widget.session.loop, "pump", pump)
    widget.play(wait=True)
    assert widget.at_optimum
