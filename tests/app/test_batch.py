"""A batch as users run it: a mesh that crashes, hangs or eats memory costs only itself."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from PIL import Image

from app.batch.ledger import _versions_of, key_of
from app.batch.plan import Item, Work
from app.batch.store import Folder, digest
from app.batch.summary import write_parquet
from app.cli.main import main
from app.session import Session
from tests.batches import CRASH, EAT, HANG, METHOD, broken, install, sheet

COMMAND = [sys.executable, "-c", "import sys; from app.cli.main import main; sys.exit(main())"]
JOB = f"""
meshes = "../meshes/*.ply"
outputs = ["shade", "curvature"]
[defaults]
size = [160, 120]
estimator.name = "{METHOD}"
[[blocks]]
match = "hang.ply"
seconds = 2
[[blocks]]
match = "eat.ply"
memory_gib = 0.9
"""
GOOD = 5


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """Return a folder with meshes and a job, and variables that make the plug-in known."""
    folder = tmp_path_factory.mktemp("batch")
    meshes = folder / "meshes"
    meshes.mkdir()
    for number in range(GOOD):
        sheet(meshes / f"good{number}.ply", 12 + number, number)
    for name, side in (("crash", CRASH), ("hang", HANG), ("eat", EAT)):
        sheet(meshes / f"{name}.ply", side)
    for kind in range(4):
        broken(meshes / f"broken{kind}.ply", kind)
    (folder / "jobs").mkdir()
    (folder / "jobs" / "job.toml").write_text(JOB)
    return folder, os.environ | install(folder / "plugin")


def start(place, *words):
    folder, variables = place
    # Tests that run in the background ignore interrupts, and so would what they start.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return subprocess.Popen(
            [*COMMAND, "batch", *map(str, words)],
            cwd=folder,
            env=variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
    finally:
        signal.signal(signal.SIGINT, before)


def run(place, *words):
    child = start(place, *words)
    printed, errors = child.communicate()
    return child.returncode, printed, errors


def lines_of(folder):
    return [json.loads(line) for line in (folder / "batch.jsonl").read_text().splitlines()]


def hashes(folder):
    return {
        file["file"]: file["sha256"]
        for record in lines_of(folder)
        for output in record["outputs"]
        for file in output["files"]
    }


def workers(folder):
    """Return processes that draw for this folder's plug-in, and those they come from."""
    found = []
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            try:
                words = Path(f"/proc/{entry}/cmdline").read_bytes()
                variables = Path(f"/proc/{entry}/environ").read_bytes()
            except OSError:
                continue
            if b"app.batch." in words and str(folder).encode() in variables:
                found.append(int(entry))
    return found


@pytest.fixture(scope="module")
def whole(place):
    """Return what the job comes to, undisturbed."""
    folder, _ = place
    return *run(place, "jobs/job.toml", "-o", "whole", "--jobs", "2"), folder / "whole"


def test_bad_meshes_cost_only_themselves(whole):
    code, _, errors, out = whole
    reasons = {record["mesh"].rpartition("/")[2]: record["reason"] for record in lines_of(out)}
    assert reasons == {
        **{f"good{number}.ply": "done" for number in range(GOOD)},
        **{f"broken{kind}.ply": "unreadable" for kind in range(3)},
        "broken3.ply": "no surface",
        "crash.ply": "crashed",
        "hang.ply": "timeout",
        "eat.ply": "memory",
    }
    assert code == 5
    listed = errors[errors.index("7 of 12 meshes failed:") :]
    assert "meshes/crash.ply: crashed: crashed on it (SIGSEGV)" in listed
    assert "meshes/hang.ply: timeout: took more than 2 s" in listed
    assert "meshes/eat.ply: memory: took more than 0.9 GiB of memory" in listed
    assert re.search(r"12/12 meshes/\S+: ", errors)


def test_every_file_is_whole_and_known(whole):
    _, _, _, out = whole
    known = hashes(out)
    assert set(known) == {
        f"good{n}-{kind}.png" for n in range(GOOD) for kind in ("shade", "curvature")
    }
    for name, sha in known.items():
        assert digest((out / name).read_bytes()) == sha
        with Image.open(out / name) as picture:
            assert picture.size == (160, 120)
            assert np.asarray(picture).std() > 5.0
    expected = {*known, "batch.jsonl", "summary.csv", "contact.png", "index.html", ".batch"}
    assert set(os.listdir(out)) == expected
    assert os.listdir(out / ".batch" / "pending") == []


