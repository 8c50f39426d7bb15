"""The widget in JupyterLab: Chromium, mouse and keyboard, pixels, a real kernel."""

import json
from pathlib import Path

import block_meshes
import pytest
from browser import Lab

from meshwright.benchmarks.notebook.jupyterlab import PANEL
from meshwright.benchmarks.notebook.widget_driver import MOMENT, Card, differing

SETUP = "import time\nfrom meshwright.notebook import MeshWidget\n"
STAR = SETUP + "widget = MeshWidget('star')\nwidget"
TURNED = "flip_left"
HELPERS = Path(block_meshes.__file__).parent
RESTART = f"async () => {{ {PANEL} await panel.sessionContext.session.kernel.restart(); }}"


@pytest.fixture
def star(lab: Lab) -> Card:
    """A star in quads, s 12 over an optimum of 4, in a cell of its own."""
    return lab.card(STAR)


def test_widget_shows_the_mesh(lab, star, tmp_path):
    star.aside()
    picture = star.picture()
    star.page.screenshot(path=tmp_path / "star.png")
    assert star.head["score"] == lab.ask("widget.score") == 12
    assert star.head["optimum"] == lab.ask("widget.optimum") == 4
    assert len(set(map(tuple, picture[::3, ::3].reshape(-1, 3).tolist()))) > 20
    mesh = star.layer("lower")
    assert (mesh[..., 3] > 0).mean() > 0.05
    assert "12" in star.root.inner_text() and "4" in star.root.inner_text()


def test_hover_previews_an_operation_and_lists_what_is_allowed(lab, star, tmp_path):
    star.aside()
    empty = star.layer("upper")
    spot = lab.spot(TURNED)
    star.hover(spot)
    star.until("root => root.meshwright.hoverState.ghost && root.dataset.meant")
    shown = star.layer("upper")
    star.page.screenshot(path=tmp_path / "hover.png")
    assert differing(empty, shown) > 50
    offers = star.look("root => Object.fromEntries(root.meshwright.hoverState.offers)")
    assert len(offers) == len(star.look("root => root.meshwright.replica.catalogue"))
    for name, row in offers.items():
        assert row["allowed"] == lab.ask(f"bool(widget.check('{name}', {spot}))")
        assert row["allowed"] or row["reason"]
    star.aside()
    star.until("root => root.dataset.meant === ''")
    assert differing(empty, star.layer("upper")) == 0
    assert lab.ask("widget.history.cursor") == 0


def test_click_changes_the_mesh_in_the_kernel_and_undo_restores_it(lab, star, tmp_path):
    star.aside()
    before, picture = lab.elements(), star.layer("lower")
    spot = lab.spot(TURNED)
    star.arm(TURNED)
    star.click(spot)
    star.await_head(cursor=1)
    star.aside()
    changed = star.layer("lower")
    star.page.screenshot(path=tmp_path / "edited.png")
    assert lab.elements() != before
    assert lab.ask("widget.history.cursor") == 1
    assert star.head["score"] == lab.ask("widget.score")
    assert differing(picture, changed) > 200

    star.button("Undo").click()
    star.await_head(cursor=0)
    star.aside()
    assert lab.elements() == before
    assert differing(picture, star.layer("lower")) == 0
    star.button("Redo").click()
    star.await_head(cursor=1)
    star.aside()
    assert lab.elements() != before
    assert differing(changed, star.layer("lower")) == 0


def test_menu_of_a_half_edge_applies_the_chosen_operation(lab, star, tmp_path):
    spot = lab.spot("split")
    star.click(spot)
    star.choice("split").hover()
    star.until("root => root.dataset.meant === 'split'")
    star.page.screenshot(path=tmp_path / "menu.png")
    star.choice("split").click()
    star.await_head(cursor=1)
    assert lab.ask("widget.mesh.n_elements") == 25
    assert lab.ask("widget.history.last.halfedge") == spot
    assert star.root.locator(".mw-popup").count() == 0


def test_two_widgets_on_one_document_stay_synchronised(lab, tmp_path):
    lab.show(
        SETUP + "widget = MeshWidget('star', height=240)\nwidget",
        "other = MeshWidget(widget)\nother",
    )
    first, second = Card(lab.page), Card(lab.page, 1)
    first.aside()
    before = second.picture()
    first.arm(TURNED)
    first.click(lab.spot(TURNED))
    for card in (first, second):
        card.await_head(cursor=1)
    first.aside()
    assert first.revision == second.revision
    assert first.head["score"] == second.head["score"] == lab.ask("other.score")
    assert differing(before, second.picture()) > 200
    lab.page.screenshot(path=tmp_path / "two.png")
    second.button("Undo").click()
    first.await_head(cursor=0)


