"""Run a reader that may crash, hang or eat the memory in a child process."""

import json
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from app.loading.errors import BadContentError
from app.loading.surface import RawSurface

_ROOT = Path(__file__).parents[2]
# Reading takes about 10 ns a byte; the rest is Python's start on a busy machine.
_SECONDS, _SECONDS_PER_BYTE = 60.0, 1e-6
# VTK's libraries alone map 1 GiB; a compressed file may unfold to many times its size.
_BYTES, _BYTES_PER_BYTE = 4 << 30, 64


def read_guarded(module: str, content: bytes) -> RawSurface:
    """Call ``read(content)`` of a module in a child process with limits.

    Parameters
    ----------
    module : str
        The module: ``"app.loading.vtp_vtk"``.
    content : bytes
        The whole file.

    Returns
    -------
    RawSurface
        What the reader returned.

    Raises
    ------
    BadContentError
        If the reader raised it, crashed, or went beyond its time or memory.
    """
    seconds = _SECONDS + _SECONDS_PER_BYTE * len(content)
    memory = _BYTES + _BYTES_PER_BYTE * len(content)
    with tempfile.TemporaryDirectory(prefix="curvelight-") as folder:
        (Path(folder) / "content").write_bytes(content)
        # -P, so that a folder "app" where the user stands is not taken for ours.
        command = [sys.executable, "-P", "-m", "app.loading.child", module, folder, str(memory)]
        paths = [str(_ROOT), *(entry for entry in sys.path if entry)]
        environment = os.environ | {
            "PYTHONPATH": os.pathsep.join(paths),
            "OPENBLAS_NUM_THREADS": "1",
        }
        try:
            done = subprocess.run(  # noqa: S603  # our own interpreter and module
                command,
                env=environment,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                timeout=seconds,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise BadContentError(f"reading it took more than {seconds:.0f} s") from None
        return _result(Path(folder), done)


def _result(folder: Path, done: subprocess.CompletedProcess[bytes]) -> RawSurface:
    if done.returncode < 0:
        name = signal.Signals(-done.returncode).name
        raise BadContentError(f"its reader crashed on it ({name})")
    answer = folder / "answer.json"
    if done.returncode != 0 or not answer.exists():
        words = done.stderr.decode(errors="replace").strip().splitlines()
        raise BadContentError(f"its reader failed ({words[-1] if words else 'no reason given'})")
    said = json.loads(answer.read_text())
    if "problem" in said:
        raise BadContentError(said["problem"], said["advice"])
    with np.load(folder / "arrays.npz") as arrays:
        return RawSurface(
            arrays["vertices"],
            arrays["corners"],
            arrays["counts"],
            arrays.get("colors"),
            said["warnings"],
        )
