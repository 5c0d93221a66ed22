"""How much memory processes take, asked of the system."""

import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

_KIB_PER_MIB = 1024.0


def watched() -> bool:
    """Tell whether the memory of another process can be seen here.

    Returns
    -------
    bool
        True on Linux and where there is a ``ps``; a limit holds only there.
    """
    return Path("/proc/self/statm").exists() or _ps() is not None


def resident(pid: int) -> int | None:
    """Return the memory that a process holds now.

    Address space says nothing here: drivers and compilers map far more than they touch.

    Parameters
    ----------
    pid : int
        Of a process of this user.

    Returns
    -------
    int or None
        Bytes; None if the process has gone or the system does not say.
    """
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except FileNotFoundError:
        return None if Path("/proc/self/statm").exists() else _asked(pid)
    except (OSError, ValueError, IndexError):
        return None
    import resource

    return pages * resource.getpagesize()


def own() -> dict[str, float | None]:
    """Return the memory of this process.

    Returns
    -------
    dict
        ``peak_mib`` since its start and ``resident_mib`` now; None where the system does not say.
    """
    try:
        # Not from getrusage: its peak is inherited from the process that started this one.
        lines = Path("/proc/self/status").read_text().splitlines()
        held = dict(line.split(":", 1) for line in lines if ":" in line)
        return {
            name: int(held[field].split()[0]) / _KIB_PER_MIB
            for name, field in (("peak_mib", "VmHWM"), ("resident_mib", "VmRSS"))
        }
    except (OSError, KeyError, ValueError):
        return {"peak_mib": _peak(), "resident_mib": None}


def _peak() -> float | None:
    try:
        import resource
    except ImportError:  # Windows
        return None
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most / _KIB_PER_MIB ** (2 if sys.platform == "darwin" else 1)


@cache
def _ps() -> str | None:
    return shutil.which("ps")


def _asked(pid: int) -> int | None:
    program = _ps()
    if program is None:
        return None
    command = [program, "-o", "rss=", "-p", str(pid)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    return int(done.stdout) * 1024 if done.stdout.strip().isdigit() else None