def test_edits_from_python_are_painted(lab, star):
    star.aside()
    before = star.picture()
    lab.ask("None", f"widget.apply('{TURNED}', {lab.spot(TURNED)})")
    star.await_head(cursor=1)
    assert differing(before, star.picture()) > 200
    lab.ask("None", "widget.undo()")
    star.await_head(cursor=0)


def test_agent_plays_until_it_is_paused(lab, tmp_path):
    star = lab.card(SETUP + "widget = MeshWidget('star', kind='tri')\nwidget")
    star.agent("Play").click()
    star.until("root => root.meshwright.replica.head.cursor >= 2")
    star.agent("Pause").click()
    star.agent("Resume").wait_for()
    at = lab.ask("widget.history.cursor")
    star.await_head(cursor=at)
    star.page.screenshot(path=tmp_path / "paused.png")
    lab.page.wait_for_timeout(600)
    assert lab.ask("widget.history.cursor") == at == star.head["cursor"]
    assert star.head["score"] == lab.ask("widget.score")
    star.agent("Step").click()
    star.await_head(cursor=at + 1)
    assert lab.ask("widget.history.cursor") == at + 1


def test_everything_works_by_keyboard(lab, star, tmp_path):
    before = lab.elements()
    star.aside()
    star.root.locator("[tabindex='0']").first.focus()
    star.press("ArrowDown")
    star.until("root => Number(root.dataset.halfedge) >= 0")
    at = star.look("root => Number(root.dataset.halfedge)")
    walk = ["ArrowRight", "ArrowLeft", *60 * ["ArrowRight", "ArrowRight", "ArrowUp"]]
    for step, key in enumerate(walk):
        if step > 2 and lab.ask(f"bool(widget.check('{TURNED}', {at}))"):
            break
        way = {"ArrowRight": "next", "ArrowLeft": "prev", "ArrowUp": "twin"}[key]
        there = lab.ask(f"widget.mesh.{way}({at})")
        if there >= 0:
            at = there
            star.press(key)
            star.until("(root, h) => Number(root.dataset.halfedge) === h", at)
    star.until("(root, h) => root.innerText.includes(`Half-edge ${h}`)", at)
    key = star.look(
        "(root, name) => root.meshwright.replica.catalogue.find(row => row.operation === name).key",
        TURNED,
    )
    star.page.screenshot(path=tmp_path / "keys.png")
    star.press(key)
    star.await_head(cursor=1)
    assert lab.elements() != before
    star.press("u")
    star.await_head(cursor=0)
    assert lab.elements() == before
    star.press("Shift+U")
    star.await_head(cursor=1)


def test_level_is_solved_by_a_click_and_the_next_one_opens(lab, tmp_path):
    card = lab.card(SETUP + "widget = MeshWidget(level='quarter-turn')\nwidget")
    strip = card.root.locator(".mw-levels")
    strip.wait_for()
    a, b = lab.ask("widget.level.solution[0][1]")
    operation = lab.ask("widget.level.solution[0][0].value")
    card.click(lab.ask(f"widget.mesh.halfedge({a}, {b})"))
    card.choice(operation).click()
    card.await_head(cursor=1, at_optimum=True)
    strip.get_by_role("button", name="Next").wait_for()
    lab.page.wait_for_timeout(400)
    lab.page.screenshot(path=tmp_path / "won.png")
    assert lab.ask("widget.stars") == 3
    strip.get_by_role("button", name="Next").click()
    card.await_head(cursor=0, at_optimum=False)
    lab.page.screenshot(path=tmp_path / "next.png")
    assert lab.ask("widget.level.name") == "two-flips"


