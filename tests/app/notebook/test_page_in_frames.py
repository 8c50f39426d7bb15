"""The exported HTML page in a sandboxed frame, with markup in its names."""

import json
from html import escape

import pytest
from browser import WatchedPage

from meshwright.document.document import Document
from meshwright.notebook.export.html_page import page as frozen

HOSTILE = '</script><img src=x onerror="window.broken = 1"><script>window.broken = 1</script>'
MESH = """root => {
    const { replica } = root.meshwright;
    const { vertices: v, halfedges: h } = replica;
    return JSON.stringify([replica.head.cursor, [...replica.places.slice(0, 2 * v)],
        [...replica.delta.slice(0, v)], [...replica.flags.slice(0, v)],
        [...replica.origin.slice(0, h)], [...replica.twin.slice(0, h)]]);
}"""


@pytest.fixture
def document(star, greedy) -> Document:
    """A few steps by the user and by an agent, with markup as names, and a global smoothing."""
    document = Document(star, HOSTILE)
    runner = greedy(star, bad_steps=3, longest=6)
    while not runner.finished:
        for operation, halfedge in runner.step():
            document.submit(operation, halfedge, HOSTILE)
    document.smooth()
    return document


def test_a_sandboxed_frame_shows_the_recording_and_runs_nothing_else(browser, document, tmp_path):
    path = tmp_path / "frame.html"
    text = escape(frozen(document))
    path.write_text(
        f'<iframe sandbox="allow-scripts" width="700" height="700" srcdoc="{text}"></iframe>',
        encoding="utf-8",
    )
    page = browser.new_page(viewport={"width": 760, "height": 740})
    try:
        watched = WatchedPage(page)
        page.goto(path.as_uri())
        frame = page.frame_locator("iframe")
        root, slider = frame.locator(".meshwright"), frame.get_by_role("slider", name="History")
        slider.wait_for()
        end = root.evaluate(MESH)
        states = {}
        slider.focus()
        for key in ("Home", *["ArrowRight"] * 3, "End", "Home"):
            page.keyboard.press(key)
            page.wait_for_timeout(60)
            shown = root.evaluate(MESH)
            assert states.setdefault(json.loads(shown)[0], shown) == shown
        assert states[len(document.history)] == end
        assert set(states) == {0, 1, 2, 3, len(document.history)}
        assert slider.get_attribute("aria-valuetext").startswith("State 0 of ")
        slider.press("ArrowRight")
        words = slider.get_attribute("aria-valuetext")
        assert words.startswith("State 1 of ") and f" by {HOSTILE}" in words
        assert frame.locator("img").count() == 0
        assert root.evaluate("() => window.broken === undefined")
        assert frame.locator("h1").inner_text() == HOSTILE
        page.screenshot(path=tmp_path / "frame.png")
        assert not watched.complaints
    finally:
        page.close()


def test_playback_stops_at_the_end(browser, document, tmp_path):
    path = tmp_path / "film.html"
    frozen(document, "Film", path)
    page = browser.new_page(viewport={"width": 420, "height": 800}, color_scheme="dark")
    try:
        watched = WatchedPage(page)
        page.goto(path.as_uri())
        slider = page.get_by_role("slider", name="History")
        page.get_by_label("Playback speed").select_option("25")
        page.get_by_role("button", name="Play the history").click()
        pause = page.get_by_role("button", name="Pause")
        pause.wait_for()
        last = str(len(document.history))
        page.wait_for_function(
            "last => document.querySelector('[role=slider]').ariaValueNow === last", arg=last
        )
        pause.wait_for(state="detached")
        assert slider.get_attribute("aria-valuemax") == last
        page.screenshot(path=tmp_path / "film.png")
        assert not watched.complaints
    finally:
        page.close()
