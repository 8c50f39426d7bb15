"""What may be named where a mesh is wanted, and the names of the package ``meshwright``."""

import json
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

import meshwright
import meshwright_core
from meshwright.document.document import Document
from meshwright.sources.resolve import domain, mesh, resolve
from meshwright_core import MeshError
from meshwright_core.domains import gallery


def test_each_kind_of_source_becomes_a_mesh(tmp_path):
    path = tmp_path / "star.vtk"
    meshwright_core.write(path, mesh("star", "tri"))
    polygon = tmp_path / "square.json"
    polygon.write_text(json.dumps({"outline": [[0, 0], [2, 0], [2, 2], [0, 2]]}))
    corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
    assert mesh("star").kind == "quad"
    assert mesh(gallery.shape("l-shape"), "tri", max_edge=0.3).n_elements > 20
    assert mesh(np.array(corners)).n_elements == mesh(corners).n_elements
    assert mesh(str(path)).n_elements == mesh(path, "tri").n_elements
    assert mesh(polygon, "tri").kind == "tri"


def test_a_mesh_is_copied():
    given = mesh("star")
    made = mesh(given)
    made.move(np.array([0]), made.points[[0]] + 1.0)
    assert made.n_elements == given.n_elements
    assert not np.array_equal(made.points, given.points)


@pytest.mark.parametrize(
    ("source", "kind", "sentence"),
    [
        ("nonsense", None, "no shape named 'nonsense'"),
        ("missing.vtk", None, "there is no such file"),
        ("star", "hex", "it is 'tri' or 'quad'"),
        (3, None, "cannot be made of int"),
        ([[0, 0], [1, 1]], None, "2 points"),
        ([[0, 0], [1]], None, "not a list of"),
    ],
)
def test_unusable_sources_are_refused_in_one_sentence(source, kind, sentence):
    with pytest.raises(MeshError, match=sentence):
        mesh(source, kind)


def test_a_mesh_of_the_other_kind_is_refused():
    with pytest.raises(MeshError, match="mesh of quads, not of triangles"):
        mesh(mesh("star"), "tri")


@pytest.mark.parametrize("name", meshwright.__all__)
def test_every_name_of_the_package_is_there(name):
    assert getattr(meshwright, name) is not None
    assert name in dir(meshwright)


def test_an_unknown_name_of_the_package_is_refused():
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = meshwright.nothing


def test_importing_the_package_imports_little():
    code = "import sys, meshwright; print([m for m in ('numpy', 'qtpy') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_resolve_gives_documents_and_domains(tmp_path, monkeypatch):
    star = mesh("star")
    document = Document(star, "mine")
    assert resolve(document) is document
    assert resolve(star).mesh is star
    assert resolve(SimpleNamespace(mesh=star)).mesh is star
    assert resolve("star").name == "star"
    document.submit("flip_left", next(h for h in range(96) if document.check("flip_left", h)))
    document.save(tmp_path / "a.meshwright")
    opened = resolve(str(tmp_path / "a.meshwright"), "other")
    assert (opened.name, len(opened.history)) == ("other", 1)
    document.save(tmp_path / "b.vtk")
    opened = resolve(tmp_path / "b.vtk")
    assert (opened.name, opened.path, opened.modified) == ("b", tmp_path / "b.vtk", False)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "star").mkdir()
    assert resolve("star").name == "star"  # a folder does not hide the shape


@pytest.mark.parametrize("source", [None, " ", SimpleNamespace(mesh=None)])
def test_sources_without_a_mesh(source):
    with pytest.raises(MeshError, match="There is no"):
        resolve(source)


def test_domain_of_a_mesh_file_is_refused(tmp_path):
    with pytest.raises(MeshError, match=r"a\.vtk: a file of a shape ends in one of"):
        domain(tmp_path / "a.vtk")
    with pytest.raises(MeshError, match="not a shape"):
        domain(mesh("star"))
