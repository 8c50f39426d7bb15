"""Connected parts of graphs, against SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from meshwright_core.core.components import components


@pytest.mark.parametrize("seed", range(30))
def test_parts_and_their_order_are_those_of_scipy(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 200))
    one, other = rng.integers(0, count, (2, int(rng.integers(0, 2 * count))))
    links = coo_array((np.ones(len(one)), (one, other)), shape=(count, count))
    number, label = connected_components(links, directed=False)
    found, parts = components(one, other, count)
    assert found == number
    assert (parts == label).all()


def test_a_long_chain_in_any_order_is_one_part():
    order = np.random.default_rng(0).permutation(20_000)
    assert components(order[:-1], order[1:], 20_000)[0] == 1


def test_no_nodes_have_no_parts():
    none = np.zeros(0, int)
    assert components(none, none, 0)[0] == 0
    assert components(none, none, 3)[1].tolist() == [0, 1, 2]
