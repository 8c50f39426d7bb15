"""The widget in marimo and Chromium."""

from collections.abc import Iterator

import pytest
from browser import Marimo, WatchedPage

from meshwright.benchmarks.notebook import servers
from meshwright.benchmarks.notebook.widget_driver import differing

TURNED = "flip_left"


@pytest.fixture(scope="module")
def _marimo(browser, warm, tmp_path_factory) -> Iterator[Marimo]:
    path = Marimo.write(tmp_path_factory.mktemp("marimo"), "star", TURNED)
    with servers.marimo(path) as server:
        page = browser.new_page(viewport={"width": 1280, "height": 1100}, color_scheme="light")
        yield Marimo(WatchedPage(page), server)


@pytest.fixture
def marimo(_marimo: Marimo) -> Iterator[Marimo]:
    """The star in marimo's editor; the test must cause no console error."""
    _marimo.watched.complaints.clear()
    yield _marimo
    assert not _marimo.watched.complaints


def test_click_changes_the_mesh_in_the_kernel_and_undo_restores_it(marimo, tmp_path):
    card = marimo.card
    card.aside()
    before, picture = marimo.kernel(), card.layer("lower")
    assert before["score"] == card.head["score"] == 12
    empty = card.layer("upper")
    card.hover(before["allowed"][0])
    card.until("root => root.dataset.meant !== ''")
    assert differing(empty, card.layer("upper")) > 50
    card.arm(TURNED)
    card.click(before["allowed"][0])
    card.await_head(cursor=1)
    card.aside()
    card.page.screenshot(path=tmp_path / "marimo.png")
    changed, later = card.layer("lower"), marimo.kernel()
    assert later["cursor"] == 1 and later["elements"] != before["elements"]
    assert later["score"] == card.head["score"]
    assert differing(picture, changed) > 200
    assert marimo.follows == f"s is {later['score']}"
    card.button("Undo").click()
    card.await_head(cursor=0)
    card.aside()
    assert marimo.kernel()["elements"] == before["elements"]
    assert differing(picture, card.layer("lower")) == 0


def test_agent_plays_until_it_is_paused_and_cells_follow(marimo, tmp_path):
    card = marimo.card
    card.agent("Play").click()
    card.until("root => root.meshwright.replica.head.cursor >= 2")
    card.agent("Pause").click()
    card.agent("Resume").wait_for()
    at = marimo.kernel()
    card.await_head(cursor=at["cursor"])
    marimo.page.wait_for_timeout(500)
    assert marimo.kernel()["cursor"] == at["cursor"] == card.head["cursor"]
    assert marimo.follows == f"s is {at['score']}"
    card.page.screenshot(path=tmp_path / "paused.png")


def test_reloaded_page_shows_the_present_mesh(marimo):
    head = marimo.card.head
    marimo.open()
    marimo.card.await_head(cursor=head["cursor"], score=head["score"])


def test_dark_follows_the_notebook(marimo, tmp_path):
    card = marimo.card
    card.aside()
    light = card.picture()
    marimo.page.emulate_media(color_scheme="dark")
    card.until("root => root.dataset.theme === 'dark'")
    marimo.page.wait_for_timeout(200)
    dark = card.picture()
    card.page.screenshot(path=tmp_path / "dark.png")
    marimo.page.emulate_media(color_scheme="light")
    card.until("root => root.dataset.theme === 'light'")
    assert dark.mean() < 90 < 180 < light.mean()


def test_touch_on_a_narrow_screen(browser, warm, tmp_path):
    """``marimo run``: the notebook as an application, on a small touch screen."""
    path = Marimo.write(tmp_path, "star", TURNED)
    with servers.marimo(path, run=True) as server:
        context = browser.new_context(
            viewport={"width": 420, "height": 1400}, has_touch=True, device_scale_factor=2
        )
        try:
            watched = WatchedPage(context.new_page())
            marimo = Marimo(watched, server)
            card, before = marimo.card, marimo.kernel()
            spot = before["allowed"][0]
            marimo.page.touchscreen.tap(*card.place(spot))
            card.until("(root, h) => Number(root.dataset.halfedge) === h", spot)
            card.until("root => Boolean(root.meshwright.hoverState.offers)")
            marimo.page.screenshot(path=tmp_path / "touch.png")
            card.choice(TURNED).tap()
            card.await_head(cursor=1)
            assert marimo.kernel()["elements"] != before["elements"]
            assert not watched.complaints
        finally:
            context.close()
