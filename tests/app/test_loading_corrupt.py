import os
import signal
import tempfile
import time

import numpy as np
import pytest

from app.cli.main import main
from app.loading import load_mesh
from tests.bench.robustness import Server
from tests.corpus.cases import corpus, seed_files
from tests.corpus.mutations import truncated
from tests.mesh_files import one_of_each

FILES = one_of_each()
QUICK = seed_files(children=False)
# Each file of these costs the start of a child process, about .5 s.
SLOW = {name: content for name, content in seed_files().items() if name not in QUICK}


def outcomes(folder, files):
    """Read files in another process, with 6 GiB of address space; return what became of each."""
    found = {}
    with tempfile.TemporaryFile() as complaints:
        server = Server("curvelight", complaints.fileno())
        for name, content in files.items():
            path = folder / name
            path.write_bytes(content)
            began = time.perf_counter()
            found[name] = server.read(path, seconds=0.0)
            # Of 2 kB: beyond VTK's start on a busy machine it is a loop over a false count.
            assert time.perf_counter() - began < 30, name
        server.stop()
        complaints.seek(0)
        # Readers report by exceptions and warnings of ours, never on the terminal.
        assert complaints.read() == b""
    return found


def wrong(found):
    return {
        name: answer
        for name, answer in found.items()
        if answer["outcome"] not in ("mesh", "refused")
    }


def test_damaged_files_give_a_sound_mesh_or_a_clear_refusal(tmp_path):
    cases = [*corpus(600, 0, QUICK, bombs=False), *corpus(6, 1, SLOW)]
    found = outcomes(tmp_path, {case.name: case.content for case in cases})
    assert len(found) == 606
    assert wrong(found) == {}
    refused = [answer for answer in found.values() if answer["outcome"] == "refused"]
    # The damage must reach the readers' checks, and the checks must bite.
    assert 303 < len(refused) < 606
    assert {answer["code"] for answer in refused} == {3, 4}


def test_the_corpus_is_the_same_for_the_same_seed_and_has_every_format_and_damage():
    cases = list(corpus(800, 4, QUICK, bombs=False))
    assert cases == list(corpus(800, 4, QUICK, bombs=False))
    assert {case.seed_file for case in cases} == set(QUICK)
    assert len({case.damage.split("+")[0] for case in cases}) == 18
    assert [case.content for case in corpus(50, 5)] != [case.content for case in corpus(50, 6)]


# OBJ neither counts nor ends its lists: a cut between two lines cannot be told from the end.
def test_a_file_cut_short_is_never_taken_for_whole(tmp_path):
    parts = {}
    for name, content in {**QUICK, "plain.vtp": FILES["plain.vtp"]}.items():
        if name == "plain.obj":
            continue
        # A text that lost digits of its last number, or the name after "endsolid", looks whole.
        whole = content if b"\0" in content else content.rsplit(maxsplit=3)[0]
        for index, part in enumerate(truncated(whole, 3 if name == "plain.vtp" else 12)):
            parts[f"{index:03}-{name}"] = part
    found = outcomes(tmp_path, parts)
    assert {name for name, answer in found.items() if answer["outcome"] != "refused"} == set()


@pytest.mark.parametrize("name", ["text.ply", "plain.off", "plain.obj"])
def test_a_text_that_may_have_lost_digits_is_reported(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(FILES[name].rstrip()[:-1])
    assert "last number" in load_mesh(path).warnings[0]


def test_the_command_says_in_one_line_what_is_wrong_and_ends_with_its_code(tmp_path, capsys):
    seen = set()
    for case in corpus(40, 9, QUICK, bombs=False):
        path = tmp_path / case.name
        path.write_bytes(case.content)
        try:
            load_mesh(path)
        except Exception:
            code = main(["curvature", str(path), "-o", str(tmp_path / "out.npz"), "--quiet"])
            printed = capsys.readouterr()
            assert code in (3, 4), case.name
            assert printed.out == ""
            assert str(path) in printed.err
            assert printed.err.count("\n") == 1
            assert not (tmp_path / "out.npz").exists()
            seen.add(code)
    assert 3 in seen


def test_what_kills_or_hangs_a_reader_or_eats_the_memory_would_be_seen(tmp_path, monkeypatch):
    from tests.bench import robustness_child

    def reader(body):
        monkeypatch.setitem(robustness_child._READERS, "rude", ("app", body))
        return robustness_child.Workers("rude").read(str(tmp_path), 0.3)["outcome"]

    def greedy(path):
        raise MemoryError

    assert reader(lambda path: os.kill(os.getpid(), signal.SIGKILL)) == "died"
    assert reader(lambda path: os._exit(0)) == "died"
    assert reader(lambda path: time.sleep(9)) == "hung"
    assert reader(greedy) == "memory"
    assert reader(lambda path: []) == "empty"
    assert reader(lambda path: [(np.zeros((1, 3)), np.array([1]))]) == "garbage"


def test_garbage_would_be_seen():
    from tests.bench.robustness_child import is_sound

    points = np.zeros((3, 3))
    assert is_sound(points, np.array([0, 1, 2]))
    assert not is_sound(points, np.array([0, 1, 3]))
    assert not is_sound(points, np.array([0, 1, -1]))
    assert not is_sound(np.full((3, 3), np.nan), np.array([0, 1, 2]))
