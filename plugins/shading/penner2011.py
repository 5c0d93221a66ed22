"""Pre-integrated skin shading."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.baking import glowing
from lutcore.bent import BentTable, bent_exitance, tabulate_bends
from lutcore.blur import blurred
from lutcore.diffusion import DiffusionProfile, Optics, optics
from lutcore.prediction import Knowledge, Scene
from lutcore.shading import ShadingInputs, ShadingModel, model_registry

_LIMIT = 20.0
# A profile that is infinite at its centre, as Burley's is, has no integral along a ring.
_SOFTENED = 0.01


@model_registry.register("penner2011")
@dataclass(frozen=True)
class Penner2011(ShadingModel):
    """M = sum over lights of E R_d <F_t> D(N.w, r), D the profile's blur along a ring of radius r.

    D(theta, r) = int max(cos(theta + x), 0) R(2 r sin(x/2)) dx / int R(2 r sin(x/2)) dx over the
    ring (section 1.4 of [1]_), with the radial profile R of the material itself instead of the
    Gaussians of human skin. 1/r is the mean convex curvature, (k1 + k2)/2 with concave curvature
    0; [1]_ takes |dN|/|dp| of the screen. A ring has no second direction, so the profile is blurred
    by too little near its centre and too much at its tails, and no Fresnel factor is inside.

    The table holds r down to l_u/20, where the blur is nearly even around the ring; below it the
    colour no longer changes. It is within 1e-5 of the integral, 5e-5 for a profile that is infinite
    at its centre. Holds, within the 5.6 % of <F_t>, for radii above 5 l_d, and makes light of
    nothing: a small ball gives out up to 4/pi times what Lambert does. Costs 4 times Lambert with
    F_t(N.w).

    References
    ----------
    .. [1] E. Penner and G. Borshukov, "Pre-Integrated Skin Shading", GPU Pro 2, part II,
       chapter 1, 2011; shown by E. Penner at SIGGRAPH 2011.
    """

    def shade(self, inputs: ShadingInputs) -> FloatArray:
        """Compute what leaves the surface; see `ShadingModel.shade`."""
        red, green, blue = (ring_table(glowing(c), inputs.profile) for c in optics(inputs.material))
        table = inputs.table
        total = table.total * table.entering
        return bent_exitance(inputs, (red, green, blue), total, table.mean_free_path)

    def predicted_error(self, scene: Scene) -> FloatArray:
        """Predict how wrong it is; see `ShadingModel.predicted_error`."""
        return scene.error_of(Knowledge(scene.mean_entering, bend="mean", anisotropy=1.0))


@lru_cache(maxsize=256)
def ring_table(constants: Optics, profile: DiffusionProfile) -> BentTable:
    """Return the table of D for a channel; the same object for the same arguments.

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
        def kernel(x: FloatArray) -> FloatArray:
            chord = 2.0 / s * np.sin(0.5 * x)
            return profile.radial(np.hypot(chord, _SOFTENED), constants)

        return blurred(cosines, s, kernel)

    spread = float(np.sqrt(profile.mean_square(constants)))
    return tabulate_bends(curve, spread, _LIMIT)
