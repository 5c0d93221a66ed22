"""The cheapest model that suffices."""

from dataclasses import dataclass

from lutcore.arrays import FloatArray
from lutcore.choice import choose
from lutcore.costs import costs
from lutcore.exitance import exitance
from lutcore.parameters import choice, param
from lutcore.shading import AUTO, ShadingInputs, ShadingModel, model_registry
from lutcore.tolerance import METRICS, Tolerance


@model_registry.register(AUTO)
@dataclass(frozen=True)
class Auto(ShadingModel):
    """Whichever model is the cheapest whose error is within a tolerance.

    Errors are predicted from curvature, its error bar, its change along the surface, the material
    and the lights (`lutcore.prediction`), and checked against light gathered at a sample of the
    vertices (`lutcore.checking`), with the shadows that the scene casts; costs are measured on this
    machine (`lutcore.costs`). The table of psi has as many samples as matter. Where a cheaper model
    suffices on part of the surface it is blended in without a seam (`lutcore.blend`). Where no
    local model suffices, it is `jensen2002`, which gathers the light of the whole mesh.
    `curvelight choose` tells what it is and why.
    """

    tolerance: float = param(0.02, 1e-4, 100.0, "", "How wrong it may be, in the metric's unit.")
    metric: str = choice(
        "relative",
        METRICS,
        "Error of 99 % of vertices in R_d, or CIEDE2000: mean or 99th percentile.",
    )
    check: str = choice(
        "sample",
        ("sample", "none"),
        "Whether predictions are checked against light gathered at a sample of the vertices.",
    )

    def settled(self, inputs: ShadingInputs) -> ShadingModel:
        """Return the model that was chosen; see `ShadingModel.settled`."""
        wanted, checked = Tolerance(self.tolerance, self.metric), self.check == "sample"
        known = costs(inputs.progress)
        return choose(inputs, wanted, known, whole=False, checked=checked).model

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        return exitance(self.settled(inputs), inputs)
