"""Objects of PyVista, trimesh, meshio and shapely: the guide's examples, names, and refusals."""

import re
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
import shapely
import trimesh

import meshwright as mw
from meshwright_core import MeshError
from meshwright_core.core.side_names import Names
from meshwright_core.errors import FileWarning

GUIDE = Path(__file__).parents[3] / "docs" / "python_objects.md"

POINTS = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], float)
QUADS = np.array([[0, 1, 4, 3], [1, 2, 5, 4]])


@pytest.fixture
def two_quads() -> mw.HalfEdgeMesh:
    names = Names(("steel", "copper"), np.array([(0, 1), (1, 4)]), ["wall; hot", "joint"])
    return mw.HalfEdgeMesh.from_elements(POINTS, QUADS, regions=[0, 1], names=names)


def test_the_examples_of_the_guide_run():
    text = GUIDE.read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) == 5
    names: dict[str, object] = {}
    for number, block in enumerate(blocks):
        exec(compile(block, f"{GUIDE.name}, example {number + 1}", "exec"), names)


def sides(mesh: mw.HalfEdgeMesh) -> dict[str, list[list[int]]]:
    return {name: np.sort(ends, axis=1).tolist() for name, ends in mesh.sides().items() if name}


@pytest.mark.parametrize("library", ["pyvista", "meshio"])
def test_names_come_back(library, two_quads):
    made = getattr(two_quads, f"to_{library}")()
    again = mw.mesh(made)
    assert again.region_names == two_quads.region_names
    assert sides(again) == {"wall; hot": [[0, 1]], "joint": [[1, 4]]}
    assert again.geometric().tolist() == two_quads.geometric().tolist()
    assert again.desired().tolist() == two_quads.desired().tolist()


def test_names_come_back_from_trimesh(two_quads):
    again = mw.mesh(two_quads.to_trimesh())
    assert again.kind == "tri"
    assert set(again.region_names) == {"steel", "copper"}
    assert sides(again) == {"wall; hot": [[0, 1]], "joint": [[1, 4]]}


def test_shapely_has_regions_and_sides_by_name(two_quads):
    made = two_quads.to_shapely()
    assert {name: shape.area for name, shape in made.regions.items()} == {
        "steel": 1.0,
        "copper": 1.0,
    }
    assert made.sides["joint"].length == 1.0
    assert made.outline.equals(shapely.box(0, 0, 2, 1))


def test_an_unstructured_grid_with_materials():
    grid = pyvista.Plane(i_resolution=2, j_resolution=2).cast_to_unstructured_grid()
    grid.cell_data["material"] = [1, 1, 2, 2]
    grid.point_data["height"] = np.zeros(9)
    with pytest.warns(FileWarning, match="UnstructuredGrid: Point data 'height' is not kept"):
        mesh = mw.mesh(grid)
    assert mesh.n_elements == 4
    assert mesh.region_names == ("material=1", "material=2")


def test_gmsh_groups_of_meshio():
    source = meshio.Mesh(
        POINTS,
        [("line", [[0, 1], [1, 2]]), ("quad", QUADS)],
        cell_data={"gmsh:physical": [np.array([4, 4]), np.array([7, 8])]},
        field_data={"wall": np.array([4, 1]), "steel": np.array([7, 2])},
    )
    mesh = mw.mesh(source)
    assert mesh.region_names == ("steel", "8")
    assert sides(mesh) == {"wall": [[0, 1], [1, 2]]}
    assert mesh.boundary_info.tags == {(2, "steel"): 7, (2, "8"): 8, (1, "wall"): 4}


def test_a_path_with_an_arc_keeps_its_curve():
    arc = trimesh.path.entities.Arc([1, 2, 0])
    line = trimesh.path.entities.Line([0, 1])
    path = trimesh.path.Path2D([line, arc], np.array([[-1, 0], [1, 0], [0, 1]], float))
    mesh = mw.mesh(path, kind="tri")
    kinds = {piece.kind for some in mesh.boundary_info.pieces for piece in some}
    assert kinds == {"line", "arc"}


@pytest.mark.parametrize(
    "source",
    [
        pyvista.PolyData(),
        pyvista.ImageData(dimensions=(3, 3, 3)),
        meshio.Mesh(POINTS, [("tetra", [[0, 1, 2, 4]])]),
        trimesh.PointCloud([[0, 0, 0]]),
        shapely.Point(0, 0),
        (POINTS, np.array([[0, 1, 9]])),
        object(),
    ],
    ids=lambda one: type(one).__name__,
)
def test_what_is_no_mesh_is_refused_in_a_sentence(source):
    with pytest.raises(MeshError) as caught:
        mw.mesh(source)
    text = str(caught.value)
    assert text.strip()
    assert "\n" not in text


