"""Load every file of a folder with little memory and say in JSON what became of each.

Run as ``python -m tests.load_all FOLDER``; a child process, so that a crash is seen as one.
"""

import json
import resource
import sys
import time
from pathlib import Path

import numpy as np

# The compiled code and NumPy's threads map more than they use; a count believed from a damaged
# header would go far beyond this.
_ADDRESS_SPACE = 6 << 30


def main(folder: Path) -> None:
    """Write ``answer.json`` into the folder."""
    resource.setrlimit(resource.RLIMIT_AS, (_ADDRESS_SPACE, _ADDRESS_SPACE))
    from app.loading import load_mesh
    from lutcore.errors import MeshError

    answer = {}
    for path in sorted(folder.iterdir()):
        began = time.perf_counter()
        try:
            mesh = load_mesh(path).mesh
            sound = np.isfinite(mesh.vertices).all() and mesh.faces.max() < len(mesh.vertices)
            outcome = "mesh" if sound and len(mesh.faces) and mesh.faces.min() >= 0 else "garbage"
        except MeshError as error:
            outcome = "refused" if "\n" not in str(error) and str(path) in str(error) else "unclear"
        except Exception as error:
            outcome = f"escaped: {error!r}"
        answer[path.name] = outcome, time.perf_counter() - began
    (folder / "answer.json").write_text(json.dumps(answer))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
