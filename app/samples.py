"""The sample meshes, by the names that stand wherever a mesh file does: ``sample:NAME``."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

from app.session import Vector
from lutcore.errors import ParameterError

PREFIX = "sample:"


@dataclass(frozen=True)
class Sample:
    """One sample mesh.

    Parameters
    ----------
    name : str
        What follows ``sample:``.
    summary : str
        What it is and what it is good for.
    path : Path
        The file to read.
    mm_per_unit : float
        Size of a mesh unit.
    exact : Path or None
        npz with the exact k1, k2, d1, d2, normals at its vertices, for analytic shapes.
    view, up : tuple of 3 floats
        From the mesh to the camera, and what is up.
    remark : str
        What the user must be told of it, else empty.
    """

    name: str
    summary: str
    path: Path
    mm_per_unit: float
    exact: Path | None
    view: Vector
    up: Vector
    remark: str


def names() -> list[str]:
    """Return the samples' names in the catalogue's order.

    Returns
    -------
    list of str
        Without the prefix.
    """
    return list(_catalogue())


def sample(name: str) -> Sample:
    """Return one sample.

    Parameters
    ----------
    name : str
        With or without the prefix.

    Returns
    -------
    Sample
        What it is and where its file lies.

    Raises
    ------
    ParameterError
        If there is none of that name, or the package that ships it does not hold it any more.
    """
    name = name.removeprefix(PREFIX)
    if name not in _catalogue():
        raise ParameterError.unknown("sample", name, names())
    entry = _catalogue()[name]
    path, remark = _locate(name, entry.get("wheel"), entry.get("file"))
    return Sample(
        name=name,
        summary=entry["summary"],
        path=path,
        mm_per_unit=entry["mm_per_unit"],
        exact=_folder() / entry["exact"] if "exact" in entry else None,
        view=tuple(entry.get("view", (0.0, 0.0, 1.0))),
        up=tuple(entry.get("up", (0.0, 1.0, 0.0))),
        remark=remark,
    )


def _locate(name: str, wheel: str | None, file: str | None) -> tuple[Path, str]:
    if wheel is None and file is not None:
        return _folder() / file, ""
    package, _, inside = (wheel or "").partition("/")
    # find_spec does not import the package: pymeshlab takes half a second.
    spec = find_spec(package)
    for root in spec.submodule_search_locations or [] if spec else []:
        path = Path(root) / inside
        if path.is_file():
            return path, ""
    if file is None:
        raise ParameterError(
            f"sample {name!r} is shipped by the package {package}, whose installed version has it "
            f"no more; choose another of: {', '.join(names())}"
        )
    return _folder() / file, f"{package} ships {inside} no more; the cleaned copy {file} is used"


def _folder() -> Path:
    return Path(str(files("sample_meshes")))


@cache
def _catalogue() -> dict[str, dict]:  # type: ignore[type-arg]
    with (_folder() / "catalogue.toml").open("rb") as stream:
        return tomllib.load(stream)
