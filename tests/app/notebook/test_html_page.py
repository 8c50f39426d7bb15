"""The exported HTML page as text; test_frozen_page.py opens it in a browser."""

import json
import re
from base64 import b64decode, b64encode
from hashlib import sha256
from html.parser import HTMLParser

import numpy as np
import pytest
from porting import CURVE_TYPES, PATCH_TYPES, TYPES, patched_slots, whole_slots

from meshwright.document.document import Document
from meshwright.document.timeline import NO_MESH
from meshwright.graphics.export.film import Film
from meshwright.notebook import MeshWidget, bundle
from meshwright.notebook.export.html_page import page
from meshwright.notebook.export.recording import record
from meshwright.notebook.protocol.mesh_sync import CoordinateFrame, SlotArrays
from meshwright_core import MeshError
from meshwright_core.domains import gallery, meshing

HOSTILE = "</script><script>window.broken = 1</script><img src=x onerror='window.broken = 1'>\"&"


@pytest.fixture
def walked(star, greedy) -> Document:
    """The star after some bad steps by the user and some good ones by an agent; two undone."""
    document = Document(star, "star")
    runner = greedy(star, bad_steps=3, longest=9)
    while not runner.finished:
        for operation, halfedge in runner.step():
            document.submit(operation, halfedge, "you" if len(document.history) < 3 else "greedy")
    document.smooth()
    document.go_to(len(document.history) - 2)
    return document


