"""Principal components of a neighbourhood, by MeshLab: refused, with the reason."""

from dataclasses import dataclass

from lutcore.curvature import PrincipalCurvatures
from lutcore.errors import ParameterError
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress


@estimator_registry.register("meshlab-pca")
@dataclass(frozen=True)
class MeshlabPca(EstimatorParameters):
    """MeshLab's "Principal Component Analysis"; refused, for it holds no curvature to convert.

    MeshLab puts the covariance of points of the surface into the formula for that of the solid
    within a ball. What comes out is the same for spheres of radius 1 and 2 and for flipped faces:
    it depends on the ball, not on the surface. Even its directions are random on irregular
    triangles, unless the ball holds many hundreds of vertices.

    References
    ----------
    Y.-L. Yang, Y.-K. Lai, S.-M. Hu, H. Pottmann, Robust principal curvatures on multiple scales,
    SGP 2006.
    """

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Refuse; see `lutcore.curvature.Estimator`."""
        raise ParameterError(
            "meshlab-pca: the values of MeshLab's filter do not depend on the curvature, so there "
            "is nothing to convert (meshlab-scaled-quadric and ball-jet average over a length too)"
        )
