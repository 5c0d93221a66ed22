"""Scores and verdicts: what they count, and what our own estimators get."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import CurvelightError, MeshError, ParameterError
from lutcore.estimation import principal_curvatures
from lutcore.gallery import catalogue
from lutcore.gallery.judgement import Verdict, score, verdict_of
from lutcore.isolated import IsolatedError, run_isolated

OURS = ("auto", "co-smoothing", "rusinkiewicz2004")
# What is only written down badly costs nothing: equal values but for single-precision smoothing.
HARMLESS = ("flipped-all", "soup", "isolated", "random-order", "metres", "micrometres")


@cache
def case(name):
    return catalogue.build(name)


@cache
def estimate(mesh, method):
    return principal_curvatures(mesh, method)


def exact(subject, error=0.0):
    count = len(subject.k1)
    axes = np.tile(np.eye(3)[0], (count, 1))
    bars = np.full(count, error)
    return PrincipalCurvatures(subject.k1, subject.k2, axes, axes, axes, bars, 0.0)


@pytest.mark.parametrize("method", OURS)
@pytest.mark.parametrize("name", catalogue.names())
def test_ours_give_finite_values_or_a_stated_refusal(name, method):
    mesh = case(name).broken.mesh
    try:
        found = estimate(mesh, method)
    except CurvelightError as refusal:
        assert verdict_of(refusal) is Verdict.REFUSED
        assert str(refusal)
        return
    for values in (found.k1, found.k2):
        assert values.shape == (len(mesh.vertices),)
        assert np.isfinite(values).all()
    assert (found.k1 >= found.k2).all()
    assert not np.isnan(found.error).any()


@pytest.mark.parametrize("method", OURS)
@pytest.mark.parametrize("name", HARMLESS)
def test_ours_do_not_mind_how_a_surface_is_written_down(name, method):
    broken, sound = (
        score(estimate(one.mesh, method), one) for one in (case(name).broken, case(name).sound)
    )
    assert broken.error == pytest.approx(sound.error, rel=0.02)
    assert broken.verdict is Verdict.SURVIVES


def test_the_truth_itself_has_no_error():
    found = score(exact(case("saddle").broken), case("saddle").broken)
    assert (found.error, found.worst, found.turned, found.missing) == (0.0, 0.0, 0.0, 0.0)
    assert (found.within_1, found.within_2) == (1.0, 1.0)
    assert found.verdict is Verdict.SURVIVES


@pytest.mark.parametrize(
    ("share", "verdict"),
    [
        (0.099, Verdict.SURVIVES),
        (0.101, Verdict.DEGRADED),
        (0.499, Verdict.DEGRADED),
        (0.501, Verdict.WRONG),
        (1e300, Verdict.WRONG),
    ],
)
def test_the_error_is_a_share_of_the_rms_curvature(share, verdict):
    subject = case("umbilic").broken  # k1 = k2 = 1, so that both off by s are off by s
    truth = exact(subject)
    found = score(replace(truth, k1=truth.k1 + share, k2=truth.k2 + share), subject)
    assert found.error == pytest.approx(share)
    assert found.worst == pytest.approx(share)
    assert found.verdict is verdict


def test_calling_everything_flat_has_an_error_of_one():
    subject = case("saddle").broken
    zero = np.zeros_like(subject.k1)
    assert score(replace(exact(subject), k1=zero, k2=zero), subject).error == pytest.approx(1.0)


def test_the_worst_is_the_99th_percentile():
    subject = case("umbilic").broken
    k1 = subject.k1.copy()
    k1[:200] += 3.0  # one vertex in twenty
    found = score(replace(exact(subject), k1=k1), subject)
    assert found.worst == pytest.approx(3.0 / np.sqrt(2.0))
    assert_allclose(found.error, np.sqrt(0.05 * 9.0 / 2.0))


def test_only_judged_vertices_count_but_all_must_be_finite():
    subject = case("spike").broken
    tip = np.flatnonzero(~subject.judged)[0]
    k1 = subject.k1.copy()
    k1[tip] = 1e6
    assert score(replace(exact(subject), k1=k1), subject).error == 0.0
    k1[tip] = np.nan
    found = score(replace(exact(subject), k1=k1), subject)
    assert found.verdict is Verdict.WRONG
    assert found.fault == f"1 of {len(k1)} vertices are not finite"


def test_turned_signs_are_found():
    subject = case("umbilic").broken
    found = score(replace(exact(subject), k1=-subject.k2, k2=-subject.k1), subject)
    assert found.turned == 1.0
    assert found.fault == "wrong sign at 100% of the vertices"
    assert found.verdict is Verdict.WRONG


def test_too_few_values_and_values_out_of_order_are_wrong():
    subject = case("umbilic").broken
    truth = exact(subject)
    few = replace(truth, k1=truth.k1[1:], k2=truth.k2[1:], error=truth.error[1:])
    assert score(few, subject).fault == "gave 3999 values for 4000 vertices"
    assert score(few, subject).verdict is Verdict.WRONG
    swapped = score(replace(truth, k1=truth.k1 - 1e-3), subject)
    assert swapped.fault == "k1 < k2 at 4000 vertices"
    assert swapped.verdict is Verdict.WRONG


def test_error_bars_are_counted_where_there_are_any():
    subject = case("umbilic").broken
    truth = exact(subject, error=0.02)
    off = replace(truth, k1=truth.k1 + 0.03, k2=truth.k2 + 0.01)
    found = score(off, subject)
    assert (found.within_1, found.within_2, found.missing) == (0.5, 1.0, 0.0)
    bars = truth.error.copy()
    bars[:1000] = np.inf
    assert score(replace(off, error=bars), subject).missing == 0.25
    none = score(replace(off, error=np.full(4000, np.inf)), subject)
    assert (none.within_1, none.within_2, none.missing) == (None, None, 1.0)


@pytest.fixture
def foreign(tmp_path, monkeypatch):
    """Return what a child process that runs a function raises."""
    (tmp_path / "broken_code.py").write_text(
        "import os, time\n"
        "def refuse():\n    raise ValueError('no reason given by me')\n"
        "def crash():\n    os.abort()\n"
        "def leave():\n    os._exit(3)\n"
        "def hang():\n    time.sleep(60)\n"
        "def eat():\n    return {'all': bytearray(1 << 40)}\n"
    )
    monkeypatch.syspath_prepend(tmp_path)

    def run(name):
        seconds = 1.0 if name == "hang" else 30.0
        with pytest.raises(IsolatedError) as caught:
            run_isolated(f"broken_code:{name}", {}, label="it", seconds=seconds, memory=4 << 30)
        return caught.value

    return run


@pytest.mark.parametrize(
    ("name", "verdict"),
    [
        ("refuse", Verdict.REFUSED),
        ("crash", Verdict.DIED),
        ("leave", Verdict.DIED),
        ("hang", Verdict.DIED),
        ("eat", Verdict.DIED),
    ],
)
def test_a_refusal_is_told_from_a_death(foreign, name, verdict):
    assert verdict_of(foreign(name)) is verdict


def test_our_own_errors_are_refusals():
    assert verdict_of(ParameterError("no")) is Verdict.REFUSED
    assert verdict_of(MeshError("no")) is Verdict.REFUSED