def test_a_line_tells_all_of_a_mesh(whole):
    _, _, _, out = whole
    record = next(one for one in lines_of(out) if one["mesh"] == "../meshes/good2.ply")
    assert record["sha256"] == digest((out / record["mesh"]).read_bytes())
    assert (record["vertices"], record["faces"]) == (14 * 14, 2 * 13 * 13)
    assert any("1 mesh unit is taken as 1 mm" in warning for warning in record["warnings"])
    assert set(record["timings"]) == {"load", "inspect", "curvature", "draw"}
    assert sum(record["timings"].values()) <= record["seconds"]
    shade, curvature = record["outputs"]
    assert (shade["output"], shade["chosen"], shade["material"]) == (
        "shade",
        ["curvature-lut"],
        "skin1",
    )
    assert shade["exitance"]["red"]["p50"] > shade["exitance"]["blue"]["p50"]  # skin
    shares = curvature["percentiles"]["k1"]
    assert shares["p5"] < shares["p50"] < shares["p95"]
    assert curvature["ranges"]["curvedness"][1] > 0.0
    assert record["memory"]["peak_mib"] >= record["memory"]["resident_mib"] > 100.0


def test_sheets_show_every_mesh(whole):
    _, _, _, out = whole
    with (out / "summary.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert [int(row["n"]) for row in rows] == list(range(1, 13))
    by_name = {row["mesh"].rpartition("/")[2]: row for row in rows}
    good = next(one for one in lines_of(out) if one["mesh"].endswith("good1.ply"))
    told = good["outputs"][0]["percentiles"]["curvedness"]["p50"]
    assert float(by_name["good1.ply"]["curvedness_p50"]) == told
    assert by_name["eat.ply"]["reason"] == "memory"
    assert by_name["eat.ply"]["curvedness_p50"] == ""
    page = (out / "index.html").read_text()
    assert page.count("<article>") == 12
    assert page.count('<img src="good') == GOOD
    assert "7 failed" in page
    with Image.open(out / "contact.png") as picture:
        pixels = np.asarray(picture)
    assert pixels.shape[0] == 4 * 220  # four rows of three
    assert (pixels.std(axis=2) > 20.0).mean() > 0.01  # skin and reasons are not grey


def test_no_worker_outlives_its_batch(whole, place):
    assert workers(place[0]) == []


def test_a_batch_writes_the_bytes_of_the_single_commands(place, tmp_path):
    folder, _ = place
    mesh = folder / "meshes" / "good3.ply"
    flags = ["--method", "rusinkiewicz2004", "--material", "marble"]
    models = ["--models", "lambert,wrap", "--difference"]
    batch, single = folder / "many", folder / "one"  # side by side: pictures name their mesh
    single.mkdir()
    outputs = "shade,curvature,compare,figure,report"
    words = ["batch", str(mesh), "--outputs", outputs, *flags, *models]
    assert main([*words, "-o", str(batch), "--jobs", "1", "--quiet"]) == 0
    commands = {
        "shade.png": ["shade", *flags],
        "curvature.png": ["curvature", *flags[:2]],
        "compare.png": ["compare", *flags, *models],
        "figure.png": ["figure", *flags],
    }
    for name, words in commands.items():
        done = single / f"good3-{name}"
        assert main([words[0], str(mesh), *words[1:], "-o", str(done), "--quiet"]) == 0
        theirs, ours = (np.asarray(Image.open(at / done.name)) for at in (batch, single))
        assert np.array_equal(theirs, ours), name
        if name in ("shade.png", "figure.png"):  # whose sessions say all that the batch's do
            assert (batch / done.name).read_bytes() == done.read_bytes()
    told = (batch / "good3-report.html").read_text()
    command = re.search(r"<pre>curvelight (.*)</pre>", told)
    assert command is not None
    again = command[1].split()
    here = os.getcwd()
    try:
        os.chdir(batch)
        again[again.index("-o") + 1] = "again.html"
        assert main([*again, "--quiet"]) == 0
    finally:
        os.chdir(here)
    pictures = [
        re.findall(r"data:image/png;base64,[^\"]*", text)
        for text in (told, (batch / "again.html").read_text())
    ]
    assert pictures[0]
    assert pictures[0] == pictures[1]


def test_resuming_draws_what_is_new_or_changed_or_gone(place):
    folder, _ = place
    words = ["meshes/good0.ply", "meshes/good1.ply", "meshes/good2.ply", "-o", "again"]
    words += ["--outputs", "shade", "--size", "64x48", "--method", METHOD, "--jobs", "1"]
    out = folder / "again"
    sheet(folder / "meshes" / "good2.ply", 14, 2)

    def drawn(*more):
        code, printed, _ = run(place, *words, *more, "--resume", "--json")
        assert code == 0
        records = [json.loads(line) for line in printed.splitlines()]
        return [record["n"] for record in records if not record["resumed"]]

    assert drawn() == [1, 2, 3]
    before = {name: (out / f"good{name}-shade.png").stat().st_mtime_ns for name in range(3)}
    first = hashes(out)
    sheet(folder / "meshes" / "good2.ply", 14, 77)
    (out / "good1-shade.png").write_bytes(b"not what it was")
    assert drawn() == [2, 3]
    assert (out / "good0-shade.png").stat().st_mtime_ns == before[0]
    second = hashes(out)
    assert second["good1-shade.png"] == first["good1-shade.png"]
    assert second["good2-shade.png"] != first["good2-shade.png"]
    sheet(folder / "meshes" / "good2.ply", 14, 2)


def whole_files(out):
    """Make sure that whatever lies in the folder is whole."""
    for path in out.rglob("*"):
        if path.suffix == ".png" and ".batch" not in path.parts:
            with Image.open(path) as picture:
                picture.load()
        elif path.suffix == ".json" and "records" in path.parts and path.name[0] != ".":
            json.loads(path.read_bytes())
        elif path.suffix == ".jsonl":
            assert all(json.loads(line) for line in path.read_text().splitlines())


def until(condition, seconds=300.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.005)


def test_killed_at_any_moment_a_batch_goes_on(place, whole):
    folder, out = place[0], place[0] / "killed"
    words = ["meshes/good*.ply", "-o", "killed", "--size", "160x120", "--method", METHOD]
    words += ["--outputs", "shade,curvature", "--jobs", "1", "--resume", "--quiet"]
    stamps = {}
    for wanted in (1, 3):
        child = start(place, *words)
        until(lambda count=wanted: len(list(out.glob("*.png"))) >= count)
        child.kill()
        child.communicate()
        until(lambda: not workers(folder))  # they end with their parent
        whole_files(out)
        for name, stamp in stamps.items():
            assert (out / name).stat().st_mtime_ns == stamp, "drawn twice"
        stamps = {path.name: path.stat().st_mtime_ns for path in out.glob("good*.png")}
        assert wanted <= len(stamps) < 2 * GOOD
    assert run(place, *words)[0] == 0
    for name, stamp in stamps.items():
        assert (out / name).stat().st_mtime_ns == stamp, "drawn twice"
    assert hashes(out) == hashes(whole[3])


def test_an_interrupted_batch_leaves_a_state_to_go_on_from(place):
    folder, out = place[0], place[0] / "interrupted"
    words = ["meshes/good0.ply", "meshes/hang.ply", "-o", "interrupted", "--method", METHOD]
    words += ["--outputs", "shade", "--size", "64x48", "--jobs", "2"]
    child = start(place, *words)
    until((out / "good0-shade.png").exists)
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=120)
    assert child.returncode == 130
    assert "interrupted" in errors
    assert workers(folder) == []
    assert [one["mesh"] for one in lines_of(out)] == ["../meshes/good0.ply"]


