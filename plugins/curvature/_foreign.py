"""Other packages' estimators, called in a child process that they may crash."""

from importlib.util import find_spec
from typing import Any

import numpy as np

from lutcore.arrays import AnyArray
from lutcore.errors import ParameterError
from lutcore.isolated import run_isolated
from lutcore.mesh import TriangleMesh
from lutcore.parameters import param
from lutcore.progress import Progress

# The packages' libraries map some GiB; MeshLab keeps about 1 KiB for a vertex with its faces.
_BYTES, _BYTES_PER_VERTEX = 6 << 30, 16 << 10
# Start of the interpreter and of the libraries on a busy machine.
_SECONDS = 20.0
# Modules that a package's functions import, where their names are not the package's.
_MODULES = {"libigl": ("igl",), "trimesh": ("trimesh", "rtree"), "vtk": ("vtkmodules",)}


def patience() -> Any:
    """Declare the parameter `patience` of a plug-in that calls another package.

    Returns
    -------
    dataclasses.Field
        A field for the plug-in's frozen dataclass.
    """
    doc = "Time for each vertex after which the other package is stopped."
    return param(10.0, 0.01, 1e6, "ms", doc)


def foreign(
    function: str,
    package: str,
    mesh: TriangleMesh,
    milliseconds: float,
    progress: Progress,
    **arguments: float | str,
) -> dict[str, AnyArray]:
    """Call a function of `plugins.curvature._foreign_child`.

    Parameters
    ----------
    function : str
        Its name.
    package : str
        What it needs, by the name that pip knows.
    mesh : TriangleMesh
        The surface.
    milliseconds : float
        Time that it may take for each vertex.
    progress : callable
        Asked now and then whether to stop.
    **arguments : float or str
        What else the function takes.

    Returns
    -------
    dict of str to ndarray
        What it returned.

    Raises
    ------
    ParameterError
        If the package is not installed.
    IsolatedError
        If it failed, crashed, or went beyond its time or memory.
    CancelledError
        If `progress` asked to stop.
    """
    missing = [name for name in _MODULES.get(package, (package,)) if find_spec(name) is None]
    if missing:
        names = " ".join(package if name == "igl" else name for name in missing)
        raise ParameterError(
            f"this curvature estimator needs {names}, which is not installed (pip install {names})"
        )
    return run_isolated(
        f"plugins.curvature._foreign_child:{function}",
        {
            "vertices": mesh.vertices,
            "faces": mesh.faces,
            **{name: np.array(value) for name, value in arguments.items()},
        },
        label=package,
        seconds=_SECONDS + 1e-3 * milliseconds * len(mesh.vertices),
        memory=_BYTES + _BYTES_PER_VERTEX * len(mesh.vertices),
        keep=True,
        progress=progress,
    )
