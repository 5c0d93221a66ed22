"""The call that runs a curvature estimator on any mesh."""

from typing import ClassVar, cast

import numpy as np

from lutcore.arrangement import arranged
from lutcore.arrays import FloatArray, finite
from lutcore.curvature import Estimator, PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.heap import keep_freed
from lutcore.mesh import TriangleMesh
from lutcore.parameters import Parameters, create
from lutcore.progress import Progress, silent, tell
from lutcore.registry import Registry
from lutcore.weld import Welded, weld


class EstimatorParameters(Parameters, Estimator):
    """Base of every curvature plug-in: checked parameters and `estimate`.

    `per_vertex` tells whether its scale may be an array with a length for each vertex.
    """

    per_vertex: ClassVar[bool] = False


estimator_registry: Registry[EstimatorParameters] = Registry(
    "curvature estimator", "plugins.curvature", "curvelight.curvature"
)
"""The curvature estimators by name."""


def estimators() -> list[str]:
    """Return the names of the curvature estimators.

    Returns
    -------
    list of str
        Sorted; built-in ones and those that other packages bring.
    """
    return estimator_registry.names()


def principal_curvatures(
    mesh: TriangleMesh,
    method: str = "auto",
    scale: float | FloatArray | None = None,
    *,
    progress: Progress = silent,
    **parameters: object,
) -> PrincipalCurvatures:
    """Estimate the principal curvatures of a mesh, vertex by vertex.

    Coincident vertices count as one and get the same answer; faces without area are ignored.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface; its faces' order says which side is outside.
    method : str
        Name of an estimator.
    scale : float, array_like, shape=(n,), or None
        Length to average over, mesh units, for all vertices or for each; None leaves it to the
        estimator.
    progress : callable
        Told where the work stands; see `lutcore.progress`.
    **parameters : object
        Parameters of the estimator.

    Returns
    -------
    PrincipalCurvatures
        As many values as `mesh` has vertices, in its order; all finite but the error. A vertex
        without faces has k1 = k2 = 0, an infinite error, a zero normal and the x and y axes as
        directions.

    Raises
    ------
    ParameterError
        If the method, the scale or a parameter is not accepted.
    CancelledError
        If `progress` asked to stop.
    """
    plugin = create(estimator_registry.get(method), f"curvature estimator {method!r}", parameters)
    lengths = None if scale is None else _checked(scale, mesh, plugin, method)
    keep_freed()
    tell(progress, 0.0, "joining vertices")
    welded = arranged(weld(mesh))
    if welded.mesh is None:
        return _nothing(len(mesh.vertices))
    sized, unit = sized_to_one(welded.mesh)
    if isinstance(lengths, np.ndarray):
        lengths = welded.gather(lengths)
    # Only a plug-in that says so is given an array.
    asked = cast(float | None, None if lengths is None else lengths / unit)
    found = plugin.estimate(sized, asked, progress)
    tell(progress, 1.0, "done")
    return _spread(welded, found, unit)


def sized_to_one(centred: TriangleMesh) -> tuple[TriangleMesh, float]:
    """Return a mesh of about unit size, so that no square leaves the range of numbers.

    Parameters
    ----------
    centred : TriangleMesh
        A mesh about the origin.

    Returns
    -------
    tuple of TriangleMesh and float
        The mesh, and how long its unit is in those of `centred`: a power of two, which changes no
        bits.
    """
    points = centred.vertices
    unit = float(2.0 ** np.ceil(np.log2(max(points.max(), -points.min()))))
    return TriangleMesh.trusted(points * (1.0 / unit), centred.faces), unit


def _checked(
    scale: float | FloatArray, mesh: TriangleMesh, plugin: EstimatorParameters, method: str
) -> float | FloatArray:
    """Return the scale or the scales that were asked for, or say what is wrong with them."""
    each = np.ndim(scale) > 0
    if each and not plugin.per_vertex:
        raise ParameterError(
            f"{method} takes one scale for the whole mesh, not one for each vertex; auto and "
            "co-smoothing take either"
        )
    lengths = finite("scale", scale, (len(mesh.vertices),) if each else ())
    wrong = lengths[~((lengths > 0.0) & (lengths <= mesh.diagonal))]
    if wrong.size:
        raise ParameterError(
            f"scale = {float(wrong[0])!r} is not a length between 0 and the mesh's diagonal, "
            f"{mesh.diagonal:.6g}"
        )
    return lengths if each else float(lengths)


def _spread(welded: Welded, found: PrincipalCurvatures, unit: float) -> PrincipalCurvatures:
    """Return the estimate for the input's vertices and in its units."""
    x_axis, y_axis = np.eye(3)[:2]
    scale = found.scale * unit
    return PrincipalCurvatures(
        k1=welded.spread(found.k1 / unit, 0.0),
        k2=welded.spread(found.k2 / unit, 0.0),
        d1=welded.spread(found.d1, x_axis),
        d2=welded.spread(found.d2, y_axis),
        normals=welded.spread(found.normals, 0.0),
        error=welded.spread(found.error / unit, np.inf),
        scale=welded.spread(scale, 0.0) if isinstance(scale, np.ndarray) else scale,
        directed=found.directed,
        lean=welded.spread(found.lean, 0.0) if isinstance(found.lean, np.ndarray) else found.lean,
    )


def _nothing(count: int) -> PrincipalCurvatures:
    zero = np.zeros(count)
    axes = np.eye(3)
    return PrincipalCurvatures(
        k1=zero,
        k2=zero.copy(),
        d1=np.tile(axes[0], (count, 1)),
        d2=np.tile(axes[1], (count, 1)),
        normals=np.zeros((count, 3)),
        error=np.full(count, np.inf),
        scale=0.0,
    )
