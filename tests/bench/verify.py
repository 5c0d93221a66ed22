"""Whether pictures are reproduced bit for bit: twenty sessions, each verified by another process.

``python -m tests.bench.verify [--keep FOLDER]``
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

_PROGRAM = "import sys; from app.cli.main import main; sys.exit(main())"
_SIZE = ["--size", "400x300", "--quiet"]
PICTURES = {
    "shade": ["shade", "sample:torus"],
    "scan": ["shade", "sample:marble-face"],
    "lambert": ["shade", "sample:ellipsoid", "--model", "lambert"],
    "wrap": ["shade", "sample:saddle", "--model", "wrap", "--width", "0.4"],
    "kolchin": ["shade", "sample:torus", "--model", "kolchin2007"],
    "penner": ["shade", "sample:sphere", "--model", "penner2011"],
    "material": ["shade", "sample:marble-face", "--material", "marble", "--no-albedo"],
    "profile": ["shade", "sample:torus", "--profile", "burley2015"],
    "lights": [
        *("shade", "sample:torus", "--light", "-1,0.5,1,0.7"),
        *("--point-light", "20,20,20,900", "--cone-light", "0,0,40,0,0,-1,20,2000"),
    ],
    "shadows": ["shade", "sample:marble-face", "--shadows", "on"],
    "camera": ["shade", "sample:torus", "--camera", "30,20,40,0,0,0,0,1,0,25"],
    "view": ["shade", "sample:saddle", "--camera", "oblique", "--background", "white"],
    "curvedness": ["curvature", "sample:marble-face"],
    "k1": ["curvature", "sample:torus", "--quantity", "k1", "--symmetric", "--flip"],
    "error": ["curvature", "sample:ellipsoid", "--quantity", "error", "--colormap", "cividis"],
    "all": ["curvature", "sample:saddle", "--quantity", "all", "--size", "800x400"],
    "scale": ["curvature", "sample:marble-face", "--scale", "3", "--flat", "--range", "0,0.5"],
    "figure": ["figure", "sample:ellipsoid", "--exposure", "3"],
    "compare": ["compare", "sample:torus", "--models", "lambert,wrap,curvature-lut"],
    "difference": ["compare", "sample:torus", "--models", "lambert,curvature-lut", "--difference"],
}


def curvelight(*words: str) -> subprocess.CompletedProcess[str]:
    """Run a command in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", _PROGRAM, *words],
        capture_output=True,
        text=True,
        check=False,
    )


def reproduced(folder: Path) -> dict[str, bool]:
    """Make every picture, and verify it."""
    found = {}
    for name, words in PICTURES.items():
        path = str(folder / f"{name}.png")
        size = _SIZE[2:] if "--size" in words else _SIZE
        made = curvelight(*words, "-o", path, *size)
        if made.returncode:
            raise RuntimeError(f"{name}: {made.stderr}")
        verified = curvelight("verify", path, "--json")
        told = json.loads(verified.stdout) if verified.stdout else {"likeness": {"pixels": None}}
        found[name] = verified.returncode == 0 and told["likeness"]["pixels"] == 0
    return found


def main() -> None:
    """Print which pictures are reproduced."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--keep", type=Path, help="folder to leave the pictures in")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        place = options.keep or Path(folder)
        place.mkdir(parents=True, exist_ok=True)
        found = reproduced(place)
    if options.json:
        print(json.dumps(found, indent=2))
        return
    for name, same in found.items():
        print(f"{name:12} {'the same, bit for bit' if same else 'DIFFERS'}")
    print(f"{sum(found.values())} of {len(found)} pictures reproduced bit for bit")


if __name__ == "__main__":
    main()
