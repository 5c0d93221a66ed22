"""VTK's minimum and maximum curvature."""

from dataclasses import dataclass

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience


@estimator_registry.register("vtk")
@dataclass(frozen=True)
class Vtk(EstimatorParameters):
    """One-ring estimator of VTK: H from angles between faces, K from the sum of angles.

    k = H -+ sqrt(H^2 - K), or H twice where H^2 < K. Exact on clean, regular meshes. Noise sigma
    at spacing h brings an error of some 2.2 sigma/h^2, so that denser scans get worse; irregular
    triangles alone bring tens of per cent; at borders and at vertices of several fans the sum of
    angles is taken for a full turn, and k is off by any amount. VTK tells no directions. The scale
    is ignored. The error is the spread among neighbours.

    References
    ----------
    VTK, class vtkCurvatures by P. Batchelor, which names no paper; its documentation has the
    formulas. H is the plain mean over the edges, K the angle defect over a third of the area.
    """

    patience: float = patience()

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        found = foreign("vtk", "vtk", mesh, self.patience, progress)
        return completed(mesh, found["maximum"], found["minimum"])
