"""Corrupted files: what becomes of them here, in PyVista, trimesh, meshio and PyMeshLab.

``python -m tests.bench.robustness [--files 2000] [--seed N] [--readers A,B] [--jobs 2]
[--seconds 20] [--json]``. Every reader gets every file, with the same limits of time and address
space, in forks of a process that has imported the reader (`tests.bench.robustness_child`).
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter, deque
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from tests.corpus.cases import Case, corpus, seed_files

# Of the processor, for a file; Curvelight's own guard stops a reader after 10 s of it.
SECONDS = 20.0
ADDRESS_SPACE = 6 << 30
READERS = ("curvelight", "pyvista", "trimesh", "meshio", "pymeshlab")
_PART = 50  # files that a reader gets in one go
OUTCOMES = ("mesh", "empty", "refused", "unclear", "garbage", "died", "hung", "memory")


class Server:
    """A process that reads one file after another with one reader, each in a fork of its own."""

    def __init__(self, reader: str, complaints: int = subprocess.DEVNULL) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-W", "ignore", "-m", "tests.bench.robustness_child", reader],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=complaints,
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"},
        )

    def read(self, path: Path, seconds: float = SECONDS) -> dict[str, Any]:
        """Return what became of a file that may take so long; 0: without a fork or a limit."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(f"{seconds} {path}\n".encode())
        self.process.stdin.flush()
        found: dict[str, Any] = json.loads(self.process.stdout.readline())
        return found

    def stop(self) -> None:
        """End the process."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()


def read_all(
    readers: tuple[str, ...], paths: list[Path], jobs: int, seconds: float
) -> dict[str, list[dict[str, Any]]]:
    """Return what became of each file with each reader, in order; `jobs` files at once."""
    found: dict[str, list[dict[str, Any]]] = {reader: [{}] * len(paths) for reader in readers}
    # Readers in turn, so that all of them get the same company.
    waiting = deque((reader, first) for first in range(0, len(paths), _PART) for reader in readers)
    parts = len(waiting)

    def work(_: int) -> None:
        servers: dict[str, Server] = {}
        while True:
            try:
                reader, first = waiting.popleft()
            except IndexError:
                break
            server = servers.get(reader) or Server(reader)
            servers[reader] = server
            for index in range(first, min(first + _PART, len(paths))):
                found[reader][index] = server.read(paths[index], seconds)
            print(f"\r{parts - len(waiting)}/{parts} ", end="", file=sys.stderr, flush=True)
        for server in servers.values():
            server.stop()

    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(work, range(jobs)))
    print(file=sys.stderr)
    return found


def report(
    cases: list[Case],
    readers: tuple[str, ...] = READERS,
    jobs: int = 2,
    seconds: float = SECONDS,
) -> dict[str, dict[str, Any]]:
    """Return each reader's counts of outcomes, its worst time and memory, and what went wrong."""
    valid = seed_files()
    with tempfile.TemporaryDirectory() as folder:
        # Damage is told by its own folder: names must not tell the readers more.
        paths = [Path(folder) / case.name for case in cases]
        for path, case in zip(paths, cases, strict=True):
            path.write_bytes(case.content)
        known = [Path(folder) / f"valid-{name}" for name in valid]
        for path, content in zip(known, valid.values(), strict=True):
            path.write_bytes(content)
        found = read_all(readers, known + paths, jobs, seconds)
    return {reader: _summary(found[reader], list(valid), cases) for reader in readers}


def _summary(found: list[dict[str, Any]], valid: list[str], cases: list[Case]) -> dict[str, Any]:
    reads = {
        name for name, answer in zip(valid, found, strict=False) if answer["outcome"] == "mesh"
    }
    rest = found[len(valid) :]
    counts = Counter(answer["outcome"] for answer in rest)
    wrong = [
        f"{case.name}: {answer['outcome']} {answer.get('said', '')}"
        for case, answer in zip(cases, rest, strict=True)
        if answer["outcome"] not in ("mesh", "refused", "empty")
    ]
    return {
        "formats": len(reads),
        "files of formats it reads": sum(case.seed_file in reads for case in cases),
        **{outcome: counts[outcome] for outcome in OUTCOMES},
        "seconds": sum(answer["seconds"] for answer in found),
        "slowest_s": max(answer["seconds"] for answer in rest),
        "peak_mib": max(answer.get("peak_mib", 0.0) for answer in rest),
        "codes": dict(Counter(str(a["code"]) for a in rest if "code" in a)),
        "wrong": wrong,
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--files", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--readers", default=",".join(READERS), help="some of them, with commas")
    parser.add_argument("--jobs", type=int, default=2, help="files at once")
    parser.add_argument(
        "--seconds", type=float, default=SECONDS, help="of the processor, for one file"
    )
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    readers = tuple(options.readers.split(","))
    unknown = set(readers) - set(READERS)
    if unknown:
        parser.error(f"no reader {', '.join(sorted(unknown))}; there are {', '.join(READERS)}")
    cases = list(corpus(options.files, options.seed))
    began = time.perf_counter()
    found = report(cases, readers, options.jobs, options.seconds)
    took = time.perf_counter() - began
    if options.json:
        print(json.dumps(found, indent=2))
        return
    print(
        f"{len(cases)} corrupted files, seed {options.seed}, {len(seed_files())} valid ones; "
        f"at most {options.seconds:g} s of the processor and {ADDRESS_SPACE >> 30} GiB each; "
        f"{options.jobs} at once, {took:.0f} s in all"
    )
    names = ("formats", "files of formats it reads", *OUTCOMES)
    print("| reader | " + " | ".join(names) + " | all, s | slowest, s | peak, MiB |")
    print("|-" * (len(names) + 4) + "|")
    for reader, row in found.items():
        cells = " | ".join(str(row[name]) for name in names)
        times = f"{row['seconds']:.0f} | {row['slowest_s']:.1f}"
        print(f"| {reader} | {cells} | {times} | {row['peak_mib']:.0f} |")
    for reader, row in found.items():
        if row["codes"]:
            print(f"{reader}: refusals by exit code {row['codes']}")
    for line in found.get("curvelight", {"wrong": []})["wrong"]:
        print(f"curvelight: {line}")


if __name__ == "__main__":
    main()
