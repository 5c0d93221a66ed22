"""Say whether this machine can draw, what does it, what is missing and how to get it."""

import argparse
import json
import platform
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from app import gl
from app.cli.console import answer

_PACKAGES = ("curvelight", "numpy", "numba", "vtk", "pyvista", "pymeshlab", "trimesh")
_LIMIT_S = 60.0


def add_arguments(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Declare the command's flags.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    words : list of str
        The command's arguments.
    """
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : Namespace
        Of the command.

    Returns
    -------
    int
        Exit code: 0 if pictures can be drawn, else 1.
    """
    from lutcore.compiled import cache_folder

    missing = gl.missing_libraries()
    drawing: dict[str, Any] = {}
    problem = "OpenGL is not here"
    if not missing:
        drawing, problem = _probe()
        missing = drawing.pop("missing", [])
        problem = "no driver answers" if missing else problem
    advice = _advice(missing, problem)
    result: dict[str, object] = {
        "system": platform.platform(),
        "python": platform.python_version(),
        "packages": {name: _version(name) for name in _PACKAGES},
        "cores": _cores(),
        "compiled_code": str(cache_folder()),
        "drawing": drawing or None,
        "missing_system_packages": missing,
        "problem": problem,
        "advice": advice,
    }
    answer(arguments, result, _report(result, drawing))
    return 1 if problem else 0


def _probe() -> tuple[dict[str, Any], str]:
    """Draw in a child process: a broken driver ends that, not us."""
    try:
        child = subprocess.run(
            # -P: a folder called app where we happen to run is not ours.
            [sys.executable, "-P", "-m", "app.gl_probe"],
            capture_output=True,
            text=True,
            timeout=_LIMIT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return {}, f"drawing did not end within {_LIMIT_S:.0f} s"
    if child.returncode:
        last = child.stderr.strip().splitlines()[-1:] or ["no message"]
        return {}, f"drawing ended with code {child.returncode}: {last[0]}"
    found: dict[str, Any] = json.loads(child.stdout.splitlines()[-1])
    return found, ""


def _advice(missing: list[str], problem: str) -> str:
    if missing:
        return f"as root: apt-get install {' '.join(missing)}"
    if problem:
        return "update the graphics driver, or use Mesa's: as root apt-get install libgl1-mesa-dri"
    return ""


def _report(result: dict[str, object], drawing: dict[str, Any]) -> str:
    lines = [f"{result['system']}, Python {result['python']}, {result['cores']} cores"]
    packages = result["packages"]
    if isinstance(packages, dict):
        lines.append(", ".join(f"{name} {found}" for name, found in packages.items()))
    lines.append(f"compiled code is kept in {result['compiled_code']}")
    if drawing:
        kind = "software" if drawing["software"] == "yes" else "hardware"
        lines.append(
            f"pictures are drawn by {drawing['renderer']} ({kind}), OpenGL {drawing['version']}, "
            f"through {drawing['window']}"
        )
        lines.append("all is well")
    else:
        lines += [
            f"pictures cannot be drawn: {result['problem']}",
            f"what to do: {result['advice']}",
        ]
    return "\n".join(lines)


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"


def _cores() -> int:
    import numba

    return int(numba.get_num_threads())
