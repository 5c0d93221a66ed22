import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from lutcore.topology import components


@pytest.mark.parametrize("width", [2, 3])
@pytest.mark.parametrize(("links", "count"), [(0, 5), (40, 100), (3_000, 4_000), (20_000, 9_000)])
def test_groups_are_those_of_scipy_numbered_by_their_first_things(links, count, width):
    random = np.random.default_rng(links + width)
    rows = random.integers(0, count, (links, width)).astype(np.int32)
    groups, label = components(rows, count)
    pairs = np.concatenate([rows[:, [0, k]] for k in range(1, width)])
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    expected, labels = connected_components(graph, directed=False)
    assert groups == expected
    np.testing.assert_array_equal(label, labels)
    first = np.unique(label, return_index=True)[1]
    assert (np.diff(first) > 0).all()


def test_a_long_chain_in_any_order_is_one():
    count = 100_000
    chain = np.stack([np.arange(count - 1), np.arange(1, count)], axis=1)
    for one in (chain, chain[::-1], np.random.default_rng(1).permutation(chain)[:, ::-1]):
        groups, label = components(one, count)
        assert groups == 1
        assert not label.any()
