"""Curvature of positions and normals smoothed alike, at a given length."""

from dataclasses import dataclass

import numpy as np

from lutcore.cosmoothing import smooth, surface
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, part, tell
from lutcore.selection import select

# Without a scale: enough to hide 1 % noise, little enough to keep features of ten edges.
_DEFAULT_SPACINGS = 4.0


@estimator_registry.register("co-smoothing")
@dataclass(frozen=True)
class CoSmoothing(EstimatorParameters):
    """Shape operator of positions and normals that went through one diffusion.

    The scale is the standard deviation of the smoothing; without one it is four times the square
    root of the median vertex area. The bias of order scale squared is extrapolated away from a
    second scale. The error bar adds the noise seen in the mesh, carried through the smoothing,
    and what still changes from scale to scale.
    """

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        tell(progress, 0.0, "reading the neighbourhoods")
        on = surface(mesh)
        length = _DEFAULT_SPACINGS * on.spacing if scale is None else scale
        ladder = length * np.sqrt(2.0) ** np.array([-1.0, 0.0, 1.0])
        smoothed = smooth(on, ladder.tolist(), base=1, progress=part(progress, 0.1, 0.9))
        tell(progress, 0.9, "fitting")
        return select(on, smoothed)
