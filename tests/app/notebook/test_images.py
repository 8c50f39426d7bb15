"""Images and animations for notebooks, as bytes and as files."""

import io
import re
import signal
import sys
import xml.etree.ElementTree as ElementTree
from base64 import b64decode
from contextlib import nullcontext
from html.parser import HTMLParser
from types import SimpleNamespace
from urllib.parse import unquote

import pytest
from PIL import Image

from meshwright.document.document import Document
from meshwright.document.timeline import NO_MESH
from meshwright.graphics.export import mimebundle
from meshwright.graphics.theme import theme
from meshwright.notebook import MeshWidget
from meshwright.notebook.export import film_progress, images
from meshwright_core import MeshError
from meshwright_core.domains import gallery, meshing
from meshwright_core.io import mesh_files

SMALL = (160, 120)


@pytest.fixture
def document(star) -> Document:
    """The star after two operations."""
    document = Document(star, "star")
    for _ in range(2):
        h = next(h for h in range(star.k * 20) if star.live(h) and star.check("flip_left", h))
        document.submit("flip_left", h)
    return document


def image_of(html: str) -> dict[str, str]:
    """The attributes of the first image."""
    found = []

    class Parser(HTMLParser):
        def handle_starttag(self, tag, attributes):
            if tag == "img":
                found.append(dict(attributes))

    Parser().feed(html)
    return found[0]


# The picture of a mesh


def test_a_small_mesh_is_svg_with_a_caption(star):
    data, metadata = mimebundle.mimebundle(star)
    image = image_of(data["text/html"])
    assert image["alt"] == f"24 quads, s {star.score}, optimum 4"
    assert (image["width"], image["height"]) == ("480", "360")
    kind, _, text = image["src"].partition(",")
    assert kind == "data:image/svg+xml"
    assert ElementTree.fromstring(unquote(text)).get("width") == "480"
    assert image["alt"] in data["text/html"].partition("<figcaption")[2]
    assert len(data["text/html"]) < 16_000
    assert metadata == {}


def test_a_large_mesh_is_png_at_double_resolution():
    mesh = meshing.mesh_domain(gallery.shape("l-shape"), "quad", 0.08)
    assert 800 < mesh.n_elements < 1200
    html = mimebundle.mimebundle(mesh)[0]["text/html"]
    kind, _, text = image_of(html)["src"].partition(",")
    assert kind == "data:image/png;base64"
    assert Image.open(io.BytesIO(b64decode(text))).size == (960, 720)
    assert len(html) < 120_000


def test_a_name_is_escaped(star):
    name = '</figure><img src=x onerror="alert(1)">\''
    document = Document(star, name)
    data, _ = document._repr_mimebundle_()
    html = data["text/html"]
    assert html.count("<img") == 1 and html.count("</figure>") == 1
    assert image_of(html)["alt"].startswith(name)
    assert data["text/plain"] == repr(star)


def test_an_empty_document_shows_a_sentence():
    assert Document()._repr_mimebundle_() == ({"text/plain": NO_MESH}, {})


def test_a_saved_notebook_keeps_a_picture_beside_the_widget(document):
    widget = MeshWidget(document)
    data, metadata = widget._repr_mimebundle_()
    assert data["application/vnd.jupyter.widget-view+json"]["model_id"] == widget.model_id
    assert Image.open(io.BytesIO(b64decode(data["image/png"]))).size == (960, 720)
    assert metadata["image/png"]["width"] == 480
    assert metadata["image/png"]["alt"] == mimebundle.caption(document.mesh)
    widget.close()


# Pictures and films of a document


def test_pictures_as_bytes_and_as_files(document, tmp_path):
    path = tmp_path / "star.png"
    whole = images.png(document, SMALL, path)
    assert path.read_bytes() == whole
    assert Image.open(io.BytesIO(whole)).size == SMALL
    drawing = images.svg(document, SMALL)
    assert ElementTree.fromstring(drawing).get("height") == "120"
    assert "#121416" in images.svg(document, SMALL, theme="dark")
    assert document.history.cursor == 2


def test_films_as_bytes_and_as_files(document, tmp_path):
    document.go_to(1)
    film = Image.open(io.BytesIO(images.gif(document, 0.1, SMALL)))
    assert film.size == SMALL and film.n_frames == 3
    path = tmp_path / "star.mp4"
    whole = images.mp4(document, path, 0.1, SMALL)
    assert path.read_bytes() == whole and whole[4:8] == b"ftyp"
    assert document.history.cursor == 1


def test_a_widget_exports_the_same(document, tmp_path):
    widget = MeshWidget(document, theme="dark")
    assert widget.to_png(size=SMALL) == images.png(document, SMALL, theme="dark")
    assert widget.to_svg(size=SMALL) == images.svg(document, SMALL, theme="dark")
    assert widget.to_gif(tmp_path / "a.gif", 0.1, SMALL)[:6] == b"GIF89a"
    assert widget.to_mp4(tmp_path / "a.mp4", 0.1, SMALL)[4:8] == b"ftyp"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif", "a.mp4"]
    widget.close()


