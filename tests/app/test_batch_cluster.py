"""The same batch on a Dask cluster of two worker processes, and behind an address."""

import json
import os

import pytest

from tests.app.test_batch import hashes, lines_of, run
from tests.batches import CRASH, METHOD, broken, install, sheet

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cluster")
    (folder / "meshes").mkdir()
    for number in range(5):
        sheet(folder / "meshes" / f"good{number}.ply", 12 + number, number)
    # Last in order: each worker, idle at first, is dealt a good one before.
    sheet(folder / "meshes" / "last-crash.ply", CRASH)
    broken(folder / "meshes" / "last-broken.ply", 0)
    return folder, os.environ | install(folder / "plugin")


@pytest.fixture(scope="module")
def cluster(place):
    with pytest.MonkeyPatch.context() as patched:
        # What a child of this process imports from, it hands on to its own.
        patched.syspath_prepend(place[0] / "plugin")
        with distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True
        ) as found:
            yield found


def test_a_cluster_draws_what_one_machine_draws_and_takes_it_up(place, cluster):
    words = ["meshes/*.ply", "--size", "160x120", "--method", METHOD, "--outputs", "shade"]
    before = {worker["id"] for worker in cluster.scheduler_info["workers"].values()}
    there = run(place, *words, "-o", "there", "--dask", cluster.scheduler_address)
    here = run(place, *words, "-o", "here", "--jobs", "2")
    assert there[0] == here[0] == 5
    folder = place[0]
    assert len(hashes(folder / "here")) == 5
    assert hashes(folder / "there") == hashes(folder / "here")
    reasons = {one["mesh"].rpartition("/")[2]: one["reason"] for one in lines_of(folder / "there")}
    assert reasons["last-crash.ply"] == "crashed"
    assert reasons["last-broken.ply"] == "unreadable"
    assert sum(reason == "done" for reason in reasons.values()) == 5
    # Both workers took part, and neither died of the mesh that killed its child.
    assert (
        len({one["worker"]["process"] for one in lines_of(folder / "there") if "worker" in one}) > 1
    )
    assert {worker["id"] for worker in cluster.scheduler_info["workers"].values()} == before

    sheet(folder / "meshes" / "good1.ply", 13, 99)
    words[0] = "meshes/good*.ply"
    words += ["-o", "there", "--dask", cluster.scheduler_address, "--json", "--resume"]
    code, printed, _ = run(place, *words)
    assert code == 0
    records = [json.loads(line) for line in printed.splitlines()]
    assert [one["n"] for one in records if not one["resumed"]] == [2]


def test_results_behind_an_address(place):
    """`file://` stands for any address that fsspec knows."""
    folder = place[0]
    words = [
        f"file://{folder}/meshes/good[03].ply",
        "--size",
        "320x240",
        "--outputs",
        "shade,report",
    ]
    words += ["--method", METHOD, "-o", f"file://{folder}/far", "--resume", "--jobs", "1"]
    assert run(place, *words)[0] == 0
    assert sorted(hashes(folder / "far")) == [
        f"good{n}-{name}"
        for n in (0, 3)
        for name in ("report.html", "report.session.json", "shade.png")
    ]
    code, printed, _ = run(place, *words, "--json")
    assert code == 0
    assert all(json.loads(line)["resumed"] for line in printed.splitlines())
