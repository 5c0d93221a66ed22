"""What starting costs: ``curvelight --help`` against importing NumPy, as a ratio.

``python -m tests.bench.start [--json]``
"""

import argparse
import json
import subprocess
import sys
import time

from tests.bench.installed import variables

_RUNS = 7


def best(code: str, *arguments: str) -> float:
    """Return the least wall time of some runs of Python code in a fresh process, s."""
    times = []
    for _ in range(_RUNS):
        start = time.perf_counter()
        subprocess.run(
            [sys.executable, "-c", code, *arguments],
            capture_output=True,
            check=True,
            env=variables(),
        )
        times.append(time.perf_counter() - start)
    return min(times)


def ratio() -> dict[str, float]:
    """Return both times and their ratio."""
    ours = best("from app.cli.main import main; main(['--help'])")
    peer = best("import numpy")
    return {"help_s": ours, "import_numpy_s": peer, "ratio": ours / peer}


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    found = ratio()
    if parser.parse_args().json:
        print(json.dumps(found, indent=2))
        return
    print(
        f"curvelight --help {found['help_s']:.3f} s, import numpy {found['import_numpy_s']:.3f} s: "
        f"ratio {found['ratio']:.2f}"
    )


if __name__ == "__main__":
    main()
