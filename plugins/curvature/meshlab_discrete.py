"""Mean and Gauss curvature of the one-ring, by MeshLab."""

from dataclasses import dataclass

import numpy as np

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience


@estimator_registry.register("meshlab-discrete")
@dataclass(frozen=True)
class MeshlabDiscrete(EstimatorParameters):
    """Cotangent H and angle-defect K over mixed areas, by MeshLab's discrete curvatures.

    k = H +- sqrt(max(H^2 - K, 0)). Exact on clean, regular meshes; noise and irregular
    triangles bring errors of any size. At borders H is of the order of 1/spacing even where the
    surface is flat, and so is sqrt(K) where the border turns outwards. MeshLab tells no
    directions. The scale is ignored. The error is the spread among neighbours.

    References
    ----------
    M. Meyer et al., Discrete differential-geometry operators for triangulated 2-manifolds,
    Visualization and Mathematics III, 2003, eqs. 8 and 9.
    """

    patience: float = patience()

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        found = foreign("meshlab_discrete", "pymeshlab", mesh, self.patience, progress)
        mean, gauss = found["mean"], found["gauss"]
        half = np.sqrt(np.maximum(mean**2 - gauss, 0.0))
        return completed(mesh, mean + half, mean - half)
