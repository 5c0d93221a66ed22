import numpy as np
import pytest

from app.chart import race as racing
from app.chart.contestants import Subject, contestants, spacing_of
from app.chart.naming import named
from app.chart.points import Missing
from app.chart.race import Contestant, race
from lutcore import analytic
from lutcore.errors import CancelledError, ParameterError
from lutcore.estimation import estimators, principal_curvatures
from lutcore.progress import silent


def contestant(name, run, setting="", effort=0.0):
    return Contestant(name, setting, "", run, effort)


def raced(taking, subjects=(1, 2), limit=5.0, progress=silent):
    return race(taking, list(subjects), 0, lambda one, subject, result: result, limit, progress)


def test_contestants_take_turns_after_a_warm_call_each():
    calls = []

    def work(name):
        return lambda subject, progress: calls.append((name, subject)) or subject

    finished, missing = raced([contestant("a", work("a")), contestant("b", work("b"))])
    assert calls == [
        *[("a", 0), *[("a", 1)] * racing.QUICK, ("b", 0), *[("b", 1)] * racing.QUICK],
        *[("a", 0), *[("a", 2)] * racing.QUICK, ("b", 0), *[("b", 2)] * racing.QUICK],
    ]
    assert [one.verdicts for one in finished] == [[1, 2], [1, 2]]
    assert all(len(one.seconds) == 2 * racing.QUICK for one in finished)
    assert all(min(one.seconds) >= 0.0 for one in finished)
    assert missing == []


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (ParameterError("this is refused"), "this is refused"),
        (ZeroDivisionError("zero\nmany lines"), "fault in it: ZeroDivisionError: zero"),
    ],
)
def test_who_fails_is_listed_with_the_reason_and_the_others_go_on(error, reason):
    def fail(subject, progress):
        if subject == 2:  # only later, so that it must be taken out again
            raise error
        return subject

    finished, missing = raced([contestant("bad", fail), contestant("good", lambda s, p: s)])
    assert [one.contestant.name for one in finished] == ["good"]
    assert missing == [Missing("bad", "", reason)]


def test_who_is_slow_is_called_once_on_each_subject(monkeypatch):
    clock = iter(np.arange(0.0, 1000.0, 1.0))
    monkeypatch.setattr(racing.time, "perf_counter", lambda: next(clock))
    finished, _ = raced([contestant("a", lambda s, p: s)])
    assert finished[0].seconds == [1.0, 1.0]


def endless(subject, progress):
    while progress(0.5, "working"):
        pass
    raise CancelledError("stopped")


def quick_when_small(subject, progress):
    return endless(subject, progress) if subject else 0


def test_who_takes_too_long_is_stopped_and_what_needs_more_is_not_tried():
    tried = []

    def harder(subject, progress):
        tried.append(subject)
        return subject

    taking = [
        contestant("a", quick_when_small, "4 h", 4.0),
        contestant("a", harder, "8 h", 8.0),
        contestant("a", lambda subject, progress: subject, "2 h", 2.0),
    ]
    finished, missing = raced(taking, limit=1.0)
    assert [one.contestant.setting for one in finished] == ["2 h"]
    assert missing == [
        Missing("a", "4 h", "took more than 1 s"),
        Missing("a", "8 h", "not tried: 4 h took more than 1 s"),
    ]
    assert tried == []


def test_who_does_not_look_at_the_clock_is_out_once_it_has_ended(monkeypatch):
    clock = iter(np.arange(0.0, 1000.0, 10.0))
    monkeypatch.setattr(racing.time, "perf_counter", lambda: next(clock))
    finished, missing = raced([contestant("a", lambda s, p: s)], limit=9.0)
    assert finished == []
    assert missing == [Missing("a", "", "took more than 9 s")]


def test_the_callers_wish_to_stop_is_not_taken_for_slowness():
    asked = []

    def stop(share, step):
        asked.append((share, step))
        return len(asked) < 3

    with pytest.raises(CancelledError):
        raced([contestant("a", quick_when_small, "4 h")], progress=stop)
    assert asked[0] == (0.0, "a 4 h, 1 of 2")


@pytest.fixture(scope="module")
def small():
    mesh = analytic.torus(400).mesh
    return Subject(mesh, spacing_of(mesh))


def test_scales_and_few_valued_parameters_make_settings_and_a_refusal_its_reason(small):
    taking, missing, first = contestants(
        ["ball-jet", "rusinkiewicz2004", "meshlab-pca"], (4.0, 2.0), small
    )
    assert [(one.name, one.setting) for one in taking] == [
        ("ball-jet", ""),
        ("ball-jet", "2 h"),
        ("ball-jet", "4 h"),
        ("ball-jet", "degree 2"),
        ("ball-jet", "degree 2, 2 h"),
        ("ball-jet", "degree 2, 4 h"),
        ("rusinkiewicz2004", ""),  # of the one-ring: no scale
    ]
    assert set(first) == {"ball-jet", "rusinkiewicz2004"}
    assert [one.name for one in missing] == ["meshlab-pca"]
    assert "nothing to convert" in missing[0].reason


def test_a_contestant_does_what_its_setting_says(small):
    taking, _, _ = contestants(["ball-jet"], (3.0,), small)
    last = taking[-1]
    assert last.setting == "degree 2, 3 h"
    expected = principal_curvatures(small.mesh, "ball-jet", 3.0 * small.spacing, degree=2)
    np.testing.assert_array_equal(last.run(small, silent).k1, expected.k1)


def test_methods_are_chosen_by_name():
    assert named("vtk, ball-jet,vtk", "curvature estimator", estimators()) == ["vtk", "ball-jet"]
    assert "rusinkiewicz2004" in named(None, "curvature estimator", estimators())
    with pytest.raises(ParameterError, match="did you mean 'ball-jet'"):
        named("ball-jot", "curvature estimator", estimators())
