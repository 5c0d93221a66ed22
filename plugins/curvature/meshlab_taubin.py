"""Curvature tensor of the edges of a star, by MeshLab."""

from dataclasses import dataclass

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience


@estimator_registry.register("meshlab-taubin")
@dataclass(frozen=True)
class MeshlabTaubin(EstimatorParameters):
    """Integral of the normal curvatures of a star's edges, by MeshLab's "Taubin approximation".

    The integral takes the edges for evenly spread over all directions. H is right on clean
    meshes; the difference of k1 and k2 is not, even on a sphere, unless the star is regular.
    MeshLab's "min" belongs to its first direction, whichever is larger. The scale is ignored.
    The error is the spread among neighbours.

    References
    ----------
    G. Taubin, Estimating the tensor of curvature of a surface from a polyhedral approximation,
    ICCV 1995.
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
            method="Taubin approximation",
            scale=0.0,
        )
        return completed(mesh, found["min"], found["max"], along=found["dir1"])
