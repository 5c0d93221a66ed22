import numpy as np
import pytest

from lutcore.statistics import PERCENTILES, histogram, percentiles


def test_a_histogram_counts_every_finite_value_once():
    values = np.array([-1.0, 0.0, 0.1, 0.5, 0.9, 1.0, 1.5, 2.0, np.inf])
    found = histogram(values, 0.0, 1.0, bins=2)
    np.testing.assert_array_equal(found.edges, [0.0, 0.5, 1.0])
    np.testing.assert_array_equal(found.counts, [2, 3])
    assert (found.below, found.above) == (1, 2)


def test_percentiles_leave_out_what_is_infinite():
    found = percentiles(np.array([*np.arange(101.0), np.inf]))
    assert found == {f"p{share}": pytest.approx(share) for share in PERCENTILES}
    assert set(percentiles(np.array([np.inf])).values()) == {None}