@pytest.mark.parametrize("library", ["pyvista", "trimesh", "meshio", "shapely"])
def test_a_missing_library_is_named(library, two_quads, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MeshError, match=f"needs the package {library}, which is not installed"):
        getattr(two_quads, f"to_{library}")()


def test_the_accessor_of_pyvista():
    from meshwright.sources import pyvista_plugin

    assert any(one.name == "meshwright" for one in pyvista.registered_accessors())
    plane = pyvista.Plane(i_resolution=2, j_resolution=2)
    assert isinstance(plane.meshwright, pyvista_plugin.MeshwrightAccessor)
    assert plane.meshwright.mesh().n_elements == 4


def test_a_project_as_polydata(tmp_path, two_quads):
    from meshwright.sources.pyvista_plugin import read_project

    mw.Document(two_quads).save(tmp_path / "two.meshwright")
    made = read_project(str(tmp_path / "two.meshwright"))
    assert made.n_cells == 2
    assert list(made.field_data["side_names"]) == ["wall; hot", "joint"]


SQUARES = QUADS.tolist()
TRIANGLES = [[0, 1, 4], [0, 4, 3]]


@pytest.mark.parametrize(
    "cells",
    [
        SQUARES,
        np.array(SQUARES, float),
        {"quad": SQUARES},
        [("quad", np.array(SQUARES))],
        [("quad", SQUARES[:1]), ("quad", SQUARES[1:])],
    ],
    ids=["list", "floats", "dict", "pairs", "two blocks"],
)
def test_points_and_cells_in_all_forms(cells):
    mesh = mw.mesh((POINTS, cells))
    assert mesh.elements().tolist() == SQUARES
    assert mesh.points.tolist() == np.asarray(POINTS, float).tolist()


def test_points_in_another_plane_are_edited_in_it():
    turned = np.asarray(POINTS, float)[:, [0, 2, 1]]
    with pytest.warns(FileWarning, match="is edited in that plane"):
        mesh = mw.mesh((turned, SQUARES))
    assert np.array_equal(mesh.points_in_space(), turned)


def test_mixed_cells_become_quads():
    for source in (
        (POINTS, [*TRIANGLES, SQUARES[1]]),
        meshio.Mesh(POINTS, [("triangle", TRIANGLES), ("quad", SQUARES[1:])]),
    ):
        with pytest.raises(MeshError, match="It mixes 2 triangles and 1 quad"):
            mw.mesh(source)
        with pytest.warns(FileWarning, match="2 triangles are joined in 1 pair"):
            assert mw.mesh(source, to_quads=True).elements().shape == (2, 4)


def test_a_part_of_several_blocks():
    one = pyvista.Plane(i_resolution=2, j_resolution=2)
    blocks = pyvista.MultiBlock([one, one.translate((5, 0, 0))])
    with pytest.warns(FileWarning, match="There are 2 parts"):
        assert mw.mesh(blocks).n_elements == 8
    found = mw.mesh(blocks, part="2")
    assert (found.n_elements, found.points[:, 0].min()) == (4, 4.5)


def test_a_scene_of_trimesh():
    flat = trimesh.Trimesh(POINTS, TRIANGLES, process=False)
    scene = trimesh.Scene()
    scene.add_geometry(flat)
    scene.add_geometry(flat, transform=trimesh.transformations.translation_matrix([7, 0, 0]))
    with pytest.warns(FileWarning, match="There are 2 parts"):
        mesh = mw.mesh(scene)
    assert (mesh.n_elements, mesh.points[:, 0].max()) == (4, 8)


def test_several_polygons():
    left, right = shapely.box(0, 0, 1, 1), shapely.box(1, 0, 2, 1)
    mesh = mw.mesh([left, right])
    assert len(mesh.region_names) == 2
    apart = shapely.MultiPolygon([left, shapely.box(5, 0, 6, 1)])
    with pytest.raises(MeshError, match="2 separate outlines"):
        mw.mesh(apart)
    assert mw.mesh(apart, region="2").points[:, 0].min() == 5
    assert mw.mesh(apart, region="all").points[:, 0].max() == 6
