"""A batch of 200 meshes, 20 of them broken: speed, memory, and what kill -9 leaves.

``python -m tests.bench.batch [--json] [--meshes N]`` draws them with two workers and prints the
throughput over the good ones beside a plain PyVista loop over the same (load, plot off screen,
screenshot; same size of picture, all start-up counted), how the memory of the workers grows, and
how a batch that is killed ten times and resumed compares to one that was left alone.
"""

import argparse
import json
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path

from tests.batches import CRASH, EAT, HANG, METHOD, broken, install, sheet
from tests.bench import installed

_SIDE = 70  # of a good sheet: 4,900 vertices
_SIZE = (1024, 768)
_KILLS = 10
_EARLY = 10
_PYVISTA = """
import sys, pyvista
for number, path in enumerate(sys.argv[2:]):
    mesh = pyvista.read(path)
    plotter = pyvista.Plotter(off_screen=True, window_size=(1024, 768))
    plotter.add_mesh(mesh)
    plotter.screenshot(f"{sys.argv[1]}/{number}.png")
    plotter.close()
"""
_PROGRAM = "import sys; from app.cli.program import program; sys.exit(program())"
_OURS = [sys.executable, "-c", _PROGRAM]
_JOB = f"""
meshes = "meshes/*.ply"
outputs = ["shade"]
[defaults]
size = [{_SIZE[0]}, {_SIZE[1]}]
estimator.name = "{METHOD}"
[[blocks]]
match = "*hang.ply"
seconds = 3
[[blocks]]
match = "*eat.ply"
memory_gib = 1
"""


def meshes(folder: Path, count: int) -> list[Path]:
    """Write the meshes, a tenth of them broken; return the good ones."""
    folder.mkdir()
    deadly = {0: ("crash", CRASH), 3: ("hang", HANG), 7: ("crash", CRASH), 11: ("eat", EAT)}
    good, every, found = [], 10, 0
    for number in range(count):
        if number % every != every // 2:
            good.append(sheet(folder / f"{number:03}.ply", _SIDE + number % 7, number))
            continue
        if found in deadly:
            name, side = deadly[found]
            sheet(folder / f"{number:03}-{name}.ply", side)
        else:
            broken(folder / f"{number:03}-broken.ply", found)
        found += 1
    return good


