import numpy as np
import pytest

from lutcore.errors import CancelledError
from lutcore.isolated import IsolatedError, run_isolated


@pytest.fixture
def call(tmp_path, monkeypatch):
    """Return a call of a function of a module that a fresh child can import."""
    (tmp_path / "foreign_code.py").write_text(
        "import os, time\n"
        "import numpy as np\n"
        "calls = 0\n"
        "def double(values):\n"
        "    print('what libraries print')\n"
        "    return {'twice': 2 * values, 'process': np.array(os.getpid())}\n"
        "def crash_later():\n"
        "    global calls\n"
        "    calls += 1\n"
        "    if calls > 1:\n"
        "        os.abort()\n"
        "    return {'calls': np.array(calls)}\n"
        "def sleep():\n"
        "    time.sleep(60)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)

    def run(name, keep=False, seconds=30.0, **options):
        arrays = {"values": np.arange(6.0).reshape(2, 3)} if name == "double" else {}
        return run_isolated(
            f"foreign_code:{name}",
            arrays,
            label="foreign code",
            seconds=seconds,
            memory=4 << 30,
            keep=keep,
            **options,
        )

    # The test before may have left a child that does not know this folder.
    monkeypatch.setattr("lutcore.isolated._idle", idle := [])
    yield run
    while idle:
        idle.pop().stop()


def test_arrays_go_there_and_come_back(call):
    found = call("double")
    assert np.array_equal(found["twice"], 2 * np.arange(6.0).reshape(2, 3))


def test_a_kept_child_serves_again_and_others_do_not(call):
    kept = [int(call("double", keep=True)["process"]) for _ in range(2)]
    assert kept[0] == kept[1]
    assert int(call("double")["process"]) != kept[0]


def test_a_crash_of_a_child_with_a_past_is_no_proof(call):
    assert [int(call("crash_later", keep=True)["calls"]) for _ in range(3)] == [1, 1, 1]


def test_waiting_can_be_cancelled(call):
    asked = []

    def stop(share, step):
        asked.append(step)
        return len(asked) < 3

    with pytest.raises(CancelledError, match="foreign code"):
        call("sleep", progress=stop)
    assert len(asked) == 3


def test_a_function_that_does_not_exist_is_told(call):
    with pytest.raises(IsolatedError, match=r"foreign code failed on it .*AttributeError"):
        call("nothing")
