"""What every reader of volumes returns, and what it must check before it takes memory."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.loading.errors import BadContentError
from lutcore.arrays import FloatArray

Values = NDArray[np.float32]

# Deflate cannot pack 1032 bytes into less than one.
PACKED = 1032
_COARSE = "crop it, or export it with fewer voxels"


@dataclass
class Grid:
    """Voxel values and where they lie.

    Parameters
    ----------
    values : ndarray of float32, shape=(nz, ny, nx)
        C order: the first index of the file's own (i, j, k) varies fastest.
    affine : ndarray of float64, shape=(3, 4)
        From (i, j, k, 1), the centre of a voxel, to the file's world coordinates.
    millimetres : bool
        Whether the file says that those are millimetres.
    warnings : list of str
        What was passed over or assumed.
    """

    values: Values
    affine: FloatArray
    millimetres: bool
    warnings: list[str] = field(default_factory=list)


def placed(directions: FloatArray, spacing: Sequence[float], origin: Sequence[float]) -> FloatArray:
    """Return the affine of a grid.

    Parameters
    ----------
    directions : ndarray, shape=(3, 3)
        Its columns are the directions of the axes.
    spacing : sequence of 3 floats
        Distance of neighbouring voxels along each axis.
    origin : sequence of 3 floats
        Centre of voxel (0, 0, 0).

    Returns
    -------
    ndarray, shape=(3, 4)
        See `Grid`.
    """
    return np.column_stack((directions * np.asarray(spacing, np.float64), origin))


def check_header(
    shape: Sequence[int], item: int, stored: int, memory: int, packed: bool = False
) -> None:
    """Refuse a header that promises more than its file holds or this machine can take.

    Parameters
    ----------
    shape : sequence of int
        Number of voxels along each axis.
    item : int
        Bytes of a voxel in the file.
    stored : int
        Bytes of the file that can hold voxels.
    memory : int
        Bytes of memory there are.
    packed : bool
        Whether the file is compressed.

    Raises
    ------
    BadContentError
        If the numbers do not fit.
    """
    size = " x ".join(map(str, shape))
    if len(shape) != 3 or min(shape) < 2:
        raise BadContentError(
            f"it holds {size} voxels, which is no volume",
            "a surface needs at least two along each of three axes",
        )
    count = math.prod(shape)
    if count * item > stored * (PACKED if packed else 1):
        raise BadContentError(
            f"its header promises {size} voxels of {item} bytes, {count * item} bytes, and the "
            f"file holds {stored}{' compressed' if packed else ''}"
        )
    # As stored, as float32, and as much again while it is smoothed and masked.
    needed = count * (item + 4 + 4 + 2)
    if needed > memory:
        raise BadContentError(
            f"its {size} voxels take {needed / 2**30:.1f} GiB of memory to work on, and "
            f"{memory / 2**30:.1f} GiB are allowed here",
            _COARSE,
        )


def check_affine(affine: FloatArray) -> None:
    """Refuse axes along which nothing can be measured.

    Parameters
    ----------
    affine : ndarray, shape=(3, 4)
        See `Grid`.

    Raises
    ------
    BadContentError
        If a number is not finite, an axis has no length, or the axes lie in a plane.
    """
    lengths = np.linalg.norm(affine[:, :3], axis=0)
    # A comparison with NaN is false. Shorter or longer than this is no scan in any unit, and its
    # squares would leave float32's range.
    if np.all(np.isfinite(affine)) and np.all((lengths > 1e-12) & (lengths < 1e12)):
        volume = abs(np.linalg.det(affine[:, :3] / lengths))
        if volume > 1e-6:
            return
    raise BadContentError(
        f"its axes do not span a space: {np.round(affine[:, :3], 6).tolist()}",
        "mend the spacing and orientation in its header, or export it again",
    )