WRONG = (
    "go",
    {"do": "dance"},
    {"do": "operate", "operation": "flip_left", "halfedge": True, "ends": [0, 1]},
    {"do": "operate", "operation": "flip_left", "halfedge": 2**31 - 1, "ends": [0, 1]},
    {"do": "operate", "operation": "flip_left", "halfedge": -5, "ends": [0, 1]},
    {"do": "operate", "operation": "__class__", "halfedge": 0, "ends": [0, 1]},
    {"do": "operate", "operation": "flip_left", "halfedge": 0, "ends": [7, 7]},
    {"do": "operate", "operation": "flip_left", "halfedge": 0},
    {"do": "go_to", "cursor": 1e9},
    {"do": "desired", "vertex": 0, "degree": 10**12},
    {"do": "lock", "vertex": 10**6, "on": True},
    {"do": "undo", "twice": True},
    {"do": "policy", "name": "x" * 10_000},
    {"do": "speed", "value": "fast"},
)


def test_malformed_messages_are_refused_with_a_reason(lab, star):
    before = lab.ask("[widget.history.mark, widget.score, widget.mesh.points.tolist()]")
    elements = lab.elements()
    star.look(
        "root => { const link = root.meshwright.link; root.refused = [];"
        " const plain = link.onmessage; link.onmessage = (content, buffers) => {"
        " if (content.type === 'notice') root.refused.push(content); plain(content, buffers); }; }"
    )
    view = star.look("root => root.meshwright.link.view")
    for number, wrong in enumerate(WRONG):
        content = {**wrong, "id": number, "view": view} if isinstance(wrong, dict) else wrong
        star.send(content)
        star.until("(root, count) => root.refused.length >= count", number + 1)
    star.send({"do": "undo", "id": 99, "view": view}, buffers=[8_000_000])
    star.until("(root, count) => root.refused.length >= count", len(WRONG) + 1)
    refused = star.look("root => root.refused")
    assert [row["tone"] for row in refused] == ["refused"] * (len(WRONG) + 1)
    assert all(row["sentence"].endswith((".", "!")) for row in refused)
    assert [row.get("reply") for row in refused[1:-1]] == list(range(1, len(WRONG)))
    assert refused[-1]["reply"] == 99
    assert refused[-1]["sentence"] in star.root.inner_text()
    assert before == lab.ask("[widget.history.mark, widget.score, widget.mesh.points.tolist()]")
    assert lab.elements() == elements
    lab.ask("None", "widget.mesh.validate()")


def test_reloaded_page_shows_the_present_mesh(lab, star, tmp_path):
    star.arm(TURNED)
    star.click(lab.spot(TURNED))
    star.await_head(cursor=1)
    star.aside()
    shown = star.layer("lower")
    lab.save()
    lab.ask("None", f"widget.apply('{TURNED}', {lab.spot(TURNED)})")
    star.await_head(cursor=2)
    star.aside()
    later = star.layer("lower")
    assert differing(shown, later) > 200
    lab.open()
    again = Card(lab.page)
    again.await_head(cursor=2)
    again.aside()
    lab.page.screenshot(path=tmp_path / "again.png")
    assert again.head["score"] == lab.ask("widget.score")
    assert differing(later, again.layer("lower")) < 50
    again.button("Undo").click()
    again.await_head(cursor=1)
    assert lab.ask("widget.history.cursor") == 1


STILLS = f"""() => {{
    {PANEL}
    return [...panel.content.model.cells].flatMap(cell => cell.sharedModel.getOutputs())
        .filter(output => output.data && output.data["image/png"])
        .map(output => output.data["image/png"]);
}}"""
PICTURE = (
    "mimebundle.still(widget.mesh)[0]['image/png']",
    ("from meshwright.graphics.export import mimebundle"),
)


def test_the_picture_in_the_file_follows_the_last_edit(lab, star):
    first = lab.ask(*PICTURE)
    assert lab.page.evaluate(STILLS) == [first]
    star.look("root => { root.same = true; }")
    star.arm(TURNED)
    star.click(lab.spot(TURNED))
    star.await_head(cursor=1)
    lab.page.wait_for_function(f"old => ({STILLS})()[0] !== old", arg=first, timeout=MOMENT)
    changed = lab.ask(*PICTURE)
    assert changed != first
    lab.save()
    cells = json.loads((lab.folder / lab.name).read_text())["cells"]
    [output] = cells[0]["outputs"]
    assert output["data"]["image/png"].strip() == changed
    assert "24 quads" in output["metadata"]["image/png"]["alt"]
    assert star.look("root => root.same")  # the widget was not drawn again
    star.button("Undo").click()
    star.await_head(cursor=0)
    lab.page.wait_for_function(f"old => ({STILLS})()[0] === old", arg=first, timeout=MOMENT)


