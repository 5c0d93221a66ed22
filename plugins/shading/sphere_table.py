"""The exact diffusion of a sphere, for strong curvature and weak absorption."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.baking import glowing
from lutcore.bent import BentTable, bent_exitance, tabulate_bends
from lutcore.diffusion import DiffusionProfile, Optics, optics
from lutcore.prediction import Knowledge, Scene
from lutcore.revolution import on_sphere
from lutcore.shading import ShadingInputs, ShadingModel, model_registry

_LIMIT = 20.0


@model_registry.register("sphere-table")
@dataclass(frozen=True)
class SphereTable(ShadingModel):
    """M = sum over lights of E int R(|x - y|) c(y) F_t(c(y)) dA(y) over the sphere that fits best.

    The integral that eq. 10 of [1]_ approximates, on a true sphere of the mean convex curvature,
    (k1 + k2)/2 with concave curvature 0: with its true area, its dark side and what reaches
    around it, F_t inside. Nothing is expanded in curvature, so it holds where the first order
    fails, at E2 > .3; on a sphere it is exact for every radius. Where k1 and k2 differ it is right
    only on average over the directions of light: on a cylinder the first order is better.

    Never gives out more than it takes in: on a sphere the profile is cut off at the diameter and
    nothing is added. The table is within 2e-6 of the integral and goes down to a radius of
    l_u/20, where next to nothing is left; below it the colour no longer changes. Costs 4 times
    Lambert with F_t(N.w).

    References
    ----------
    .. [1] K. Kolchin, "Curvature-Based Shading of Translucent Materials, such as Human Skin",
       GRAPHITE 2007.
    """

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        red, green, blue = (
            sphere_table(glowing(c), inputs.profile) for c in optics(inputs.material)
        )
        table = inputs.table
        tables = (red, green, blue)
        return bent_exitance(inputs, tables, table.total, table.mean_free_path, table.eta)

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        known = Knowledge(scene.entering, bend="mean", second=0.0, anisotropy=1.0, higher=0.6)
        return scene.error_of(known)


@lru_cache(maxsize=256)
def sphere_table(constants: Optics, profile: DiffusionProfile) -> BentTable:
    """Return the table of a channel; the same object for the same arguments.

    Parameters
    ----------
    constants : Optics
        Of the channel.
    profile : DiffusionProfile
        How light spreads.

    Returns
    -------
    BentTable
        Over N.w and l_u/radius.
    """

    def curve(cosines: FloatArray, s: float) -> FloatArray:
        return on_sphere(cosines, s, profile, constants)

    spread = float(np.sqrt(profile.mean_square(constants)))
    return tabulate_bends(curve, spread, _LIMIT, constants.eta)
