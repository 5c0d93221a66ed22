"""The one way from a file's name to a checked mesh."""

import codecs
import hashlib
import os
import stat
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from app.loading.checks import checked
from app.loading.errors import BadContentError, UnreadableFileError
from app.loading.formats import FORMATS, reader
from app.loading.packed import is_packed, unpacked
from app.loading.sniff import sniff
from app.loading.texture import Texture, textured
from lutcore.arrays import FloatArray
from lutcore.errors import MeshError
from lutcore.health import MeshHealth, inspect
from lutcore.mesh import TriangleMesh


@dataclass(frozen=True)
class LoadedMesh:
    """A mesh and what else its file says.

    Parameters
    ----------
    mesh : TriangleMesh
        Every vertex of the file in the file's order; polygons as triangles.
    colors : ndarray of float64, shape=(n, 3), or None
        sRGB-encoded vertex colours, 0 to 1.
    warnings : tuple of str
        What was passed over, mended or assumed.
    path : Path
        The file.
    digest : str
        SHA-256 of the file's bytes, hexadecimal; followed by those of the files it names, if any.
    mm_per_unit : float or None
        Size of a mesh unit, where the file says it.
    texture : Texture or None
        A picture of albedo that is wrapped around the mesh.
    """

    mesh: TriangleMesh
    colors: FloatArray | None
    warnings: tuple[str, ...]
    path: Path
    digest: str
    mm_per_unit: float | None = None
    texture: Texture | None = None

    @cached_property
    def health(self) -> MeshHealth:
        """What is odd about the mesh; worked out when first asked for."""
        return inspect(self.mesh)


def load_mesh(path: str | os.PathLike[str]) -> LoadedMesh:
    """Read a mesh from a file in one of `app.loading.formats.FORMATS`, packed with gzip or not.

    Parameters
    ----------
    path : path-like
        The file. Its format is told by its content; a name that says otherwise is a warning.

    Returns
    -------
    LoadedMesh
        The mesh with all vertices in the file's order, its colours, and what was odd.

    Raises
    ------
    UnreadableFileError
        If the file cannot be read: missing, a folder, forbidden, empty, damaged, cut short or of
        no known format.
    lutcore.errors.MeshError
        If it was read and holds no usable surface.
    """
    path = Path(path)
    try:
        content = _content(path)
        digest = hashlib.sha256(content)
        name = path
        if is_packed(content):
            content = unpacked(content)
            name = path.with_suffix("") if path.suffix.lower() in (".gz", ".gzip") else path
        content = _without_mark(content)
        suffix = name.suffix[1:].lower()
        found = sniff(content, suffix)
        # Absurd numbers overflow before they are found out: that is said by an error, not by a
        # line on standard error.
        with np.errstate(all="ignore"):
            surface = reader(found, path.parent)(content)
            mesh, colors = checked(surface)
            texture = textured(surface, mesh)
    except BadContentError as error:
        raise UnreadableFileError(f"{path}: {error.problem}; {error.advice}") from error
    except MeshError as error:
        raise MeshError(f"{path}: {error}; choose a file with a triangulated surface") from error
    except MemoryError as error:
        raise UnreadableFileError(
            f"{path}: there is not enough memory to read it; decimate the mesh or close programs"
        ) from error
    warnings = list(surface.warnings)
    if suffix != found:
        called = f"is called .{suffix}" if suffix in FORMATS else "has an unknown ending"
        warnings.insert(0, f"the file {called} but holds {found.upper()}: read as {found.upper()}")
    for other in surface.others:
        digest.update(other)
    return LoadedMesh(
        mesh, colors, tuple(warnings), path, digest.hexdigest(), surface.mm_per_unit, texture
    )


def _without_mark(content: bytes) -> bytes:
    # Before a text; in the free header of a binary STL, which a zero byte gives away (its count of
    # triangles has one), the same bytes are content.
    if b"\0" in content[:84]:
        return content
    return content.removeprefix(codecs.BOM_UTF8)


def _content(path: Path) -> bytes:
    try:
        mode = path.stat().st_mode
        if stat.S_ISDIR(mode):
            raise BadContentError("it is a folder", "name a mesh file inside it")
        if not stat.S_ISREG(mode):
            # Opening a pipe or a device could wait, or read, for ever.
            raise BadContentError("it is not a regular file", "save it to a file first")
        content = path.read_bytes()
    except FileNotFoundError:
        raise BadContentError("there is no such file", "check its name and folder") from None
    except PermissionError:
        raise BadContentError("it may not be read", "ask for permission to read it") from None
    except (OSError, ValueError) as error:
        # ValueError: a name with a NUL byte in it.
        reason = getattr(error, "strerror", None) or str(error)
        raise BadContentError(
            f"it cannot be read ({reason})", "check its name and the disk"
        ) from None
    if not content:
        raise BadContentError("it is empty", "copy or export it again")
    return content
