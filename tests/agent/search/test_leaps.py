"""Leaps: lower s, and a result that can be drawn."""

import numpy as np

from meshwright_agent.policy import policy_files
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.leaps import leap
from meshwright_core.core.arrays import SCORE
from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.quality import inverted
from meshwright_core.geometry.smoothing import relax


def test_a_leap_lowers_s_and_inverts_nothing():
    mesh = mesh_domain(gallery.shape("filleted-bracket"), "quad")
    relax(mesh)
    policy = policy_files.load(policy_files.shipped("quad")[0])
    before = mesh.points.copy()
    found = leap(mesh, policy, np.random.default_rng(2), lambda: False)
    assert found is not None
    operations, arrays = found
    assert (mesh.points == before).all()
    assert arrays.counters[SCORE] < mesh.score
    reached = replayed(mesh, operations)
    assert reached.score == arrays.counters[SCORE]
    ids = reached.vertices()
    reached.move(ids, arrays.points[ids], arrays.parameter[ids])
    assert not len(inverted(reached))


def test_a_stopped_leap_is_none():
    mesh = mesh_domain(gallery.shape("filleted-bracket"), "quad")
    policy = policy_files.load(policy_files.shipped("quad")[0])
    assert leap(mesh, policy, np.random.default_rng(2), lambda: True) is None
