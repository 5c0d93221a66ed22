"""Corrupted files: what becomes of them here, in PyVista, trimesh, meshio and PyMeshLab.

``python -m tests.bench.robustness [--files 2000] [--seed N] [--json]``. Every reader gets every
file in a process of its own, forked from one that has imported the reader, with the same limits of
time and address space.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from tests.corpus.cases import Case, corpus, seed_files

# A file; Curvelight's own guard stops a reader after 10 s of the processor, or 60 s of waiting.
SECONDS = 70.0
ADDRESS_SPACE = 6 << 30
READERS = ("curvelight", "pyvista", "trimesh", "meshio", "pymeshlab")
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
        """Return what became of a file that may take so long; 0: without a fork, far faster."""
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


def read_all(reader: str, paths: list[Path]) -> list[dict[str, Any]]:
    """Return what became of each file, in order."""
    server = Server(reader)
    found = [server.read(path) for path in paths]
    server.stop()
    return found


def report(cases: list[Case], readers: tuple[str, ...] = READERS) -> dict[str, dict[str, Any]]:
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

        # Ours beside the four peers in turn.
        def summary(reader: str) -> dict[str, Any]:
            row = _summary(read_all(reader, known + paths), list(valid), cases)
            print(f"{reader}: {json.dumps(row)}", file=sys.stderr, flush=True)
            return row

        with ThreadPoolExecutor(2) as pool:
            return dict(zip(readers, pool.map(summary, readers), strict=True))


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
    parser.add_argument("--readers", default=",".join(READERS))
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    cases = list(corpus(options.files, options.seed))
    found = report(cases, tuple(options.readers.split(",")))
    if options.json:
        print(json.dumps(found, indent=2))
        return
    print(f"{len(cases)} corrupted files, seed {options.seed}, {len(seed_files())} valid ones")
    names = ("formats", "files of formats it reads", *OUTCOMES)
    print("| reader | " + " | ".join(names) + " | slowest, s | peak, MiB |")
    print("|-" * (len(names) + 3) + "|")
    for reader, row in found.items():
        cells = " | ".join(str(row[name]) for name in names)
        print(f"| {reader} | {cells} | {row['slowest_s']:.1f} | {row['peak_mib']:.0f} |")
    for reader, row in found.items():
        if row["codes"]:
            print(f"{reader}: refusals by exit code {row['codes']}")
    for line in found.get("curvelight", {"wrong": []})["wrong"]:
        print(f"curvelight: {line}")


if __name__ == "__main__":
    main()
