"""Runs every measurement of the README: ``python -m tests.bench``."""

import subprocess
import sys

SCRIPTS = (
    "start",
    "opening",
    "first_call",
    "shading_accuracy",
    "shading_truth",
    "shading_speed",
    "detail",
    "gather",
    "prediction",
    "curvature",
    "error_bars",
    "steadiness",
    "growth",
    "bandwidth",
    "loading_speed",
    "pictures",
    "batch",
    "verify",
    "window",
    "monkey",
)


def main() -> None:
    """Run the scripts one after another, each in its own process so that none warms another."""
    for script in SCRIPTS:
        print(f"== python -m tests.bench.{script}", flush=True)
        subprocess.run([sys.executable, "-m", f"tests.bench.{script}"], check=True)


if __name__ == "__main__":
    main()