def test_light_and_dark_follow_the_notebook(lab, star, tmp_path):
    star.aside()
    light = star.picture()
    try:
        lab.theme("Dark")
        star.until("root => root.dataset.theme === 'dark'")
        lab.page.wait_for_timeout(200)
        dark = star.picture()
        star.page.screenshot(path=tmp_path / "dark.png")
    finally:
        lab.theme("Light")
    star.until("root => root.dataset.theme === 'light'")
    lab.page.wait_for_timeout(200)
    assert dark.mean() < 90 < 180 < light.mean()
    assert differing(light, star.picture()) < 50


def test_card_reports_a_restarted_kernel(lab, star):
    lab.page.evaluate(RESTART)
    lab.wait()
    spot = star.look("root => root.meshwright.replica.catalogue.length")  # any half-edge will do
    star.page.mouse.move(*star.place(spot), steps=2)
    notice = star.root.locator(".mw-notice")
    notice.get_by_text("run this cell again").wait_for(timeout=MOMENT)
    star.press("s")
    star.page.wait_for_timeout(1000)  # longer than the card is patient before it speaks of waiting
    assert not star.root.locator(".mw-waiting").is_visible()
    star = lab.card(STAR)
    star.click(spot)
    assert not notice.is_visible()


BENT = (
    "root => { const { replica } = root.meshwright;"
    " return [...Array(replica.halfedges).keys()]"
    ".filter((h) => replica.live(h) && replica.edgeCurves.get(h)); }"
)


@pytest.mark.parametrize("shape", ["filleted-bracket", "plate-with-insert"])
def test_curved_edges_follow_edits_in_the_kernel(lab, shape, tmp_path):
    card = lab.card(
        f"{SETUP}from meshwright_core.geometry.edge_curves import curved_halfedges\n"
        f"widget = MeshWidget({shape!r})\nwidget"
    )
    bent = "curved_halfedges(widget.mesh).tolist()"
    before = card.look(BENT)
    assert before and before == lab.ask(bent)
    card.aside()
    picture = card.layer("lower")
    card.page.screenshot(path=tmp_path / f"{shape}.png")
    spot = lab.spot("global_split")
    card.arm("global_split")
    card.hover(spot)
    card.until("root => root.dataset.meant === 'global_split'")
    card.page.screenshot(path=tmp_path / f"{shape}-hover.png")
    card.click(spot)
    card.await_head(cursor=1)
    assert card.look(BENT) == lab.ask(bent)
    card.button("Undo").click()
    card.await_head(cursor=0)
    card.aside()
    assert card.look(BENT) == before
    assert differing(picture, card.layer("lower")) == 0


RING = f"""{SETUP}import sys
sys.path.insert(0, {str(HELPERS)!r})
from block_meshes import annulus
widget = MeshWidget(annulus(), height=420)
widget"""


def test_blocks_are_shown_and_the_number_of_a_chord_is_changed_by_its_number(lab, tmp_path):
    card = lab.card(RING)
    panel = card.root.locator(".mw-part-blocks")
    box, text = card.root.locator(".mw-check"), "Keep the size of the elements"
    assert box.inner_text() == text
    place, above = box.bounding_box(), card.root.locator(".mw-prefer").bounding_box()
    assert place["width"] > 150
    assert place["y"] >= above["y"] + above["height"]
    panel.get_by_text("Show", exact=True).click()
    card.until("root => root.meshwright.stage.shown.blocks")
    panel.get_by_title("Next chord").click()
    count = panel.get_by_label("Cells across the chord")
    count.click(click_count=3)
    card.page.keyboard.type("17")
    card.page.keyboard.press("Enter")
    card.await_head(cursor=1)
    card.until("root => root.meshwright.stage.shown.blocks?.counts?.includes(17)")
    assert lab.ask("17 in __import__('meshwright').blocks(widget.mesh).counts.tolist()")
    card.page.screenshot(path=tmp_path / "blocks.png")
    panel.get_by_text("Auto", exact=True).click()
    card.await_head(cursor=2)
    card.until("root => !root.meshwright.stage.shown.blocks?.counts?.includes(17)")
    with card.page.expect_download(timeout=MOMENT) as download:
        panel.get_by_text("Export grid").click()
    download.value.save_as(tmp_path / "grid")
    assert "edgeGrading" in (tmp_path / "grid").read_text()
