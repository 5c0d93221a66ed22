"""``python -m tests.fuzz --minutes N --seed N [--format ply] [--keep FOLDER]``.

Searches for files at which a reader of ours falls over, guided by the lines they reach; exits with
1 if it finds one, and writes it into the folder.
"""

import argparse
import resource
import sys
import tempfile
import time
from pathlib import Path

from tests.corpus.cases import seed_files
from tests.fuzz.search import Search

_ADDRESS_SPACE = 6 << 30


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--format", help="ending of the file names to begin with; else all")
    kept = Path(tempfile.gettempdir()) / "curvelight-fuzz"
    parser.add_argument("--keep", type=Path, default=kept, metavar="FOLDER", help=f"else {kept}")
    options = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (_ADDRESS_SPACE, _ADDRESS_SPACE))
    files = seed_files(children=False)
    if options.format:
        files = {name: content for name, content in files.items() if options.format in name}
        if not files:
            parser.error(f"no file's name has {options.format!r} in it")
    end = time.monotonic() + 60.0 * options.minutes
    with tempfile.TemporaryDirectory() as folder:
        # Should the process die, the folder stays, and in it the file that it was reading.
        print(f"the file being read lies in {folder}")
        search = Search(files, options.seed, Path(folder))
        told = time.monotonic()
        while time.monotonic() < end:
            search.step()
            if time.monotonic() - told > 30.0:
                told = time.monotonic()
                print(_state(search), flush=True)
    print(_state(search))
    for number, (name, content, what) in enumerate(search.faults):
        options.keep.mkdir(parents=True, exist_ok=True)
        path = options.keep / f"{number:03}-{name}"
        path.write_bytes(content)
        print(f"{path}: {what}")
    sys.exit(1 if search.faults else 0)


def _state(search: Search) -> str:
    return (
        f"{search.runs} files read, {len(search.lines.seen)} pairs of lines, {len(search.kept)} "
        f"files kept, {len(search.faults)} faults"
    )


if __name__ == "__main__":
    main()
