"""Curvature of positions and normals smoothed alike, at a given length."""

from dataclasses import dataclass
from typing import ClassVar

from lutcore.arrays import FloatArray
from lutcore.cosmoothing import smooth, surface
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, part
from lutcore.scale import resolved, rungs_for
from lutcore.selection import select

# Without a scale: enough to hide 1 % noise, little enough to keep features of ten edges.
_DEFAULT_SPACINGS = 4.0


@estimator_registry.register("co-smoothing")
@dataclass(frozen=True)
class CoSmoothing(EstimatorParameters):
    """Shape operator of positions and normals that went through one low-pass filter.

    The scale is the standard deviation of the Gaussian that would suppress as much noise, one for
    all vertices or one for each; without one it is four times the square root of the median vertex
    area. Features sharper than the scale are rounded. The error bar adds the noise seen in the
    mesh, carried through the smoothing, and what still changes from scale to scale.
    """

    per_vertex: ClassVar[bool] = True

    def estimate(
        self, mesh: TriangleMesh, scale: float | FloatArray | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        on = surface(mesh, part(progress, 0.0, 0.2))
        length = resolved(_DEFAULT_SPACINGS * on.spacing if scale is None else scale, on.spacing)
        scales = rungs_for(length, on.spacing)
        smoothed = smooth(on, scales.tolist(), len(scales) // 2, part(progress, 0.2, 0.8))
        return select(on, smoothed, length, progress=part(progress, 0.8, 1.0))
