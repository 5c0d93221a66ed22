"""What figures of speed were measured with."""

import platform
from importlib.metadata import PackageNotFoundError, version

_PACKAGES = ("curvelight", "numpy", "numba", "vtk", "pymeshlab", "libigl", "trimesh")


def machine() -> dict[str, str]:
    """Return what a reader must know to repeat a measurement of time.

    Returns
    -------
    dict of str to str
        Cores in use, system, Python, and the version of each package; those that are not
        installed are left out.
    """
    import numba

    found = {
        "cores": str(numba.get_num_threads()),
        "system": f"{platform.system()} {platform.machine()}",
        "Python": platform.python_version(),
    }
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
