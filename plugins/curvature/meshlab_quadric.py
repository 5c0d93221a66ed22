"""Quadric fitted to two rings of neighbours, by MeshLab."""

from dataclasses import dataclass

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience


@estimator_registry.register("meshlab-quadric")
@dataclass(frozen=True)
class MeshlabQuadric(EstimatorParameters):
    """Quadric fitted to the vertices of two rings, by MeshLab's "Quadric Fitting".

    Exact to some thousandths on clean meshes, regular or not; noise is hardly averaged.
    MeshLab calls the larger value "min". Its directions are those of another pair of axes at
    every third vertex and are not used. It may crash where the surface is no manifold. The
    scale is ignored. The error is the spread among neighbours.

    References
    ----------
    MeshLab names none; vcglib, class UpdateCurvatureFitting. The fit is that of libigl with two
    rings, in a frame by another normal.
    """

    patience: float = patience()

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        found = foreign(
            "meshlab_directions",
            "pymeshlab",
            mesh,
            self.patience,
            progress,
            method="Quadric Fitting",
            scale=0.0,
        )
        return completed(mesh, found["min"], found["max"])
