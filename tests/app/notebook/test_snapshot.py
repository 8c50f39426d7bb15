"""What a saved notebook shows while no kernel runs: the snapshot, in Python and in the page."""

import json

import pytest
from browser import WatchedPage
from porting import Port

from meshwright.benchmarks.notebook.widget_driver import Card, differing
from meshwright.document.document import Document
from meshwright.graphics.export import mimebundle
from meshwright.notebook import MeshWidget, bundle
from meshwright.notebook.export import snapshot as snapshots
from meshwright.notebook.export.snapshot import snapshot


def edit(widget: MeshWidget, times: int = 1) -> None:
    for _ in range(times):
        mesh = widget.mesh
        halfedge = next(h for h in range(4 * mesh.n_elements) if widget.check("split", h))
        widget.apply("split", halfedge)


def test_the_snapshot_follows_the_last_edit():
    widget = MeshWidget("star")
    assert widget.snapshot == {}
    widget.session.catch_up()  # the cell ends
    assert widget.snapshot["start"] == 0
    edit(widget, 3)
    widget.undo()
    assert widget.snapshot["start"] == 0
    widget.session.catch_up()
    kept = widget.snapshot
    assert (kept["start"], len(kept["steps"])) == (2, 3)
    assert kept["track"]["scores"][2] == widget.score
    assert json.loads(json.dumps(widget.get_state()["snapshot"])) == json.loads(json.dumps(kept))
    widget.session.catch_up()
    assert widget.snapshot is kept  # nothing has changed
    widget.close()


def test_all_widgets_of_a_document_keep_it():
    first = MeshWidget("star")
    second = MeshWidget(first)
    edit(first)
    first.session.catch_up()
    assert second.snapshot == first.snapshot != {}
    first.close()
    second.close()


def test_large_histories_and_meshes_are_left_out(monkeypatch):
    widget = MeshWidget("star")
    edit(widget, 3)
    document: Document = widget.document
    assert len(snapshot(document)["steps"]) == 3
    monkeypatch.setattr(snapshots, "FILM_STEPS", 2)
    still = snapshot(document)
    assert still["steps"] == [] and still["track"]["scores"] == [widget.score]
    assert len(document.history) == 3
    monkeypatch.setattr(snapshots, "MOST_ELEMENTS", 10)
    assert snapshot(document) == {}
    assert snapshot(Document()) == {}
    widget.close()


def test_pages_that_ask_for_it_get_the_picture_after_each_change():
    widget = MeshWidget("star")
    first, second = Port(widget.session, "a"), Port(widget.session, "b", read_only=True)
    edit(widget)
    widget.session.catch_up()
    assert not first.of("still") and not second.of("still")  # nobody has asked
    [answer] = second.ask("still")
    assert answer["model_id"] == "model of b"
    assert answer["image"] == mimebundle.still(widget.mesh)[0]["image/png"]
    assert answer["metadata"]["alt"].startswith("25 quads")
    edit(widget)
    widget.session.catch_up()
    later = first.of("still")[-1]
    assert later["image"] == mimebundle.still(widget.mesh)[0]["image/png"] != answer["image"]
    widget.session.catch_up()
    assert len(first.of("still")) == 2  # nothing has changed
    for port in (first, second, widget):
        port.close()


PAGE = """async ([module, snapshot]) => {
  const address = URL.createObjectURL(new Blob([module], { type: "text/javascript" }));
  const { default: widget } = await import(address);
  const traits = { height: 400, theme: "light", snapshot, seen: 0 };
  const sent = [], listeners = {};
  window.kernel = { sent, tell: (content, buffers) => listeners["msg:custom"](content, buffers) };
  const model = {
    get: (name) => traits[name], set: () => {}, save_changes: () => {}, off: () => {},
    on: (name, call) => { listeners[name] = call; }, send: (message) => sent.push(message),
  };
  widget.render({ model, el: document.getElementById("cell") });
}"""


@pytest.fixture
def page(browser):
    made = browser.new_page(viewport={"width": 900, "height": 700})
    made.set_content(f"<style>{bundle.style()}</style><div id='cell'></div>")
    yield made
    made.close()


def test_a_page_without_a_kernel_shows_the_last_state_and_plays_the_history(page):
    widget = MeshWidget("star")
    edit(widget, 3)
    widget.session.catch_up()
    watched = WatchedPage(page)
    page.evaluate(PAGE, [bundle.module(), widget.snapshot])
    card = Card(page)
    card.await_head(cursor=3)
    assert card.head["score"] == widget.score
    last = card.layer("lower")
    slider = page.get_by_role("slider")
    slider.focus()
    page.keyboard.press("Home")
    card.await_head(cursor=0)
    assert differing(last, card.layer("lower")) > 0
    page.locator(".mw-notice-text", has_text="No kernel is running").wait_for()
    assert [message["do"] for message in page.evaluate("kernel.sent")] == ["hello"]
    assert not watched.complaints
    widget.close()


def test_an_answer_of_the_kernel_ends_the_snapshot(page):
    widget = MeshWidget("star")
    widget.session.catch_up()
    page.evaluate(PAGE, [bundle.module(), widget.snapshot])
    card = Card(page)
    card.await_head(cursor=0)
    assert page.evaluate("document.querySelector('.meshwright').meshwright.readOnly")
    edit(widget)
    sync = widget.session.broadcaster.mesh_sync
    sync.reset(widget.mesh)
    packet = sync.state()
    status = widget.session.broadcaster.status
    status.reset()
    content = {**packet.content, "head": status.full(), "catalogue": [], "read_only": False}
    page.evaluate(
        """([content, buffers]) => kernel.tell(
             content, buffers.map((bytes) => new DataView(new Uint8Array(bytes).buffer)))""",
        [content, [list(bytes(buffer)) for buffer in packet.buffers]],
    )
    card.await_head(cursor=1)
    assert not page.evaluate("document.querySelector('.meshwright').meshwright.readOnly")
    widget.close()
