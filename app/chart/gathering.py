"""The reference of shading: light gathered from all of the mesh, and how far models are from it."""

from dataclasses import replace

import numpy as np

from app.chart.shaders import Scene
from lutcore.arrays import FloatArray, IndexArray
from lutcore.color import srgb_encode
from lutcore.errors import MeshError, ParameterError
from lutcore.gather.exitance import exact
from lutcore.geometry import vertex_areas, vertex_corners
from lutcore.mesh import TriangleMesh
from lutcore.metrics import ciede2000_lab, lab
from lutcore.progress import Progress, silent
from lutcore.tolerance import METRICS, Tolerance, relative

_CHECKED, _FINER = 24, 0.01


SQUARES = "l2"
RELATIVE, MEAN, HIGH = METRICS


def sampled(mesh: TriangleMesh, normals: FloatArray, count: int, seed: int) -> IndexArray:
    """Return vertices at random, as likely as the area they stand for.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    normals : ndarray, shape=(n, 3)
        Vertices without a normal are not taken.
    count : int
        How many.
    seed : int
        Of the draw.

    Returns
    -------
    ndarray, shape=(count,)
        Indices; one vertex may come more than once.

    Raises
    ------
    MeshError
        If no vertex has an area and a normal.
    """
    areas = vertex_areas(mesh, vertex_corners(mesh)) * np.any(normals != 0.0, axis=1)
    if not areas.sum() > 0.0:
        raise MeshError("no vertex has an area, so there is no surface; choose another file")
    generator = np.random.default_rng(seed)
    drawn = generator.choice(len(areas), count, p=areas / areas.sum())
    return drawn.astype(np.int32)


def reference(scene: Scene, vertices: IndexArray, progress: Progress = silent) -> FloatArray:
    """Gather at vertices from every triangle.

    Parameters
    ----------
    scene : Scene
        What is shaded.
    vertices : ndarray, shape=(m,)
        Where.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    ndarray, shape=(m, 3)
        See `lutcore.gather.exitance.exact`.

    Raises
    ------
    CancelledError
        If `progress` asked to stop.
    """
    different, back = np.unique(vertices, return_inverse=True)
    inputs = replace(scene.gathering, progress=progress)
    return exact(inputs, inputs.points[different])[back]


def uncertainty(scene: Scene, vertices: IndexArray, truth: FloatArray) -> float:
    """Return how far the reference is from itself, gathered in much finer parts.

    Parameters
    ----------
    scene : Scene
        What is shaded.
    vertices : ndarray, shape=(m,)
        Where the reference is known; the first of them are tried.
    truth : ndarray, shape=(m, 3)
        The reference there.

    Returns
    -------
    float
        Relative L2 error; 0 where nothing is lit.
    """
    some = scene.gathering.points[vertices[:_CHECKED]]
    finer = exact(scene.gathering, some, _FINER)
    return _squares(scene, truth[:_CHECKED], finer) if np.any(finer) else 0.0


def compared(
    scene: Scene, found: FloatArray, truth: FloatArray, irradiance: FloatArray, exposure: float
) -> dict[str, float]:
    """Judge a model where the reference is known.

    Parameters
    ----------
    scene : Scene
        What is shaded.
    found, truth : ndarray, shape=(m, 3)
        What the model gave, and the reference.
    irradiance : ndarray, shape=(3,)
        Largest on the surface.
    exposure : float
        With which both are shown.

    Returns
    -------
    dict of str to float
        ``l2``, the root of the sum of squares of the difference, each channel over its R_d, over
        that of the reference; and the scores of `lutcore.tolerance.Tolerance`.

    Raises
    ------
    ParameterError
        If a value is not finite, or the reference is dark everywhere.
    """
    if not np.isfinite(found).all():
        raise ParameterError("it gave values that are not finite")
    if not np.any(truth):
        raise ParameterError("no light reaches the surface; move the lights")
    missed = relative(np.abs(found - truth) / _total(scene), irradiance)
    seen = ciede2000_lab(*(lab(srgb_encode(exposure * one)) for one in (found, truth)))
    errors = {RELATIVE: missed, MEAN: seen, HIGH: seen}
    scores = {metric: Tolerance(0.0, metric).score(of) for metric, of in errors.items()}
    return {SQUARES: _squares(scene, found, truth), **scores}


def _total(scene: Scene) -> FloatArray:
    return scene.gathering.table.total


def _squares(scene: Scene, found: FloatArray, truth: FloatArray) -> float:
    total = _total(scene)
    return float(np.linalg.norm((found - truth) / total) / np.linalg.norm(truth / total))
