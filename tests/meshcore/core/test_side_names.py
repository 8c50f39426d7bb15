"""Names of sides and regions on a mesh: given, kept by operations, undone."""

import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.side_names import Names


def grid(n: int = 3, regions=None, names=None) -> HalfEdgeMesh:
    """n x n unit quads; vertex (i, j) is j * (n + 1) + i."""
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)
    y, x = np.divmod(np.arange((n + 1) ** 2), n + 1)
    points = np.column_stack([x, y]).astype(float)
    return HalfEdgeMesh.from_elements(points, quads, regions=regions, names=names)


def lengths(mesh: HalfEdgeMesh) -> dict[str, float]:
    """The length of each side by name."""
    return {
        name: float(np.linalg.norm(np.diff(mesh.points[ends], axis=1), axis=2).sum())
        for name, ends in mesh.sides().items()
    }


BOTTOM = [(0, 1), (1, 2), (2, 3)]


def test_named_edges_become_sides_with_geometric_ends():
    mesh = grid(names=Names(edges=np.array([(1, 0), (4, 0)]), sides=["in", "in"]))
    assert lengths(mesh) == {"in": 2.0, "": 10.0}
    assert mesh.geometric()[[1, 4]].all()
    assert mesh.desired()[[1, 4]].tolist() == [3, 3]
    assert mesh.side_of(mesh.halfedge(0, 1)) == "in"
    assert mesh.side_of(mesh.halfedge(1, 5)) == ""
    mesh.validate()


def test_naming_is_undone_and_redone_with_the_flags_of_its_ends():
    mesh = grid()
    before = mesh.arrays.vertex.copy()
    mesh.name_sides([mesh.halfedge(0, 1), mesh.halfedge(1, 2)], " wall ;hot")
    assert lengths(mesh) == {"wall; hot": 2.0, "": 10.0}
    assert mesh.geometric()[2]
    with pytest.raises(MeshError, match="a named side ends there"):
        mesh.set_geometric(2, False)
    mesh.rename("hot", "cold")
    assert set(mesh.sides()) == {"wall; cold", ""}
    assert mesh.steps == 2
    assert mesh.undo() and set(mesh.sides()) == {"wall; hot", ""}
    assert mesh.undo() and set(mesh.sides()) == {""}
    assert (mesh.arrays.vertex == before).all()
    assert mesh.redo() and mesh.redo() and set(mesh.sides()) == {"wall; cold", ""}
    copied = mesh.copy(history=True)
    mesh.undo()
    assert set(copied.sides()) == {"wall; cold", ""}
    copied.undo()
    assert set(copied.sides()) == {"wall; hot", ""}
    assert set(mesh.copy().sides()) == {"wall; hot", ""}


def test_a_new_name_after_an_undo_leaves_the_branch_intact():
    mesh = grid()
    mesh.name_sides([mesh.halfedge(0, 1)], "first")
    mesh.undo()
    cut = mesh.cut_redo()
    mesh.name_sides([mesh.halfedge(0, 1)], "second")
    mesh.undo()
    mesh.graft_redo(cut)
    mesh.redo()
    assert set(mesh.sides()) == {"first", ""}


def test_a_name_over_the_start_of_a_loop():
    mesh = grid()
    around = [(4, 0), (0, 1), (8, 4)]
    mesh.name_sides([mesh.halfedge(a, b) for a, b in around], "start")
    assert lengths(mesh) == {"start": 3.0, "": 9.0}
    mesh.name_sides([mesh.halfedge(0, 1)], "")
    assert lengths(mesh) == {"start": 2.0, "": 10.0}


def test_interfaces_have_names_from_both_sides():
    regions = np.repeat([0, 1, 1], 3)
    line = np.array([(4, 5), (6, 5), (6, 7)])
    mesh = grid(regions=regions, names=Names(("steel", "copper"), line, ["joint"] * 3))
    assert lengths(mesh) == {"joint": 3.0, "": 12.0}
    assert mesh.region_names == ("steel", "copper")
    h = mesh.halfedge(5, 6)
    assert mesh.side_of(h) == mesh.side_of(mesh.twin(h)) == "joint"
    mesh.name_sides([mesh.twin(h)], "weld")
    assert lengths(mesh) == {"joint": 2.0, "weld": 1.0, "": 12.0}
    mesh.name_regions([1], "brass")
    assert mesh.region_names == ("steel", "brass")
    with pytest.raises(MeshError, match="no region 2"):
        mesh.name_regions([2], "x")
    with pytest.raises(MeshError, match="within a region"):
        mesh.name_sides([mesh.halfedge(9, 10)], "x")
    mesh.validate()


def test_names_stay_on_their_sides_through_random_operations():
    regions = np.repeat([0, 0, 0, 1, 1, 1], 6)
    sides = [((i, i + 1), "bottom") for i in range(6)] + [((0, 7), "left"), ((7, 14), "left")]
    names = Names(("a", "b"), np.array([ends for ends, _ in sides]), [name for _, name in sides])
    mesh = grid(6, regions, names)
    before = lengths(mesh)
    rng = np.random.default_rng(3)
    done = 0
    for _ in range(20_000):
        if done == 200:
            break
        h = int(rng.integers(len(mesh.arrays.edge)))
        some = ["flip_left", "flip_right", "split", "collapse", "global_split"]
        name = "collapse" if mesh.n_elements > 90 else str(rng.choice(some))
        if mesh.live(h) and mesh.check(name, h):
            mesh.apply(name, h)
            done += 1
    assert done == 200
    mesh.validate()
    assert {name: round(size, 9) for name, size in lengths(mesh).items()} == before
    mesh.compact()
    assert {name: round(size, 9) for name, size in lengths(mesh).items()} == before
