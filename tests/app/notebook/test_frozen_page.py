"""The exported HTML page in a browser, without kernel and network."""

import pytest
from browser import WatchedPage

from meshwright.benchmarks.notebook.widget_driver import Card, differing
from meshwright.notebook import MeshWidget


def turn(widget: MeshWidget, times: int) -> None:
    """Apply some operations at different half-edges."""
    for _ in range(times):
        mesh = widget.mesh
        spots = [mesh.k * int(e) + side for e in mesh.element_ids() for side in range(mesh.k)]
        allowed = [h for h in spots if widget.check("flip_left", h)]
        widget.apply("flip_left", allowed[7 * len(widget.history) % len(allowed)])


@pytest.fixture
def widget() -> MeshWidget:
    """The star after five operations, the last of them undone."""
    made = MeshWidget("star")
    turn(made, 5)
    made.undo()
    return made


def test_page_scrubs_in_both_directions_without_a_kernel(browser, widget, tmp_path):
    path = tmp_path / "film.html"
    page_text = widget.to_html(path, title="A star")
    assert path.read_text(encoding="utf-8") == page_text
    context = browser.new_context(viewport={"width": 1000, "height": 800}, offline=True)
    try:
        asked: list[str] = []
        page = context.new_page()
        page.on("request", lambda request: asked.append(request.url))
        watched = WatchedPage(page)
        page.goto(path.as_uri())
        card = Card(page)
        assert card.head["cursor"] == 4 and card.head["length"] == 5
        assert card.head["score"] == widget.score
        page.screenshot(path=tmp_path / "frozen.png")
        slider = page.get_by_role("slider")
        pictures = {4: card.layer("lower")}
        scores = {4: card.head["score"]}
        slider.focus()
        for key, state in (("ArrowLeft", 3), ("Home", 0), ("End", 5), ("ArrowLeft", 4)):
            page.keyboard.press(key)
            card.await_head(cursor=state)
            shown = card.layer("lower")
            if state in pictures:
                assert differing(pictures[state], shown) == 0
            assert all(differing(shown, other) for at, other in pictures.items() if at != state)
            pictures[state], scores[state] = shown, card.head["score"]
        for state, score in scores.items():
            widget.go_to(state)
            assert widget.score == score

        box = slider.bounding_box()
        page.mouse.move(box["x"] + box["width"] - 20, box["y"] + box["height"] / 2)
        page.mouse.down()
        page.mouse.move(box["x"] + 60, box["y"] + box["height"] / 2, steps=6)
        page.mouse.up()
        card.await_head(cursor=0)
        assert differing(pictures[0], card.layer("lower")) == 0
        assert card.root.get_by_role("button", name="Undo").count() == 0
        assert page.get_by_role("button", name="To the start").is_visible()
        page.emulate_media(media="print")  # on paper nothing can be pressed
        page.screenshot(path=tmp_path / "paper.png")
        assert not [one for one in page.locator("button, select").all() if one.is_visible()]
        assert card.root.is_visible()
        assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
        assert not watched.complaints
    finally:
        context.close()


def test_page_of_a_mesh_without_a_history(browser, tmp_path):
    path = tmp_path / "still.html"
    MeshWidget("l-shape").to_html(path)
    page = browser.new_page(viewport={"width": 420, "height": 900}, color_scheme="dark")
    try:
        watched = WatchedPage(page)
        page.goto(path.as_uri())
        card = Card(page)
        assert card.head["length"] == 0
        assert card.picture().mean() < 90
        page.screenshot(path=tmp_path / "still.png")
        assert not watched.complaints
    finally:
        page.close()
