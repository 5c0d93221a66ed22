"""That the bench of corrupted files counts what it says, on answers made by hand."""

import json
import os
import time
from pathlib import Path

import numpy as np
import pytest

from tests.bench import robustness, robustness_child
from tests.corpus.cases import Case, seed_files


def test_outcomes_are_counted_and_valid_files_tell_which_formats_a_reader_knows():
    cases = [Case(f"{n}.x", b"", seed, "cut") for n, seed in enumerate(("a", "a", "b"))]
    valid = [{"outcome": "mesh", "seconds": 0.25}, {"outcome": "refused", "seconds": 0.25}]
    rest = [
        {"outcome": "refused", "seconds": 1.0, "peak_mib": 5.0, "code": 3},
        {"outcome": "died", "seconds": 2.0, "said": "11"},
        {"outcome": "empty", "seconds": 0.5, "peak_mib": 9.0},
    ]
    row = robustness._summary([*valid, *rest], ["a", "b"], cases)
    assert (row["formats"], row["files of formats it reads"]) == (1, 2)
    assert (row["refused"], row["died"], row["empty"], row["hung"]) == (1, 1, 1, 0)
    assert (row["slowest_s"], row["peak_mib"], row["codes"]) == (2.0, 9.0, {"3": 1})
    assert row["seconds"] == 4.0
    assert row["wrong"] == ["1.x: died 11"]


def test_every_reader_reads_a_valid_file_and_none_takes_a_bad_index_for_fine(tmp_path):
    from tests.mesh_files import grid, ply

    vertices, faces = grid()
    (tmp_path / "good.ply").write_bytes(ply(vertices, faces, None, ""))
    for reader in robustness.READERS:
        server = robustness.Server(reader)
        assert server.read(tmp_path / "good.ply")["outcome"] == "mesh", reader
        assert server.read(tmp_path / "none.ply")["outcome"] == "refused", reader
        server.stop()


def test_one_process_reads_many_files_and_only_a_fresh_one_is_believed_to_die(
    tmp_path, monkeypatch
):
    def moody(path):
        """Die of some files, of others only after many, and hang on others."""
        what = Path(path).name
        with (tmp_path / "log").open("a") as log:
            log.write(f"{os.getpid()} {what}\n")
        moody.past += 1
        if what == "deadly" or (what == "late" and moody.past > 1):
            os._exit(7)
        if what == "greedy" and moody.past > 1:
            raise MemoryError
        if what == "endless":
            time.sleep(60)
        return [(np.zeros((3, 3)), np.array([0, 1, 2]))]

    moody.past = 0
    monkeypatch.setitem(robustness_child._READERS, "moody", ("app", moody))
    workers = robustness_child.Workers("moody")
    words = ["good", "good", "deadly", "good", "late", "endless", "good", "greedy", "good"]
    found = [workers.read(str(tmp_path / word), 0.5) for word in words]
    workers.stop()
    assert [answer["outcome"] for answer in found] == [
        *("mesh", "mesh", "died", "mesh", "mesh", "hung", "mesh", "mesh", "mesh")
    ]
    assert found[2]["said"] == str(7 << 8)
    assert all(answer["seconds"] < 5.0 and answer["peak_mib"] > 1.0 for answer in found)
    readings = [line.split() for line in (tmp_path / "log").read_text().splitlines()]
    # Twice each: what was read by a process with a past and went wrong.
    assert [word for _, word in readings].count("deadly") == 2
    assert [word for _, word in readings].count("late") == 2
    assert [word for _, word in readings].count("greedy") == 2
    assert len({process for process, _ in readings}) == 6


def test_all_readers_get_all_files_and_some_readers_can_be_chosen(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(robustness, "_PART", 2)
    monkeypatch.setattr(robustness, "seed_files", lambda: {"plain.off": seed_files()["plain.off"]})
    words = ["robustness", "--files", "5", "--seed", "3", "--readers", "trimesh,curvelight"]
    monkeypatch.setattr("sys.argv", [*words, "--json"])
    robustness.main()
    found = json.loads(capsys.readouterr().out)
    assert list(found) == ["trimesh", "curvelight"]
    for row in found.values():
        assert row["formats"] == 1
        assert sum(row[outcome] for outcome in robustness.OUTCOMES) == 5
    monkeypatch.setattr("sys.argv", ["robustness", "--readers", "blender"])
    with pytest.raises(SystemExit):
        robustness.main()
    assert "no reader blender; there are curvelight" in capsys.readouterr().err


def test_a_loop_without_end_is_stopped_by_the_time_of_the_processor(tmp_path, monkeypatch):
    def spin(path):
        while True:
            pass

    monkeypatch.setitem(robustness_child._READERS, "spin", ("app", spin))
    monkeypatch.setattr(robustness_child, "_SLOWNESS", 1000)  # the clock would stop it too
    found = robustness_child.Workers("spin").read(str(tmp_path), 0.5)
    assert found["outcome"] == "hung" and "said" not in found
