"""Co-smoothing at the length that the mesh's own noise and detail call for."""

from dataclasses import dataclass

from lutcore.cosmoothing import smooth, surface
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, part, tell
from lutcore.scale import best_scale
from lutcore.selection import select


@estimator_registry.register("auto")
@dataclass(frozen=True)
class Auto(EstimatorParameters):
    """Co-smoothing at one scale for the whole mesh, chosen by noise and bias.

    The scale is the one of a ladder at which the mean over nearly all vertices of noise squared
    plus bias squared is least. A given scale is used as it is.
    """

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        tell(progress, 0.0, "reading the neighbourhoods")
        on = surface(mesh)
        length = best_scale(on, part(progress, 0.1, 0.4)) if scale is None else scale
        ladder = (length / 2.0**0.5, length, length * 2.0**0.5)
        smoothed = smooth(on, ladder, 1, part(progress, 0.4, 0.9))
        tell(progress, 0.9, "fitting")
        return select(on, smoothed)
