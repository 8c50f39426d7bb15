"""Pictures of experiments, in files and in notebooks: small multiples, blocks, policy views."""

from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from meshwright.document.document import Document
from meshwright.experiments import Picture, block_view, compare, policy_view, small_multiples
from meshwright.experiments.template_figure import layout, slot_of_corner
from meshwright.graphics.export.film import Film
from meshwright.graphics.theme import DARK, LIGHT
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.domains import gallery, meshing


def star(kind: str = "quad") -> HalfEdgeMesh:
    return meshing.mesh_domain(gallery.shape("star"), kind)


@pytest.fixture(scope="module")
def film() -> Film:
    return compare("l-shape", ["quad"], rollouts=2).film("quad")


def test_small_multiples_have_data_and_a_picture() -> None:
    meshes = [star(), meshing.mesh_domain(gallery.shape("cross"), "quad"), star("tri")]
    grid = small_multiples([*meshes, Document(star()), "square"], columns=2)
    assert grid.scores.tolist()[:3] == [mesh.score for mesh in meshes]
    assert grid.optima.tolist()[:3] == [mesh.optimum for mesh in meshes]
    assert len(grid) == len(grid.rows) == 5 and grid.columns == 2
    assert grid.elements[2] == meshes[2].n_elements
    assert ElementTree.fromstring(grid.to_svg()).tag.endswith("svg")


def test_small_multiples_of_a_film(film: Film) -> None:
    before = film.state
    grid = small_multiples(film, every=3)
    assert grid.scores.tolist() == film.scores[film.stops(3)].tolist()
    assert grid.titles[0] == "start" and film.state == before
    assert small_multiples([film], titles=["end"]).scores.tolist() == [film.mesh.score]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"items": []}, "1 to 400 meshes, not 0"),
        ({"items": "star"}, "a list of meshes"),
        ({"items": 3}, "a list of meshes"),
        ({"items": [star(), 3]}, "cannot be made of int"),
        ({"items": [star()], "titles": ["a", "b"]}, "1 meshes, but 2 titles"),
        ({"items": [star()], "columns": 0}, "columns is a whole number"),
    ],
)
def test_wrong_arguments_of_small_multiples_are_refused(
    given: dict[str, object], words: str
) -> None:
    with pytest.raises(MeshError, match=words):
        small_multiples(**given)  # type: ignore[arg-type]


def pictures() -> list[Picture]:
    mesh = star()
    return [
        compare(mesh, ["quad", "quad-paper"], rollouts=2, steps=5),
        small_multiples([mesh]),
        block_view(mesh),
        policy_view(mesh, "quad-paper"),
    ]


def test_pictures_in_light_and_dark_and_in_notebooks(tmp_path: Path) -> None:
    for picture in pictures():
        light, dark = picture.to_png(scale=1.0), picture.to_png(theme="dark", scale=1.0)
        size = picture.drawing().size
        for content, theme in ((light, LIGHT), (dark, DARK)):
            image = Image.open(BytesIO(content))
            assert image.size == size
            corner = "#{:02x}{:02x}{:02x}".format(*image.convert("RGB").getpixel((0, 0)))
            assert corner == theme.background
        html = picture._repr_html_()
        assert html.count("<svg") == 1 and "var(--mw-background,#fafaf8)" in html
        assert 'data-jp-theme-light="false"' in html and "prefers-color-scheme" in html
        assert "nan" not in html
        path = tmp_path / "picture.svg"
        assert picture.to_svg(path) == path.read_text(encoding="utf-8")
        with pytest.raises(MeshError, match="no theme"):
            picture.to_svg(theme="pink")
        with pytest.raises(MeshError, match="scale"):
            picture.to_png(scale=0)


def test_block_view_has_all_blocks() -> None:
    view = block_view(meshing.mesh_domain(gallery.shape("square-with-hole"), "quad"))
    assert len(view) == len(view.rows) == len(view.grids)
    assert sum(row["elements"] for row in view.rows) == view.mesh.n_elements
    assert repr(view).startswith(f"{len(view)} blocks: ")
    with pytest.raises(MeshError, match="Only quad meshes"):
        block_view(star("tri"))


@pytest.mark.parametrize("policy", ["quad", "quad-paper", "tri", "tri-paper"])
def test_policy_view_agrees_with_mesh_and_template(policy: str) -> None:
    mesh = star(policy.split("-")[0])
    view = policy_view(mesh, policy)
    assert view.probabilities.sum() == pytest.approx(1.0)
    assert view.rows[0]["halfedge"] == view.halfedge
    assert view.rows[0]["probability"] == view.probabilities.max()
    assert [row["operation"] for row in view.choices] == [o.value for o in view.operations]
    for row in view.choices:
        assert (row["reason"] == "") == row["allowed"]
        assert row["allowed"] or row["probability"] == 0.0
    # the template begins with the element of the half-edge, and reads its vertices
    k = mesh.k
    first = view.halfedge - view.halfedge % k
    assert set(view.slots[:k].tolist()) == set(range(first, first + k))
    assert set(view.template[:, 0].tolist()) == set(view.vertices[view.vertices >= 0].tolist())
    assert set(view.vertices[:k].tolist()) == set(mesh.elements()[first // k].tolist())
    known = view.vertices >= 0
    assert view.delta[known].tolist() == mesh.irregularity()[view.vertices[known]].tolist()


def test_policy_view_at_a_given_half_edge() -> None:
    view = policy_view("l-shape", "quad", 5)
    assert view.halfedge == 5 and 5 in view.halfedges
    for wrong in (-1, True, 2.5, "a"):
        with pytest.raises(MeshError, match="A half-edge is a whole number"):
            policy_view("l-shape", "quad", wrong)  # type: ignore[arg-type]
    with pytest.raises(MeshError, match="There is no half-edge 9999 in this mesh"):
        policy_view("l-shape", "quad", 9999)
    with pytest.raises(MeshError, match="this policy is for triangles"):
        policy_view("l-shape", "tri")


@pytest.mark.parametrize(("k", "elements"), [(3, 1), (3, 4), (3, 10), (4, 1), (4, 5), (4, 17)])
def test_template_layout_is_counter_clockwise_without_overlaps(k: int, elements: int) -> None:
    plan = layout(k, elements)
    x, y = np.moveaxis(plan.corners, -1, 0)
    ahead = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    assert ((x * ahead[1] - ahead[0] * y).sum(axis=1) > 0).all()
    assert plan.own.sum() == k + (k - 2) * (elements - 1)
    slots = {slot_of_corner(k, e, i) for e in range(elements) for i in range(k)}
    assert slots == set(range(k * elements))
    # no overlaps: the middle of an element lies in no other
    for e, middle in enumerate(plan.corners.mean(axis=1)):
        ends = np.roll(plan.corners, -1, axis=1)
        side = ends - plan.corners
        to = middle - plan.corners
        inside = (side[..., 0] * to[..., 1] - side[..., 1] * to[..., 0] > 0).all(axis=1)
        assert np.flatnonzero(inside).tolist() == [e]
