"""Curvature measures of balls, by trimesh."""

from dataclasses import dataclass

import numpy as np

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience

_DEFAULT_SPACINGS = 3.0


@estimator_registry.register("trimesh")
@dataclass(frozen=True)
class Trimesh(EstimatorParameters):
    """Normal-cycle measures of H and K in a ball around each vertex, by trimesh.

    The scale is the ball's radius r, by default three spacings. The measures are divided by
    pi r^2, the area that any sphere has in such a ball; k = H +- sqrt(max(H^2 - K, 0)). Edges
    count by their part inside, but vertices whole, so the measure of K jumps as one enters the
    ball. Near borders the ball holds less surface and the sum of angles is taken for a full turn,
    so k is off by any amount there. trimesh tells no directions. The error is the spread within
    the ball.

    References
    ----------
    D. Cohen-Steiner, J.-M. Morvan, Restricted Delaunay triangulations and normal cycle, SoCG
    2003, the paper that trimesh names.
    """

    patience: float = patience()

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        spacing = typical_spacing(mesh)
        radius = _DEFAULT_SPACINGS * spacing if scale is None else scale
        found = foreign("trimesh", "trimesh", mesh, self.patience, progress, radius=radius)
        area = np.pi * radius**2
        mean, gauss = found["mean"] / area, found["gauss"] / area
        half = np.sqrt(np.maximum(mean**2 - gauss, 0.0))
        return completed(mesh, mean + half, mean - half, scale=radius, reach=radius / spacing)
