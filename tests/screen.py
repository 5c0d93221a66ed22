"""A virtual screen for tests and measurements of the window."""

import ctypes
import os
import shutil
import signal
import subprocess
import tempfile


def start_screen() -> None:
    """Start Xvfb for this process, whatever screen there is, and let Qt use it.

    It ends with the process, for it must outlive Qt, which lives until the very end.

    Raises
    ------
    RuntimeError
        If Xvfb is missing or does not start.
    """
    xvfb = shutil.which("Xvfb")
    if xvfb is None:
        raise RuntimeError("Xvfb is missing; ./dev setup installs it")
    read, write = os.pipe()
    with tempfile.TemporaryFile() as log:
        subprocess.Popen(
            [xvfb, "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
            pass_fds=(write,),
            stderr=log,
            preexec_fn=_end_with_parent,  # noqa: PLW1509  it only asks for a signal
        )
        os.close(write)
        with os.fdopen(read) as answers:
            number = answers.readline().strip()
        if not number:
            log.seek(0)
            raise RuntimeError(f"Xvfb did not start: {log.read().decode()}")
    os.environ.update(DISPLAY=f":{number}", QT_QPA_PLATFORM="xcb", QT_API="pyside6")


def _end_with_parent() -> None:
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)
