"""The versions of what pixels depend on, found without importing what draws."""

import platform
import re
from collections.abc import Iterator
from functools import cache
from importlib.metadata import (
    Distribution,
    EntryPoint,
    PackageNotFoundError,
    distribution,
    entry_points,
)

from app.contestants import alone
from app.session import Session
from lutcore.registry import built_in

MAKER = "curvelight"
"""The package whose version says which program made a picture."""
_VERSION = re.compile(r"^Version:(.+)$", re.MULTILINE)
# Whatever a pixel can depend on beside the session, the mesh and the driver.
_PACKAGES = (
    MAKER,
    "numpy",
    "scipy",
    "numba",
    "llvmlite",
    "vtk",
    "matplotlib",
    "pillow",
    "colour-science",
    "pymeshlab",
    "libigl",
    "trimesh",
)


def versions(session: Session) -> dict[str, str]:
    """Return the versions that pixels depend on beside the mesh, the machine and the driver.

    Parameters
    ----------
    session : Session
        Plug-ins that it names may come from other packages.

    Returns
    -------
    dict of str to str
        By package; those that are not installed are left out.
    """
    return _installed() | dict(_outside(session))


@cache
def _installed() -> dict[str, str]:
    """Return the versions of what is installed; the answer stays."""
    found = {"Python": platform.python_version()}
    for package in _PACKAGES:
        try:
            found[package] = _version(distribution(package))
        except PackageNotFoundError:
            continue
    return found


def _version(package: Distribution) -> str:
    # From its line: to parse all that a package says of itself takes 10 ms for a dozen of them.
    line = _VERSION.search(package.read_text("METADATA") or "")
    return line[1].strip() if line else package.version


def _outside(session: Session) -> Iterator[tuple[str, str]]:
    """Name the packages that the session's plug-ins come from, if it is not this one."""
    parts = (session, *alone(session))
    named = {
        "shading": [part.model for part in parts],
        "curvature": [*(part.estimator for part in parts), *session.peers],
        "profile": (session.profile,),
    }
    for kind, methods in named.items():
        # Built-in ones come first, and asking all packages takes 10 ms a kind.
        wanted = {method.name for method in methods} - built_in(f"plugins.{kind}")
        for entry in _entries(f"curvelight.{kind}") if wanted else ():
            if entry.name in wanted and entry.dist is not None:
                yield entry.dist.name, entry.dist.version


@cache
def _entries(group: str) -> tuple[EntryPoint, ...]:
    return tuple(entry_points(group=group))
