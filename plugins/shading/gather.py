"""The check of the reference: light gathered from every triangle, with no clusters."""

from dataclasses import dataclass
from typing import ClassVar

from lutcore.arrays import FloatArray
from lutcore.gather.exitance import exact
from lutcore.prediction import Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry


@model_registry.register("gather")
@dataclass(frozen=True)
class Gather(ShadingModel):
    """M(x) = int E F_t(N.w) max(N.w, 0) V R(|x - y|) dA(y), triangle by triangle.

    The integral that `jensen2002` approximates, with the dipole of [1]_ or another profile; each
    triangle is cut until its parts are small for their distance. Time grows as the square of the
    number of vertices: for small meshes, or at some points by `lutcore.gather.exitance.exact`.

    References
    ----------
    .. [1] H. W. Jensen, S. R. Marschner, M. Levoy and P. Hanrahan, "A Practical Model for
       Subsurface Light Transport", SIGGRAPH 2001, eq. 4.
    """

    local: ClassVar[bool] = False
    reference: ClassVar[bool] = True
    growth: ClassVar[str] = "n^2"

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        return exact(inputs, inputs.points)

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        return scene.facets(0.0)