def test_a_picture_may_show_a_half_edge(document):
    widget = MeshWidget(document)
    h = document.mesh.halfedge(*document.mesh.elements()[3][:2])
    plain, drawn = widget.to_svg(size=(800, 600)), widget.to_svg(size=(800, 600), halfedge=h)
    arrow = theme("light").arrow
    assert drawn.count(arrow) == plain.count(arrow) + 2
    assert widget.to_png(size=SMALL, halfedge=h) != widget.to_png(size=SMALL)
    widget.close()


def test_a_widget_saves_its_history(document, tmp_path):
    widget = MeshWidget(document)
    path = widget.save(tmp_path / "star.meshwright")
    widget.undo()
    assert widget.save() == path
    again = Document()
    again.open(path)
    assert repr(again.history) == repr(document.history)
    widget.save(str(tmp_path / "star.vtk"))
    assert mesh_files.read(tmp_path / "star.vtk").n_elements == document.mesh.n_elements
    widget.close()


def test_a_history_prints_its_steps(document):
    title = document.history.last.title
    assert repr(document.history) == (
        "2 of 2 steps done; s 12 at first\n"
        f"     1  {title}  s {document.history[0].after}  by you\n"
        f"\u2192    2  {title}  s {document.history[1].after}  by you"
    )
    document.undo()
    assert repr(document.history).splitlines()[1].startswith("\u2192    1")
    assert repr(Document().history) == "0 of 0 steps done; s 0 at first"


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda d, at: images.png(d, halfedge=9999), "The mesh has no half-edge 9999"),
        (lambda d, at: images.svg(d, halfedge="a"), "A half-edge is a whole number, not 'a'"),
        (lambda d, at: images.png(d, (0, 100)), "A size is two whole numbers"),
        (lambda d, at: images.png(d, (True, 100)), "A size is two whole numbers"),
        (lambda d, at: images.png(d, "large"), "A size is two whole numbers"),
        (lambda d, at: images.svg(d, (100, 100_000)), "A size is two whole numbers"),
        (lambda d, at: images.gif(d, 0), "A frame lasts between 0 and 60 seconds, not 0"),
        (lambda d, at: images.gif(d, float("nan")), "not nan"),
        (lambda d, at: images.gif(d, "fast"), "not 'fast'"),
        (lambda d, at: images.png(d, theme="pink"), "There is no theme 'pink'"),
        (lambda d, at: images.png(d, path=at / "a.jpg"), "the name must end in .png"),
        (lambda d, at: images.mp4(d, at / "a.gif"), "the name must end in .mp4"),
        (lambda d, at: images.png(d, SMALL, at / "no" / "a.png"), "no does not exist"),
        (lambda d, at: images.png(Document()), re.escape(NO_MESH)),
    ],
)
def test_invalid_exports_raise_one_sentence(document, tmp_path, call, words):
    with pytest.raises(MeshError, match=words) as caught:
        call(document, tmp_path)
    assert str(caught.value).endswith(".") and "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_an_existing_file_is_kept_if_writing_fails(document, tmp_path, monkeypatch):
    path = tmp_path / "star.png"
    path.write_bytes(b"old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("meshwright.graphics.export.export_job.save_picture", full)
    with pytest.raises(MeshError, match=r"star.png: cannot be written \(no space left on device\)"):
        images.png(document, SMALL, path)
    assert path.read_bytes() == b"old" and len(list(tmp_path.iterdir())) == 1
    with pytest.raises(MeshError, match=r"^The image cannot be made \(no space left on device\)"):
        images.png(document, SMALL)


@pytest.mark.parametrize("ending", [".gif", ".mp4"])
def test_an_interrupted_film_leaves_the_file_and_the_mesh_as_they_were(
    document, tmp_path, monkeypatch, ending
):
    widget, path = MeshWidget(document), tmp_path / f"star{ending}"
    export = widget.to_gif if ending == ".gif" else widget.to_mp4
    path.write_bytes(b"before")
    document.go_to(1)
    frames = []

    def report(done, total):
        frames.append(done)
        signal.raise_signal(signal.SIGINT)  # what Jupyter's stop button sends

    monkeypatch.setattr("meshwright.notebook.widget.shown_progress", lambda: nullcontext(report))
    with pytest.raises(KeyboardInterrupt):
        export(path, 0.1, SMALL)
    assert frames == [1]
    assert path.read_bytes() == b"before" and list(tmp_path.iterdir()) == [path]
    assert document.history.cursor == 1 and len(document.history) == 2
    monkeypatch.undo()
    assert export(path, 0.1, SMALL) == path.read_bytes() != b"before"
    widget.close()


def test_the_progress_of_a_film_is_one_line_that_goes_with_the_film(monkeypatch):
    shown = []

    class Handle:
        def update(self, line):
            shown.append(repr(line))

    def display(line, display_id):
        shown.append(repr(line))
        return Handle()

    clock = iter([0.0, 0.1, 0.6, 0.7, 0.9])
    monkeypatch.setattr(film_progress.time, "monotonic", lambda: next(clock))
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: object()))
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=display))

    def make_film():
        with film_progress.shown_progress() as report:
            for frame in range(1, 5):
                report(frame, 2000)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        make_film()
    line = "Film: frame {} of 2,000; interrupt the kernel to stop."
    assert shown == [line.format(2), line.format(4), ""]
    monkeypatch.setitem(sys.modules, "IPython", None)
    with film_progress.shown_progress() as report:
        assert report is None
