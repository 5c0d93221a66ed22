"""What `app.volume.loader` calls in the child process: a reader and marching cubes."""

import importlib
from pathlib import Path

import numpy as np

from app.loading.errors import BadContentError
from app.volume.grid import check_affine
from app.volume.marching import surface
from lutcore.arrays import AnyArray
from lutcore.errors import MeshError


def read(
    module: AnyArray, files: AnyArray, level: AnyArray, smoothing: AnyArray, memory: AnyArray
) -> dict[str, AnyArray]:
    """Read a volume and return its surface.

    Parameters
    ----------
    module : ndarray of str, shape=()
        The reader's module.
    files : ndarray of str, shape=(f,)
        Its files.
    level : ndarray of float64, shape=()
        Where the surface lies; NaN takes Otsu's.
    smoothing : ndarray of float64, shape=()
        Sigma, voxels.
    memory : ndarray of int64, shape=()
        Bytes of memory there are.

    Returns
    -------
    dict of str to ndarray
        vertices, faces, level, shape, spacing, millimetres and warnings; or the problem and the
        advice of a `BadContentError`, or the reason why there is no surface.
    """
    try:
        # Absurd numbers overflow before they are found out.
        with np.errstate(all="ignore"):
            grid = importlib.import_module(str(module)).read(tuple(map(Path, files)), int(memory))
            check_affine(grid.affine)
        given = None if np.isnan(level) else float(level)
        vertices, faces, chosen = surface(grid, given, float(smoothing))
    except BadContentError as error:
        return {"problem": np.array(error.problem), "advice": np.array(error.advice)}
    except OSError as error:
        return {
            "problem": np.array(f"it cannot be read ({error.strerror or error})"),
            "advice": np.array("check its files and the disk"),
        }
    except MeshError as error:
        return {"none": np.array(str(error))}
    return {
        "vertices": vertices,
        "faces": faces,
        "level": np.array(chosen),
        "shape": np.array(grid.values.shape[::-1]),
        "spacing": np.linalg.norm(grid.affine[:, :3], axis=0),
        "millimetres": np.array(grid.millimetres),
        "warnings": np.array(grid.warnings, dtype=np.str_),
    }
