"""Curved edges and regions in the page: compared with Python's, picked, painted."""

import math
from collections.abc import Iterator
from contextlib import contextmanager

import curved_meshes
import numpy as np
import pytest
from browser import WatchedPage

from meshwright.benchmarks.notebook.widget_driver import Card
from meshwright.graphics.theme import LIGHT, region_fills
from meshwright.notebook import MeshWidget
from meshwright.notebook.protocol.mesh_sync import CoordinateFrame
from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.edge_curves import curved_halfedges, edge_points
from meshwright_core.geometry.quality import Measure, inverted
from meshwright_core.operations.catalogue import of_kind

MESHES = ("disc", "ring", "plate", "insert")
SHARES = np.array([0.0, 0.1, 0.37, 0.5, 0.8, 1.0])

POINTS = """(root, [halfedges, shares]) => {
  const { edgeCurves } = root.meshwright.replica;
  return halfedges.map((h) => shares.map((w) => edgeCurves.get(h).point(w)));
}"""
BENT = """root => {
  const { replica } = root.meshwright;
  const all = [...Array(replica.halfedges).keys()];
  return all.filter((h) => replica.live(h) && replica.edgeCurves.get(h));
}"""
PATH = (
    """(root, [h, tolerance]) => [...root.meshwright.replica.edgeCurves.get(h).path(tolerance)]"""
)
COLOUR = """(root, at) => {
  const place = root.meshwright.view.toScreen(...at);
  const [x, y] = place.map((value) => Math.round(value * devicePixelRatio));
  const pen = root.querySelector("canvas.mw-lower").getContext("2d");
  const channels = [...pen.getImageData(x, y, 1, 1).data.slice(0, 3)];
  return "#" + channels.map((value) => value.toString(16).padStart(2, "0")).join("");
}"""
ZOOM = """(root, [zoom, at]) => {
  const { stage } = root.meshwright;
  stage.fit();
  stage.zoom(zoom, ...stage.view.toScreen(...at));
  stage.paint();
}"""


@contextmanager
def shown(browser, widget: MeshWidget, tmp_path) -> Iterator[Card]:
    """The exported page of a widget, without console errors."""
    path = tmp_path / "film.html"
    widget.to_html(path)
    page = browser.new_page(viewport={"width": 1000, "height": 800})
    try:
        watched = WatchedPage(page)
        page.goto(path.as_uri())
        yield Card(page)
        assert not watched.complaints
    finally:
        page.close()


def normalised(mesh: HalfEdgeMesh, frame: CoordinateFrame, halfedges: list[int]) -> np.ndarray:
    """Python's points of edges at SHARES in the frame of the page, (n, 6, 2)."""
    points = np.array([edge_points(mesh, h, SHARES)[:, :2] for h in halfedges])
    return (points - (frame.cx, frame.cy)) / frame.scale


def require_equal_edges(card: Card, mesh: HalfEdgeMesh, frame: CoordinateFrame) -> None:
    """The page has the same curved half-edges, and their points to 1e-9 of the mesh's size."""
    halfedges = curved_halfedges(mesh).tolist()
    assert card.look(BENT) == halfedges
    if halfedges:
        there = np.array(card.look(POINTS, [halfedges, SHARES.tolist()]))
        np.testing.assert_allclose(there, normalised(mesh, frame, halfedges), atol=1e-9)


def edited(widget: MeshWidget, steps: int, seed: int) -> None:
    """Apply random operations without smoothing."""
    rng = np.random.default_rng(seed)
    widget.auto_smooth = False
    names = [str(info.operation) for info in of_kind(widget.mesh.kind)]
    for _ in range(40 * steps):
        mesh = widget.mesh
        halfedge = mesh.k * int(rng.choice(mesh.element_ids())) + int(rng.integers(mesh.k))
        operation = str(rng.choice(names))
        if widget.check(operation, halfedge):
            widget.apply(operation, halfedge)
        if len(widget.history) == steps:
            return


def doubtful(mesh: HalfEdgeMesh) -> set[int]:
    """Elements with a corner so flat that the page's float32 coordinates do not tell its sign."""
    sines = Measure(mesh).everything().sine.min(axis=1)
    return set(mesh.element_ids()[np.abs(sines) < 2e-5].tolist())


@pytest.mark.parametrize("name", MESHES)
def test_edges_are_those_of_python_in_every_state(browser, tmp_path, name):
    widget = MeshWidget(getattr(curved_meshes, name)())
    frame = CoordinateFrame.of(widget.mesh)
    edited(widget, 8, MESHES.index(name))
    length = len(widget.history)
    assert length
    with shown(browser, widget, tmp_path) as card:
        slider = card.page.get_by_role("slider")
        slider.focus()
        keys = ["Home", *["ArrowRight"] * length, "Home", "End"]
        states = [0, *range(1, length + 1), 0, length]
        for key, state in zip(keys, states, strict=True):
            card.page.keyboard.press(key)
            card.await_head(cursor=state)
            widget.go_to(state)
            require_equal_edges(card, widget.mesh, frame)
            found = card.look("root => root.meshwright.derived.inverted")
            assert len(found) == len(set(found))
            sure = set(widget.mesh.element_ids().tolist()) - doubtful(widget.mesh)
            assert set(found) & sure == set(inverted(widget.mesh).tolist()) & sure


