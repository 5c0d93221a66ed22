"""From voxels to triangles: smoothing and marching cubes, both by scikit-image and SciPy."""

import numpy as np
from numpy.typing import NDArray

from app.volume.grid import Grid, Values
from app.volume.level import check_level, otsu_level
from lutcore.arrays import BoolArray, FloatArray
from lutcore.errors import MeshError

# 40 million triangles, which curvature takes some ten GiB for.
_MOST_VERTICES = 20_000_000


def surface(
    grid: Grid, level: float | None, smoothing: float
) -> tuple[FloatArray, NDArray[np.int32], float]:
    """Return the surface at a level, its normals towards lower values.

    Parameters
    ----------
    grid : Grid
        Its voxels. Its list of warnings grows by what had to be passed over.
    level : float or None
        None takes `otsu_level`, after smoothing.
    smoothing : float
        Sigma of a Gaussian, voxels; 0 smooths nothing.

    Returns
    -------
    ndarray of float64, shape=(n, 3)
        Vertices in world coordinates.
    ndarray of int32, shape=(m, 3)
        Triangles.
    float
        The level.

    Raises
    ------
    MeshError
        If no surface lies there, or one too large.
    """
    from skimage.measure import marching_cubes

    values, good = _finite(grid)
    if smoothing > 0.0:
        values = _smoothed(values, good, smoothing)
    known = values if good is None else values[good]
    chosen = otsu_level(known) if level is None else level
    check_level(known, chosen)
    _note_mask(known, smoothing, grid.warnings)
    _check_size(values, chosen)
    mask = None if good is None else _whole_cells(good)
    try:
        # Vertices on a voxel make triangles without area: only where the level meets a value.
        found, faces, _, _ = marching_cubes(
            values,
            chosen,
            gradient_direction="ascent",
            allow_degenerate=not bool((known == np.float32(chosen)).any()),
            mask=mask,
        )
    except RuntimeError:
        raise MeshError(f"no surface lies at level {chosen:g}") from None
    if len(faces) == 0:
        raise MeshError(f"the surface at level {chosen:g} has no area")
    vertices = found[:, ::-1].astype(np.float64) @ grid.affine[:, :3].T + grid.affine[:, 3]
    # scikit-image's "ascent" winds triangles with normals towards lower values where the axes
    # (k, j, i) are right-handed, that is where (i, j, k) are left-handed.
    if np.linalg.det(grid.affine[:, :3]) > 0.0:
        faces = faces[:, ::-1]
    return vertices, np.ascontiguousarray(faces, np.int32), chosen


def _finite(grid: Grid) -> tuple[Values, BoolArray | None]:
    good = np.isfinite(grid.values)
    missing = good.size - int(np.count_nonzero(good))
    if missing == 0:
        return grid.values, None
    if missing == good.size:
        raise MeshError("none of its voxels has a finite value")
    grid.warnings.append(
        f"{missing} of {good.size} voxels have no finite value: the surface is open beside them"
    )
    return np.where(good, grid.values, np.min(grid.values, where=good, initial=np.inf)), good


def _smoothed(values: Values, good: BoolArray | None, sigma: float) -> Values:
    from scipy.ndimage import gaussian_filter

    if good is None:
        return gaussian_filter(values, sigma, mode="nearest")
    # Of finite voxels only: their weighted mean.
    weight = gaussian_filter(good.astype(np.float32), sigma, mode="nearest")
    total = gaussian_filter(np.where(good, values, np.float32(0.0)), sigma, mode="nearest")
    return np.where(good, total / np.maximum(weight, np.float32(1e-6)), values)


def _whole_cells(good: BoolArray) -> BoolArray:
    """Mark the cells with eight finite corners, at their last one: scikit-image looks there."""
    mask = np.zeros_like(good)
    mask[1:, 1:, 1:] = True
    for k in (slice(None, -1), slice(1, None)):
        for j in (slice(None, -1), slice(1, None)):
            for i in (slice(None, -1), slice(1, None)):
                mask[1:, 1:, 1:] &= good[k, j, i]
    return mask


def _check_size(values: Values, level: float) -> None:
    """Count the vertices before they are made: one on each edge that crosses the level."""
    count = 0
    above = values[0] > level
    for layer in values:  # the first is compared with itself
        now = layer > level
        edges = (now != above, now[1:] != now[:-1], now[:, 1:] != now[:, :-1])
        count += sum(int(np.count_nonzero(crossed)) for crossed in edges)
        above = now
    if count > _MOST_VERTICES:
        raise MeshError(
            f"the surface at level {level:g} would have about {count / 1e6:.0f} million vertices, "
            f"more than {_MOST_VERTICES // 1_000_000} million; smooth it (--smoothing 1), choose "
            "another --level, or crop the volume"
        )


def _note_mask(values: Values, smoothing: float, warnings: list[str]) -> None:
    if smoothing > 0.0:
        return
    low, high = values.min(), values.max()
    if np.all((values == low) | (values == high)):
        warnings.append(
            "its voxels have two values only: the surface is a staircase, which --smoothing rounds"
        )