def timed(command: list[str], variables: dict[str, str], folder: Path) -> tuple[float, float, int]:
    """Return wall time and processor time of a command with its children, and its exit code."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(  # noqa: PLW1510  the code is looked at
        command, cwd=folder, env=variables, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    wall = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = sum(getattr(after, one) - getattr(before, one) for one in ("ru_utime", "ru_stime"))
    return wall, used, done.returncode


def batch(out: str) -> list[str]:
    """Return the command that draws the job with two workers."""
    return [*_OURS, "batch", "job.toml", "-o", out, "--jobs", "2", "--quiet"]


def records(out: Path) -> list[dict]:
    """Return what the batch says of each mesh."""
    return [json.loads(line) for line in (out / "batch.jsonl").read_text().splitlines()]


def hashes(out: Path) -> dict[str, str]:
    """Return the digests of all results."""
    return {
        file["file"]: file["sha256"]
        for record in records(out)
        for output in record["outputs"]
        for file in output["files"]
    }


def growth(folder: Path, variables: dict[str, str]) -> dict[str, float]:
    """Return the peak in MiB of one worker that draws all meshes it survives."""
    text = _JOB.replace('"meshes/*.ply"', '["meshes/???.ply", "meshes/*broken.ply"]')
    (folder / "steady.toml").write_text(text)
    words = ["batch", "steady.toml", "-o", "steady", "--jobs", "1", "--quiet"]
    timed([*_OURS, *words], variables, folder)
    peaks = {
        record["worker"]["meshes"]: record["memory"]["peak_mib"]
        for record in records(folder / "steady")
    }
    return {
        "meshes_of_one_worker": max(peaks),
        "peak_mib_at_10th": peaks[_EARLY],
        "peak_mib_at_last": peaks[max(peaks)],
    }


def killed(folder: Path, variables: dict[str, str], wall: float) -> dict[str, object]:
    """Kill a batch at random moments, resume it each time, and compare."""
    out, chance = folder / "killed", random.Random(7)
    stamps: dict[str, int] = {}
    twice = 0
    for _ in range(_KILLS):
        child = subprocess.Popen(
            [*batch("killed"), "--resume"], cwd=folder, env=variables, stderr=subprocess.DEVNULL
        )
        lines = out / ".batch" / "records"
        known = len(list(lines.glob("*.json")))
        # Starting is no work that could be lost.
        while child.poll() is None and len(list(lines.glob("*.json"))) <= known + 1:
            time.sleep(0.01)
        time.sleep(chance.uniform(0.0, wall / (2.0 * _KILLS)))
        child.kill()
        child.wait()
        there = {path.name: path.stat().st_mtime_ns for path in out.glob("0*.png")}
        there |= {path.name: path.stat().st_mtime_ns for path in out.glob("1*.png")}
        twice += sum(there.get(name) != stamp for name, stamp in stamps.items())
        stamps = there
    before = len(stamps)
    code = timed([*batch("killed"), "--resume"], variables, folder)[2]
    twice += sum((out / name).stat().st_mtime_ns != stamp for name, stamp in stamps.items())
    return {
        "kills": _KILLS,
        "results_at_the_last_kill": before,
        "drawn_twice": twice,
        "same_hashes": hashes(out) == hashes(folder / "whole"),
        "exit_code": code,
    }


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--meshes", type=int, default=200)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        good = meshes(folder / "meshes", arguments.meshes)
        variables = installed.variables() | install(folder / "plugin")
        (folder / "job.toml").write_text(_JOB)
        (folder / "warm.toml").write_text(_JOB.replace("*.ply", "000.ply"))
        warm = [word.replace("job.toml", "warm.toml") for word in batch("warm")]
        subprocess.run(warm, cwd=folder, env=variables, check=True, stdout=subprocess.DEVNULL)
        (folder / "plain").mkdir()
        loop = [sys.executable, "-c", _PYVISTA, "plain", *map(str, good)]
        pyvista_wall, pyvista_used, code = timed(loop, variables, folder)
        if code != 0 or len(list((folder / "plain").glob("*.png"))) != len(good):
            raise RuntimeError("the PyVista loop failed")
        wall, used, code = timed(batch("whole"), variables, folder)
        done = records(folder / "whole")
        reasons = defaultdict(int)
        for record in done:
            reasons[record["reason"]] += 1
        found = {
            "meshes": len(done),
            "good": len(good),
            "exit_code": code,
            "reasons": dict(reasons),
            "batch_s": wall,
            "pyvista_s": pyvista_wall,
            "times_faster": pyvista_wall / wall,
            "batch_processor_s": used,
            "pyvista_processor_s": pyvista_used,
            "times_faster_per_processor_second": pyvista_used / used,
            **growth(folder, variables),
            **killed(folder, variables, wall),
        }
    if arguments.json:
        print(json.dumps(found, indent=2))
        return
    told = ", ".join(f"{count} {reason}" for reason, count in sorted(reasons.items()))
    print(
        f"{found['meshes']} meshes: {told}; good ones drawn {found['times_faster']:.2f} times as "
        f"fast with two workers as by a plain PyVista loop ({wall:.1f} s against "
        f"{pyvista_wall:.1f} s), {found['times_faster_per_processor_second']:.2f} times per second "
        "of processor time\n"
        f"peak memory of a worker at its 10th mesh {found['peak_mib_at_10th']:.1f} MiB, at its "
        f"{found['meshes_of_one_worker']}th {found['peak_mib_at_last']:.1f} MiB\n"
        f"killed {found['kills']} times and resumed, {found['results_at_the_last_kill']} results "
        f"there at the last time: {found['drawn_twice']} drawn twice, "
        f"{'the same' if found['same_hashes'] else 'OTHER'} hashes as undisturbed"
    )


if __name__ == "__main__":
    main()
