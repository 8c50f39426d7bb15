"""The legend of names in the page, and named sides in their colours."""

from contextlib import contextmanager

import numpy as np
from browser import WatchedPage

from meshwright.benchmarks.notebook.widget_driver import Card
from meshwright.document.document import Document
from meshwright.graphics.theme import LIGHT, name_colours
from meshwright.notebook import MeshWidget
from meshwright.notebook.protocol.document_status import DocumentStatus
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.side_names import Names
from meshwright_core.geometry.edge_curves import ends_of

POINTS = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
QUADS = [[0, 1, 4, 3], [1, 2, 5, 4]]
LIST = """root => [...root.querySelectorAll(".mw-names .mw-name")].map((one) => [
  one.textContent, getComputedStyle(one.querySelector(".mw-name-swatch")).backgroundColor])"""
COLOUR = """(root, number) => {
  const { replica, stage, view } = root.meshwright;
  stage.paint();
  const h = replica.head.sides[number][1][0];
  const [a, b] = [2 * replica.origin[h], 2 * replica.target(h)];
  const middle = [0, 1].map((i) => (replica.places[a + i] + replica.places[b + i]) / 2);
  const place = view.toScreen(...middle);
  const [x, y] = place.map((value) => Math.round(value * devicePixelRatio));
  const pen = root.querySelector("canvas.mw-lower").getContext("2d");
  const channels = [...pen.getImageData(x, y, 1, 1).data.slice(0, 3)];
  return "#" + channels.map((value) => value.toString(16).padStart(2, "0")).join("");
}"""


def named() -> HalfEdgeMesh:
    names = Names(
        ("steel", "copper"), np.array([[0, 3], [0, 1], [1, 2]]), ("inlet", "wall", "wall")
    )
    return HalfEdgeMesh.from_elements(POINTS, QUADS, regions=[0, 1], names=names)


def test_half_edges_of_named_sides_are_sent():
    mesh = named()
    sides = DocumentStatus(Document(mesh)).full()["sides"]
    found = {
        name: {frozenset(pair) for pair in ends_of(mesh, np.array(halfedges)).tolist()}
        for name, halfedges in sides
    }
    assert found == {"inlet": {frozenset({0, 3})}, "wall": {frozenset({0, 1}), frozenset({1, 2})}}
    assert DocumentStatus(Document(HalfEdgeMesh.from_elements(POINTS, QUADS))).full()["sides"] == []
    assert DocumentStatus(Document()).full()["sides"] == []


@contextmanager
def shown(browser, widget, tmp_path):
    path = tmp_path / "page.html"
    widget.to_html(path)
    page = browser.new_page(viewport={"width": 1000, "height": 800})
    try:
        watched = WatchedPage(page)
        page.goto(path.as_uri())
        yield Card(page)
        assert not watched.complaints
    finally:
        page.close()


def test_legend_and_colours(browser, tmp_path):
    with shown(browser, MeshWidget(named(), theme="light"), tmp_path) as card:
        rows = card.look(LIST)
        assert [name for name, _ in rows] == ["inlet", "wall", "steel", "copper"]
        assert len({colour for _, colour in rows}) == 4
        colours = name_colours(LIGHT, 2)
        assert card.look(COLOUR, 0) == colours[0]
        assert card.look(COLOUR, 1) == colours[1]


def test_no_legend_without_names(browser, tmp_path):
    widget = MeshWidget(HalfEdgeMesh.from_elements(POINTS, QUADS))
    with shown(browser, widget, tmp_path) as card:
        assert card.look("root => root.querySelector('.mw-names').hidden")