def test_offsets_of_ends_are_blended(browser, tmp_path):
    mesh = curved_meshes.ring()
    mesh.move([4], mesh.points[[4]] * 1.1)
    widget, frame = MeshWidget(mesh), CoordinateFrame.of(mesh)
    with shown(browser, widget, tmp_path) as card:
        halfedges = curved_halfedges(mesh).tolist()
        there = np.array(card.look(POINTS, [halfedges, SHARES.tolist()]))
        np.testing.assert_allclose(there, normalised(mesh, frame, halfedges), atol=2e-7)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-7])
def test_paths_are_within_their_tolerance(browser, tmp_path, tolerance):
    mesh = curved_meshes.ring()
    frame = CoordinateFrame.of(mesh)
    with shown(browser, MeshWidget(mesh), tmp_path) as card:
        for h in curved_halfedges(mesh).tolist():
            path = np.array(card.look(PATH, [h, tolerance])).reshape(-1, 2)
            middles = 0.5 * (path[1:] + path[:-1]) * frame.scale + (frame.cx, frame.cy)
            radius = round(float(np.hypot(*mesh.points[mesh.origin(h), :2])))
            away = np.abs(np.hypot(*middles.T) - radius) / frame.scale
            assert away.max() <= tolerance
            # half of a circle's quarter with the fewest chords, or twice as many
            fewest = math.pi / 2 / math.sqrt(8 * tolerance / (radius / frame.scale))
            assert len(path) <= 4 * fewest + 3


def test_a_point_between_arc_and_chord_belongs_to_the_side_it_is_on(browser, tmp_path):
    mesh = curved_meshes.ring()
    frame = CoordinateFrame.of(mesh)
    with shown(browser, MeshWidget(mesh), tmp_path) as card:

        def point(x: float, y: float) -> int:
            """The half-edge there, 1e4 being far from all."""
            at = [(x - frame.cx) / frame.scale, (y - frame.cy) / frame.scale]
            box = card.root.locator("canvas.mw-upper").bounding_box()
            px, py = card.look("(root, at) => root.meshwright.view.toScreen(...at)", at)
            card.page.mouse.move(box["x"] + px, box["y"] + py, steps=2)
            card.page.wait_for_timeout(60)
            return int(card.look("root => root.dataset.halfedge"))

        assert mesh.target(1) == 5 and mesh.twin(1) < 0
        assert point(0.0, 1.95) == 1  # outside the chord of the outer circle
        assert point(0.0, 1.05) == 3  # inside the element, near the inner circle
        assert point(0.0, 0.75) == -1  # in the hole, between arc and chord
        assert point(0.0, 2.6) == -1
        x, y = card.place(1)
        box = card.root.locator("canvas.mw-upper").bounding_box()
        seen = card.look(
            "(root, at) => root.meshwright.view.toPlane(...at)", [x - box["x"], y - box["y"]]
        )
        radius = math.hypot(seen[0] * frame.scale + frame.cx, seen[1] * frame.scale + frame.cy)
        assert 1.8 < radius < 2.0  # the arrow runs along the arc


def test_the_fill_ends_at_the_arc_at_every_zoom(browser, tmp_path):
    with shown(browser, MeshWidget(curved_meshes.ring()), tmp_path) as card:
        radius = math.sqrt(2.0)  # of the outer circle in the frame of the page
        for zoom in (1.0, 30.0, 1000.0):
            card.look(ZOOM, [zoom, [0.0, radius]])
            card.page.wait_for_timeout(250)
            pixels = card.look("root => root.meshwright.view.pixels")
            for shift in np.linspace(-150.0, 150.0, 23):  # pixels along the circle
                angle = math.pi / 2 + shift / pixels / radius
                for step, inside in ((-2.5, True), (2.5, False)):
                    r = radius + step / pixels
                    colour = card.look(COLOUR, [r * math.cos(angle), r * math.sin(angle)])
                    assert colour == (LIGHT.fill if inside else LIGHT.background), (zoom, shift)


def test_regions_are_tinted_and_named(browser, tmp_path):
    with shown(browser, MeshWidget(curved_meshes.insert()), tmp_path) as card:
        found = [card.look(COLOUR, at) for at in ([0.0, 1.0], [0.0, 0.0])]
        assert found == region_fills(LIGHT, 2)
        for halfedge, name in ((0, "insert"), (4 * 5 + 1, "plate")):
            card.hover(halfedge)
            assert name in card.root.locator(".mw-where").inner_text()


def test_a_straight_mesh_has_no_curved_edges(browser, tmp_path):
    with shown(browser, MeshWidget("l-shape"), tmp_path) as card:
        assert card.look(BENT) == []
        assert card.look("root => root.meshwright.replica.curves.count") == 1
