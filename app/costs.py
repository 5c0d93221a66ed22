"""What shading models cost on this machine, measured once and kept in the user's cache folder."""

import json
import os
import platform
from contextlib import suppress
from pathlib import Path

from app.writing import WriteError, write_bytes
from lutcore.arrays import AnyArray
from lutcore.costs import Cost, costs, forget, remember
from lutcore.progress import Progress, silent

# Version of the file.
_FORMAT = 1


def machine() -> dict[str, str | int]:
    """Describe this machine: times hold on one like it.

    Returns
    -------
    dict
        Processor, cores, threads that shading uses, system, numba's version.
    """
    import numba

    return {
        "processor": _processor(),
        "cores": os.cpu_count() or 1,
        "threads": numba.get_num_threads(),
        "system": platform.system(),
        "numba": numba.__version__,
    }


def measured(progress: Progress = silent, again: bool = False) -> dict[str, Cost]:
    """Return the costs of all models on this machine.

    The file lies in the folder of the compiled code, which a change of that code renames.

    Parameters
    ----------
    progress : callable
        Told where measuring stands.
    again : bool
        Whether to measure what was measured before.

    Returns
    -------
    dict of str to Cost
        By label; see `lutcore.costs.costs`.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    path, here = place(), machine()
    if again:
        forget()
        kept: dict[str, Cost] = {}
    else:
        kept = _read(path, here)
        remember(kept)
    found = costs(progress)
    if found != kept:
        content = {"format": _FORMAT, "machine": here, "costs": found}
        with suppress(WriteError):  # a cache that cannot be kept is measured again
            write_bytes(path, json.dumps(content, indent=2).encode())
    return found


def known() -> bool:
    """Tell whether all models were measured on this machine.

    Returns
    -------
    bool
        False if `measured` would take a while.
    """
    from lutcore.costs import COLORS, PREDICTION, candidates

    kept = _read(place(), machine())
    labels = (*(one.label for one in candidates()), PREDICTION, COLORS)
    return all(label in kept for label in labels)


def in_child() -> dict[str, AnyArray]:
    """Measure what is not known yet, for `lutcore.isolated.run_isolated`.

    Returns
    -------
    dict
        Empty: the figures are in the file at `place`.
    """
    measured()
    return {}


def place() -> Path:
    """Return where the costs are kept.

    Returns
    -------
    Path
        A JSON file; it may not be there.
    """
    from lutcore.compiled import cache_folder

    return cache_folder() / "costs.json"


def _read(path: Path, here: dict[str, str | int]) -> dict[str, Cost]:
    try:
        content = json.loads(path.read_bytes())
        if content["format"] != _FORMAT or content["machine"] != here:
            return {}
        pairs = content["costs"].items()
        return {str(label): Cost(float(each), str(growth)) for label, (each, growth) in pairs}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}  # absent, cut short or of another version: measured again


def _processor() -> str:
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
