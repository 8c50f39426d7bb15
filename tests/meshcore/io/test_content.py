"""The record of named groups that readers hand over."""

import numpy as np

from meshwright_core.core import names
from meshwright_core.io.content import NamesBuilder


def test_groups_that_overlap_become_names_of_both():
    builder = NamesBuilder({"quad": np.zeros((4, 4), np.int64)})
    builder.add_elements("steel", "quad", [0, 1], tag=3)
    builder.add_elements("hot; side", "quad", [1, 2])
    builder.add_edges("wall", [(0, 1), (2, 1)], tag=7)
    builder.add_edges("inlet", [(1, 2)])
    builder.add_points("fixed", [4, 2])
    found = builder.result()
    assert [found.regions[i] if i >= 0 else "" for i in found.elements["quad"]] == [
        "steel",
        "steel; hot, side",
        "hot, side",
        "",
    ]
    assert found.edges.tolist() == [[0, 1], [1, 2]]
    assert [found.sides[i] for i in found.edge_sides] == ["wall", "wall; inlet"]
    assert found.tags == {(2, "steel"): 3, (1, "wall"): 7}
    assert found.points["fixed"].tolist() == [2, 4]
    assert NamesBuilder({}).result() is None


def test_numbers_become_groups_of_their_array():
    builder = NamesBuilder({"triangle": np.zeros((3, 3), np.int64)})
    builder.add_numbers("material", "triangle", [2, 7, 2])
    found = builder.result()
    assert [found.regions[i] for i in found.elements["triangle"]] == [
        "material=2",
        "material=7",
        "material=2",
    ]
    assert names.numbered("material=-7") == ("material", -7)
    assert names.numbered("material=x") is None


def test_names_are_one_line_and_split_into_groups():
    assert names.clean(" wall ;; hot\n wall; hot wall;wall") == "wall; hot wall"
    assert names.groups("wall; hot wall") == ("wall", "hot wall")
    assert names.safe("a;b\x00c") == "a,b c"
