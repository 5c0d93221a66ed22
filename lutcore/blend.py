"""Two models on one surface: the cheaper where it suffices, without a seam."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, read_only
from lutcore.color_bound import color_bound
from lutcore.errors import ParameterError
from lutcore.exitance import exitance
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
    The error is that under all lights together, without cast shadows: they take light and with it
    the error of spreading it.

    In CIEDE2000 the error is bounded at the colour that the cheaper model itself gives
    (`lutcore.color_bound`), which is continuous as well. The exposure is a part of the blend: one
    that followed the picture would make each vertex depend on all others, and change where the
    models meet whenever a light, or a machine's last bit, changes.

    Parameters
    ----------
    cheap, good : ShadingModel
        Local models; `cheap` must have a predicted error.
    limit : float
        Error at which `cheap` is no longer used: relative, see `lutcore.tolerance.relative`, or in
        CIEDE2000.
    exposure : float or None
        For a limit in CIEDE2000, the factor that linear light is shown with; None if it is
        relative.
    """

    joint: ClassVar[bool] = True
    curved: ClassVar[bool] = True

    cheap: ShadingModel
    good: ShadingModel
    limit: float
    exposure: float | None = None

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        if inputs.curvatures is None:
            raise ParameterError("a blend needs the curvatures, to predict errors from")
        scene = Scene.of(inputs, inputs.curvatures)
        out = np.zeros(inputs.points.shape)
        if self.exposure is None:
            weight = self.weights(scene)
            cheap = np.flatnonzero(weight < 1.0)
            out[cheap] = exitance(self.cheap, at(inputs, cheap))
        else:
            out = exitance(self.cheap, inputs)
            weight = self.weights(scene, out)
        out *= (1.0 - weight)[:, None]
        good = np.flatnonzero(weight)
        out[good] += weight[good, None] * exitance(self.good, at(inputs, good))
        return out

    def weights(self, scene: Scene, given: FloatArray | None = None) -> FloatArray:
        """Return the share of the better model.

        Parameters
        ----------
        scene : Scene
            The vertices.
        given : ndarray, shape=(n, 3), optional
            What the cheaper model gives there, for a limit in CIEDE2000.

        Returns
        -------
        ndarray, shape=(n,)
            0 to 1.
        """
        return blending(self.errors(scene, given), self.limit)

    def errors(self, scene: Scene, given: FloatArray | None = None) -> FloatArray:
        """Return the predicted errors of the cheaper model in the limit's unit.

        Parameters
        ----------
        scene : Scene
            The vertices.
        given : ndarray, shape=(n, 3), optional
            What the cheaper model gives there, for a limit in CIEDE2000.

        Returns
        -------
        ndarray, shape=(n,)
            0 or more.

        Raises
        ------
        ParameterError
            If the model predicts no error, or colours are asked for without `given`.
        """
        errors = self.cheap.predicted_error(scene)
        if errors is None:
            raise ParameterError("a blend needs a model whose error can be predicted")
        if self.exposure is None:
            return relative(errors, scene.irradiance)
        if given is None:
            raise ParameterError("a blend by colour needs what the cheaper model gives")
        return color_bound(given, errors, scene.table.total, self.exposure)


def blending(errors: FloatArray, limit: float) -> FloatArray:
    """Return the share of the better model for errors of the cheaper.

    Parameters
    ----------
    errors : ndarray, shape=(n,)
        Its errors, in the limit's unit.
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
        Of m vertices, without curvatures.
    """
    # As models get them of whole meshes, read-only points and rows in order: what is compiled for
    # those serves here. Indexing behind the first axis would leave rows in another order.
    detail, seen, soft = inputs.detail, inputs.visibility, inputs.softened
    if detail is not None:
        detail = replace(
            detail,
            normals=detail.normals.take(chosen, axis=1),
            shape=detail.shape.take(chosen, axis=1),
            variance=detail.variance.take(chosen, axis=1),
            bare=detail.bare[chosen],
        )
    return replace(
        inputs,
        points=read_only(inputs.points[chosen]),
        normals=inputs.normals[chosen],
        shape=inputs.shape[chosen],
        visibility=None if seen is None else seen[:, chosen],
        softened=None if soft is None else soft[:, chosen],
        curvatures=None,
        detail=detail,
    )