class Parts(HTMLParser):
    """Elements, attributes and texts of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict]] = []
        self.texts: dict[str, str] = {}
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))

    def handle_data(self, data):
        if self.tags and data.strip():
            tag, attributes = self.tags[-1]
            name = attributes.get("id", tag)
            self.texts[name] = self.texts.get(name, "") + data

    def all(self, tag: str) -> list[dict]:
        return [attributes for found, attributes in self.tags if found == tag]


def arrays(message: dict, types: tuple[str, ...]) -> list[np.ndarray]:
    """The arrays of a message in a recording."""
    whole, at, found = b64decode(message["arrays"]), 0, []
    for size, kind in zip(message["sizes"], types, strict=True):
        found.append(np.frombuffer(whole[at : at + size], kind).copy())
        at += size
    assert at == len(whole)
    return found


def replayed(film: dict):
    """The slots of every state, as a browser gets them."""
    types = (*TYPES, *CURVE_TYPES)
    now = whole_slots(film["state"]["content"], arrays(film["state"], types))
    yield now
    for step in film["steps"]:
        content = step["content"]
        if content["type"] == "state":
            now = whole_slots(content, arrays(step, types))
        else:
            now = patched_slots(now, content, arrays(step, PATCH_TYPES))
        yield now


def test_a_recording_holds_every_state_exactly(walked):
    mesh, cursor, revision = walked.mesh, walked.history.cursor, walked.revision
    film, recorded = Film(walked), record(walked)
    assert (walked.mesh, walked.history.cursor, walked.revision) == (mesh, cursor, revision)
    assert recorded["start"] == cursor
    json.dumps(recorded, allow_nan=False)
    film.go_to(0)
    frame, head, revision = (
        CoordinateFrame.of(film.mesh),
        {},
        recorded["state"]["content"]["revision"],
    )
    messages = [recorded["state"], *recorded["steps"]]
    for state, (now, message) in enumerate(zip(replayed(recorded), messages, strict=True)):
        film.go_to(state)
        wanted = SlotArrays.of(film.mesh, frame, len(now.flags), len(now.origin))
        assert now.buffers == wanted.buffers
        content = message["content"]
        if content["type"] == "patch":
            assert content["from"] == revision
        revision = content.get("to", content.get("revision"))
        head |= content["head"]
        assert (head["score"], head["optimum"]) == (film.scores[state], film.optima[state])
        assert (head["cursor"], head["length"]) == (state, len(film.rows))
        assert head["elements"] == film.mesh.n_elements
    assert recorded["track"]["scores"] == film.scores.tolist()
    assert recorded["track"]["by"][1:] == [row.by for row in film.rows]


def test_a_page_is_self_contained(walked, tmp_path):
    path = tmp_path / "film.html"
    text = page(walked, "A star", path)
    assert path.read_text(encoding="utf-8") == text
    parts = Parts(text)
    assert parts.texts["title"] == parts.texts["h1"] == "A star"
    asking = [(tag, a) for tag, a in parts.tags if {"src", "href", "srcset"} & a.keys()]
    assert asking == [] and parts.all("link") == [] and parts.all("iframe") == []
    assert not re.search(r"url\(|@import|\bfetch\(|XMLHttpRequest|WebSocket|\bimport\(", text)
    assert len(parts.all("script")) == 2
    assert json.loads(parts.texts["recording"]) == record(walked)
    assert "It cannot be edited." in parts.texts["p"]


def test_a_page_allows_its_own_script_only(walked):
    text = page(walked)
    policy = next(a["content"] for a in Parts(text).all("meta") if "http-equiv" in a)
    script = re.search(r"<script>(.*?)</script>", text, re.DOTALL).group(1)
    hashed = b64encode(sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{hashed}';" in policy and policy.startswith("default-src 'none'")


def test_script_and_style_cannot_close_their_elements():
    assert "</script" not in bundle.script().lower() and "<!--" not in bundle.script()
    assert "</style" not in bundle.style().lower()


def test_names_are_escaped(star):
    document = Document(star, HOSTILE)
    h = next(h for h in range(40) if star.live(h) and star.check("flip_left", h))
    document.submit("flip_left", h, HOSTILE)
    for title in ("", HOSTILE):
        parts = Parts(page(document, title))
        assert len(parts.all("script")) == 2 and parts.all("img") == []
        assert parts.texts["title"] == parts.texts["h1"] == " ".join(HOSTILE.split())
        recorded = json.loads(parts.texts["recording"])
        assert recorded["state"]["content"]["head"]["name"] == HOSTILE
        assert recorded["track"]["by"] == ["", HOSTILE]


def test_a_title_is_one_line_of_limited_length(star):
    assert Parts(page(Document(star), "a\n  b")).texts["title"] == "a b"
    assert len(Parts(page(Document(star), "a" * 500)).texts["title"]) == 200
    assert Parts(page(Document(star))).texts["title"] == "24 quads"


def test_a_page_without_steps_says_so(star):
    text = page(Document(star, "star"))
    assert f"no steps, s {star.score}, optimum 4" in text
    assert json.loads(Parts(text).texts["recording"])["steps"] == []


def test_sizes_of_pages(star):
    """24 and about 1,000 elements, 50 steps each."""
    wrapping = len(bundle.script()) + len(bundle.style())
    large = meshing.mesh_domain(gallery.shape("l-shape"), "quad", 0.08)
    for mesh, most in ((star, 100_000), (large, 300_000)):
        document, rng = Document(mesh), np.random.default_rng(3)
        while len(document.history) < 50:
            h = int(rng.integers(mesh.k * len(mesh.element_ids())))
            if mesh.live(h) and mesh.check("flip_left", h):
                document.submit("flip_left", h)
        size = len(page(document).encode())
        assert size - wrapping < most


@pytest.mark.parametrize("place", ["no/film.html", "."])
def test_a_page_that_cannot_be_written(walked, tmp_path, monkeypatch, place):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(MeshError) as caught:
        page(walked, path=place)
    assert str(caught.value).startswith(f"{place}: ") and str(caught.value).endswith(".")
    assert list(tmp_path.iterdir()) == []


def test_a_page_without_a_mesh_is_refused():
    with pytest.raises(MeshError, match=re.escape(NO_MESH)):
        page(Document())


def test_a_widget_writes_its_page(walked, tmp_path):
    widget = MeshWidget(walked)
    assert widget.to_html(tmp_path / "film.html", title="Star") == page(walked, "Star")
    widget.close()
