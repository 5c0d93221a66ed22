"""Co-smoothing, each vertex at the length that its own noise and detail call for."""

from dataclasses import dataclass
from typing import ClassVar

from lutcore.arrays import FloatArray
from lutcore.cosmoothing import smooth, surface
from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.parameters import param
from lutcore.progress import Progress, part
from lutcore.scale import resolved, rungs, rungs_for
from lutcore.selection import select


@estimator_registry.register("auto")
@dataclass(frozen=True)
class Auto(EstimatorParameters):
    """Co-smoothing over many scales in one recurrence, the scale chosen vertex by vertex.

    Each vertex takes the scales at which its noise and its bias, squared, are least together;
    both are read off the mesh. Where even the finest scale is precise enough, that is taken.
    A given scale is used as it is.
    """

    per_vertex: ClassVar[bool] = True

    precision: float = param(
        0.004,
        0.0,
        1.0,
        "",
        "Error, as a share of the typical curvature, that is small enough to smooth no more.",
    )

    steadiness: float = param(
        2.0,
        1.0,
        1e6,
        "",
        "How much noise counts against lost detail, both squared, in the choice of scales.",
    )

    def estimate(
        self, mesh: TriangleMesh, scale: float | FloatArray | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        on = surface(mesh, part(progress, 0.0, 0.2))
        if scale is None:
            told = part(progress, 0.2, 0.3)
            scales = rungs(on, mesh.diagonal, self.precision, self.steadiness, told)
        else:
            scale = resolved(scale, on.spacing)
            scales = rungs_for(scale, on.spacing)
        smoothed = smooth(on, scales.tolist(), len(scales) // 2, part(progress, 0.3, 0.8))
        told = part(progress, 0.8, 1.0)
        return select(on, smoothed, scale, self.precision, self.steadiness, told)
