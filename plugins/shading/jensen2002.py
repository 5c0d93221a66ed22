"""The reference on a user's own mesh: light gathered from all of it, far light by clusters."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from lutcore.arrays import AnyArray, FloatArray
from lutcore.gather.exitance import gathered, hierarchy
from lutcore.parameters import param
from lutcore.prediction import Scene
from lutcore.progress import part
from lutcore.shading import ShadingInputs, ShadingModel, model_registry

_FINER = 0.001


@model_registry.register("jensen2002")
@dataclass(frozen=True)
class Jensen2002(ShadingModel):
    """M(x) = int E F_t(N.w) max(N.w, 0) V R(|x - y|) dA(y), by an octree of the light that enters.

    What every local model approximates: the profile over the mesh itself, with its bumps, its other
    side and whatever casts shadows. An octree of light as in [1]_ (section 3.2); here clusters
    carry their second moments, and one may stand for its parts as far as a bound on its error
    allows, not by its solid angle alone. Time grows as n log n.

    Light is taken through the straight line from point to point, whatever lies between: where a
    body is thinner than the light reaches, or hollow, R is not what the paper measured.

    References
    ----------
    .. [1] H. W. Jensen and J. Buhler, "A rapid hierarchical rendering technique for translucent
       materials", SIGGRAPH 2002.
    """

    local: ClassVar[bool] = False
    growth: ClassVar[str] = "n log n"

    tolerance: float = param(
        0.005, 1e-5, 0.1, "", "Error allowed, relative to the exitance or its mean."
    )

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        return gathered(inputs, self.tolerance)

    def shader_at(self, inputs: ShadingInputs) -> Callable[[AnyArray], FloatArray]:
        """Build the octree once; see `ShadingModel.shader_at`."""
        light = hierarchy(inputs, self.tolerance, part(inputs.progress, 0.0, 0.5))
        told = part(inputs.progress, 0.5, 1.0)
        return lambda vertices: light.at(inputs.points[vertices], told)

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        return scene.facets(self.tolerance)

    @classmethod
    def rungs(cls) -> tuple[ShadingModel, ...]:
        """Return two accuracies; see `ShadingModel.rungs`."""
        return cls(), cls(tolerance=_FINER)
