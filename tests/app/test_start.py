from tests.bench.start import ratio


def test_help_costs_at_most_three_times_importing_numpy():
    # A ratio within one run, so that a slow or a busy machine does not matter.
    assert ratio()["ratio"] <= 3.0
