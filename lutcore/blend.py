"""Two models on one surface: the cheaper where it suffices, without a seam."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray
from lutcore.errors import ParameterError
from lutcore.prediction import Scene
from lutcore.shading import ShadingInputs, ShadingModel
from lutcore.tolerance import relative

# The blend begins where the predicted error is this share of the tolerance.
_BEGIN = 0.5


@dataclass(frozen=True)
class Blend(ShadingModel):
    """M = (1 - w) M_cheap + w M_good, w from 0 to 1 with the predicted error of the cheaper.

    w = t^2 (3 - 2 t), t running from 0 at half the limit to 1 at the limit: continuous in the
    predicted error with its slope, so that there is no line where the model changes. The error is
    at most (1 - w) e_cheap + w e_good, never more than the limit where e_good is not; what the
    change of w alone adds to the picture between two vertices is at most |dw| (e_cheap + e_good).

    Tolerances of colour have no blend: what an error does to a colour takes eight CIEDE2000
    differences at each vertex, 5 to 10 us, and the costliest local model takes 1.5 us.

    Parameters
    ----------
    cheap, good : ShadingModel
        Local models; `cheap` must have a predicted error.
    limit : float
        Relative error at which `cheap` is no longer used; see `lutcore.tolerance.relative`.
    """

    curved: ClassVar[bool] = True

    cheap: ShadingModel
    good: ShadingModel
    limit: float

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        if inputs.curvatures is None:
            raise ParameterError("a blend needs the curvatures, to predict errors from")
        weight = self.weights(Scene.of(inputs, inputs.curvatures))
        out = np.zeros(inputs.points.shape)
        for model, share in ((self.cheap, 1.0 - weight), (self.good, weight)):
            chosen = np.flatnonzero(share)
            given: FloatArray = model.shade(at(inputs, chosen))
            out[chosen] += share[chosen, None] * given
        return out

    def weights(self, scene: Scene) -> FloatArray:
        """Return the share of the better model.

        Parameters
        ----------
        scene : Scene
            The vertices.

        Returns
        -------
        ndarray, shape=(n,)
            0 to 1.
        """
        errors = self.cheap.predicted_error(scene)
        if errors is None:
            raise ParameterError("a blend needs a model whose error can be predicted")
        return blending(relative(errors, scene.irradiance), self.limit)


def blending(errors: FloatArray, limit: float) -> FloatArray:
    """Return the share of the better model for errors of the cheaper.

    Parameters
    ----------
    errors : ndarray, shape=(n,)
        Relative errors.
    limit : float
        Where the cheaper one ends.

    Returns
    -------
    ndarray, shape=(n,)
        0 to 1.
    """
    t = np.clip((errors / limit - _BEGIN) / (1.0 - _BEGIN), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))


def at(inputs: ShadingInputs, chosen: NDArray[np.integer[Any]]) -> ShadingInputs:
    """Return what a local model gets for some of the vertices.

    Parameters
    ----------
    inputs : ShadingInputs
        Of all.
    chosen : ndarray of int, shape=(m,)
        Indices.

    Returns
    -------
    ShadingInputs
        Of m vertices, without visibility.
    """
    detail = inputs.detail
    if detail is not None:
        detail = replace(
            detail,
            normals=detail.normals[:, chosen],
            shape=detail.shape[:, chosen],
            bare=detail.bare[chosen],
        )
    return replace(
        inputs,
        points=inputs.points[chosen],
        normals=inputs.normals[chosen],
        shape=inputs.shape[chosen],
        visibility=None,
        curvatures=None,
        detail=detail,
    )
