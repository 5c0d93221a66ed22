import warnings

import numpy as np
import pytest

from app.loading.errors import BadContentError
from app.loading.text import numbers


@pytest.mark.parametrize("text", [b"1 2\n3", b" 1\t2\r\n3 ", b"1\v2\f3\n", b"1e0 +2. 3.0"])
def test_numbers_stand_between_any_blanks(text):
    assert numbers(text).tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    "text", [b"1\n3 x", b"1\n-", b"1\n+\n", b"1\n- 2", b".5\n1.2.3", b"1\n2-3", b"1\n1_0 2,5"]
)
@pytest.mark.parametrize("action", ["ignore", "error"])
def test_text_among_numbers_is_refused_whatever_is_done_with_warnings(text, action):
    with warnings.catch_warnings():
        warnings.simplefilter(action)
        with pytest.raises(BadContentError, match=r"line 2: .* is not a number"):
            numbers(text)


def test_an_array_that_ends_at_text_as_older_numpy_returns_it_is_refused(monkeypatch):
    def stopping(text, dtype, sep):
        warnings.warn("unmatched data", DeprecationWarning, stacklevel=2)
        return np.array([1, 2], dtype)

    monkeypatch.setattr(np, "fromstring", stopping)
    with (
        pytest.warns(DeprecationWarning),
        pytest.raises(BadContentError, match="line 1: 'x' is not a number"),
    ):
        numbers(b"1 2 x 3")


def test_the_warning_filters_are_left_alone_for_other_threads(monkeypatch):
    read = np.fromstring
    seen = []

    def watched(*words, **more):
        seen.append((warnings.filters, list(warnings.filters)))
        return read(*words, **more)

    monkeypatch.setattr(np, "fromstring", watched)
    filters, content = warnings.filters, list(warnings.filters)
    numbers(b"1 2 3")
    assert seen[0][0] is filters
    assert seen[0][1] == content
