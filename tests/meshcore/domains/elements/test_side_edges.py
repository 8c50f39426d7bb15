"""Copies of the edges of sides are independent of each other."""

from copy import copy

import numpy as np

from meshwright_core.domains.elements.side_edges import SideEdges
from meshwright_core.domains.gallery import shape
from meshwright_core.domains.mesh_on_domain import with_curved_sides


def test_cutting_a_copy_leaves_the_edges_and_other_copies_as_they_are():
    edges = SideEdges(with_curved_sides(shape("disc-with-square-hole")).sides)
    before = edges.points.copy()
    trials = [copy(edges), copy(edges)]
    for trial in trials:
        trial.cut(np.array([0, 1]))
    for trial in (*trials, edges):
        assert len(np.unique(trial.points, axis=0)) == len(trial.points)
        assert (np.unique(trial.ends) == np.arange(len(trial.points))).all()
    assert (edges.points == before).all()
    assert len(trials[1].points) == len(before) + 2
