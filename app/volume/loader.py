"""From a path to a checked mesh, whether the path is a mesh or a volume."""

import hashlib
import os
from dataclasses import replace
from pathlib import Path

import numpy as np

from app.loading import LoadedMesh, UnreadableFileError, load_mesh
from app.loading.errors import BadContentError
from app.session import Volume
from app.volume.source import Source
from lutcore.arrays import AnyArray
from lutcore.errors import MeshError
from lutcore.isolated import IsolatedError, ShortageError, run_isolated
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, silent

# Marching cubes takes .1 us a voxel, and a compressed file may have a thousand for each byte.
_SECONDS, _SECONDS_PER_BYTE = 180.0, 4e-6
# VTK's libraries alone map 1 GiB.
_LIBRARIES = 2 << 30
_CHUNK = 1 << 22
_UNUSED = "it is a mesh, not a volume: level and smoothing are not used"


def load_surface(source: Source, volume: Volume, progress: Progress = silent) -> LoadedMesh:
    """Read a mesh, or the surface of a volume.

    Parameters
    ----------
    source : Source
        What the path is.
    volume : Volume
        Level and smoothing, for a volume.
    progress : callable
        Told that the work goes on; see `lutcore.progress`.

    Returns
    -------
    LoadedMesh
        Of a volume: the surface in its file's world coordinates, its normals towards lower values;
        the digest is that of its files one after another. What was chosen and assumed is among
        the warnings.

    Raises
    ------
    UnreadableFileError
        If a file cannot be read: missing, damaged, cut short or too large.
    lutcore.errors.MeshError
        If there is no usable surface.
    CancelledError
        If `progress` asked to stop.
    """
    if source.format is None:
        loaded = load_mesh(source.path)
        if volume == Volume():
            return loaded
        return replace(loaded, warnings=(*loaded.warnings, _UNUSED))
    try:
        found = _extracted(source, volume, progress)
        digest = _digest(source)
    except BadContentError as error:
        raise UnreadableFileError(f"{source.path}: {error.problem}; {error.advice}") from None
    except MeshError as error:
        raise MeshError(f"{source.path}: {error}; choose another --level or file") from None
    return LoadedMesh(
        TriangleMesh(found["vertices"], found["faces"]),
        None,
        (_described(found, volume), *found["warnings"].tolist()),
        source.path,
        digest,
        1.0 if found["millimetres"] else None,
    )


def _extracted(source: Source, volume: Volume, progress: Progress) -> dict[str, AnyArray]:
    size, memory = sum(_size(one) for one in source.files), _memory()
    try:
        found = run_isolated(
            "app.volume.child:read",
            {
                "module": np.array(f"app.volume.{source.format}"),
                "files": np.array([str(one) for one in source.files]),
                "level": np.array(np.nan if volume.level is None else volume.level),
                "smoothing": np.array(volume.smoothing),
                "memory": np.array(memory),
            },
            label="its reader",
            seconds=_SECONDS + _SECONDS_PER_BYTE * size,
            memory=_LIBRARIES + memory,
            progress=progress,
        )
    except ShortageError as error:
        raise BadContentError(
            f"needs more than {error.memory >> 30} GiB of memory to read",
            "crop it, export it with larger voxels, or read it where there is more memory",
        ) from None
    except IsolatedError as error:
        raise BadContentError(
            str(error), "it is damaged, or too large for this machine: crop it or export it again"
        ) from None
    if "problem" in found:
        raise BadContentError(str(found["problem"]), str(found["advice"]))
    if "none" in found:
        raise MeshError(str(found["none"]))
    return found


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except FileNotFoundError:
        raise BadContentError(
            f"its data should be in {path.name!r}, which is not there",
            "copy all files of the volume to one folder",
        ) from None
    except OSError as error:
        raise _unreadable(path, error) from None


def _unreadable(path: Path, error: OSError) -> BadContentError:
    return BadContentError(
        f"{path.name} cannot be read ({error.strerror})", "check its permissions and the disk"
    )


def _memory() -> int:
    """Return what a reader may take: three quarters of the machine's memory."""
    try:
        return 3 * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 4
    except (AttributeError, OSError, ValueError):  # Windows does not say
        return 8 << 30


def _digest(source: Source) -> str:
    """Return the SHA-256 of the files' bytes, one after another."""
    digest = hashlib.sha256()
    for path in source.files:
        try:
            with path.open("rb") as stream:
                while chunk := stream.read(_CHUNK):
                    digest.update(chunk)
        except OSError as error:
            raise _unreadable(path, error) from None
    return digest.hexdigest()


def _described(found: dict[str, AnyArray], volume: Volume) -> str:
    shape = " x ".join(str(count) for count in found["shape"])
    spacing = " x ".join(f"{length:.4g}" for length in found["spacing"])
    unit = "mm" if found["millimetres"] else "mesh units"
    how = "given" if volume.level is not None else "Otsu's; --level takes another"
    smooth = f", after smoothing by {volume.smoothing:g} voxels" if volume.smoothing else ""
    return (
        f"a volume of {shape} voxels, {spacing} {unit} apart: its surface at level "
        f"{float(found['level']):.6g} ({how}){smooth}"
    )
