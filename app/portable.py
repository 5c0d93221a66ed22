"""The path of a mesh as a picture may tell it to anybody."""

import os
from pathlib import Path

from app.samples import PREFIX


def portable(mesh: str, folder: Path) -> str:
    """Return a mesh's path as it is seen from a folder, free of the user's name.

    Parameters
    ----------
    mesh : str
        `Session.mesh`.
    folder : Path
        Where the picture lies.

    Returns
    -------
    str
        A relative path; the bare name where the way leads through somebody's home folder or to
        another drive.
    """
    if mesh.startswith(PREFIX):
        return mesh
    file, folder = Path(mesh).resolve(), folder.resolve()
    homes = _homes()
    if homes is not None and file.is_relative_to(homes):
        home = homes / file.relative_to(homes).parts[0]
        if not folder.is_relative_to(home):
            return _sayable(file.name)
    try:
        return _sayable(Path(os.path.relpath(file, folder)).as_posix())
    except ValueError:  # on another drive of Windows
        return _sayable(file.name)


def _homes() -> Path | None:
    """Return the folder whose folders are called after users."""
    try:
        home = Path.home().resolve()
    except RuntimeError:
        return None
    # The administrator's home may lie directly below the root, beside everything else.
    return None if home.parent == Path(home.anchor) else home.parent


def _sayable(name: str) -> str:
    # A name that is no proper text, as file systems allow, cannot be said in JSON.
    return name.encode("utf-8", "replace").decode()
