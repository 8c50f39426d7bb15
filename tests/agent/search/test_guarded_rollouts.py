"""Guarded rollouts: every state found can be drawn, and is reached by its operations."""

import numpy as np
import pytest

from meshwright_agent.policy import policy_files
from meshwright_agent.search.guarded_rollouts import GuardedRollouts
from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.quality import inverted


@pytest.fixture(scope="module")
def policy():
    return policy_files.load(policy_files.shipped("quad")[0])


@pytest.fixture(scope="module", params=["airfoil-in-box", "filleted-bracket"])
def start(request):
    return mesh_domain(gallery.shape(request.param), "quad")


def test_all_states_found_are_valid_and_lower(start, policy):
    rollouts = GuardedRollouts(start, policy, np.random.default_rng(1), 2, max_steps=25)
    rollouts.run(lambda: False)
    assert 0 <= rollouts.failed < rollouts.tried
    for state in rollouts.found:
        reached = state.mesh(start)
        reached.validate()
        assert not len(inverted(reached))
        assert reached.score == state.score <= start.score
        assert reached.n_elements == state.elements
    assert rollouts.best.score < start.score