def test_stopping_at_the_first_failure(place):
    words = ["meshes/broken1.ply", "meshes/good0.ply", "meshes/good1.ply", "-o", "stopped"]
    words += ["--outputs", "shade", "--size", "64x48", "--jobs", "1", "--stop-on-error"]
    code, printed, _ = run(place, *words)
    assert code == 5
    assert "2 not begun" in printed
    assert len(lines_of(place[0] / "stopped")) == 1


def test_a_dry_run_tells_and_writes_nothing(tmp_path, capsys):
    out = tmp_path / "out"
    words = ["batch", "sample:torus", "sample:marble-face", "--outputs", "shade", "-o", str(out)]
    words += ["--size", "64x48", "--jobs", "1", "--dry-run", "--json"]
    assert main(words) == 0
    told = json.loads(capsys.readouterr().out)
    assert [mesh["files"] for mesh in told["meshes"]] == [
        ["torus-shade.png"],
        ["marble-face-shade.png"],
    ]
    small, large = (mesh["seconds"] for mesh in told["meshes"])
    assert 0.0 < small < large
    assert 1000 < told["bytes"] < 100_000
    assert not out.exists()


def test_a_table_for_data_frames(whole, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    records = lines_of(whole[3])
    write_parquet(Folder(tmp_path), records)
    table = parquet.read_table(tmp_path / "summary.parquet").to_pydict()
    with (whole[3] / "summary.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert list(table) == list(rows[0])
    told = [None if row["k1_p50"] == "" else float(row["k1_p50"]) for row in rows]
    assert table["k1_p50"] == told
    assert told.count(None) == 7
    assert table["reason"] == [row["reason"] for row in rows]


def test_a_key_follows_mesh_session_names_and_versions(monkeypatch):
    session = Session(mesh="a.ply")
    item = Item(1, "a.ply", (Work("shade", "default", session, "a.png"),), 1.0, 1.0)
    key = key_of(item, "content")
    moved = replace(item.works[0], session=replace(session, mesh="b/a.ply"))
    assert key_of(replace(item, n=7, seconds=9.0, works=(moved,)), "content") == key
    renamed = replace(item.works[0], file="b.png")
    other = replace(item.works[0], session=replace(session, material="marble"))
    monkeypatch.setattr("app.batch.ledger.versions", lambda session: {"curvelight": "9"})
    _versions_of.cache_clear()
    changed = {
        key_of(item, "content"),
        key_of(item, "other content"),
        key_of(replace(item, works=(renamed,)), "content"),
        key_of(replace(item, works=(other,)), "content"),
    }
    _versions_of.cache_clear()
    assert len(changed) == 4
    assert key not in changed
