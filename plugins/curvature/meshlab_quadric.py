"""Quadric fitted to the one-ring, by MeshLab."""

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
    """Quadric fitted to a vertex's nearest neighbours, by MeshLab's "Quadric Fitting".

    Exact to some thousandths on clean meshes, regular or not; noise goes through unaveraged.
    MeshLab calls the larger value "min". Its directions are those of another pair of axes at
    every third vertex and are not used. It may crash where the surface is no manifold. The
    scale is ignored. The error is the spread among neighbours.

    References
    ----------
    D. Panozzo, E. Puppo, L. Rocca, Efficient multi-scale curvature and crease estimation,
    GraVisMa 2010, section 3, at the scale of one ring.
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
