"""At which value the surface lies."""

import numpy as np

from app.volume.grid import Values
from lutcore.errors import MeshError

_BINS = 256


def otsu_level(values: Values) -> float:
    """Return the value that parts voxels best into dark and bright ones.

    Otsu's threshold says which voxels belong together; any value between the brightest dark and
    the darkest bright one parts them alike. The middle of that gap is taken: it is half way
    between the two values of a mask, and meets no voxel's value exactly, which would make
    triangles without area.

    Parameters
    ----------
    values : ndarray of float32
        Finite voxel values.

    Returns
    -------
    float
        The level.

    Raises
    ------
    MeshError
        If all voxels have one value.

    References
    ----------
    N. Otsu, A threshold selection method from gray-level histograms, 1979.
    """
    from skimage.filters import threshold_otsu

    low, high = float(values.min()), float(values.max())
    if low == high:
        raise MeshError(f"all of its voxels have the value {low:g}, so there is no surface")
    # It answers with the middle of the last dark bin, which is dark to its end.
    end = float(threshold_otsu(values, nbins=_BINS)) + 0.5 * (high - low) / _BINS
    dark = values <= min(end, np.nextafter(high, low))
    below = float(np.max(values, where=dark, initial=low))
    above = float(np.min(values, where=~dark, initial=high))
    return 0.5 * (below + above)


def check_level(values: Values, level: float) -> None:
    """Refuse a level that no surface lies at.

    Parameters
    ----------
    values : ndarray of float32
        Finite voxel values.
    level : float
        The level.

    Raises
    ------
    MeshError
        If it is not between the least and the greatest value.
    """
    low, high = float(values.min()), float(values.max())
    if not low < level < high:
        raise MeshError(
            f"no surface lies at level {level:g}: its voxels have values from {low:g} to {high:g}"
        )
