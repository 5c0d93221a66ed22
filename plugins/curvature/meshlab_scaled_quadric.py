"""Quadric fitted to the vertices within a length, by MeshLab."""

from dataclasses import dataclass

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience

_DEFAULT_SPACINGS = 4.0


@estimator_registry.register("meshlab-scaled-quadric")
@dataclass(frozen=True)
class MeshlabScaledQuadric(EstimatorParameters):
    """Quadric fitted to all vertices within a length, by MeshLab's scale-dependent fit.

    The scale is that length, by default four spacings. Noise is averaged, the bias grows with
    the square of the length; so does the time, to minutes on a scan at MeshLab's own default of
    a fiftieth of the diagonal. MeshLab calls the larger value "min". It crashes on some meshes
    with borders; that is told as an error. The error bar is the spread within the length.

    References
    ----------
    D. Panozzo, E. Puppo, L. Rocca, Efficient multi-scale curvature and crease estimation,
    GraVisMa 2010: vcglib's fit is the one that libigl has from this paper.
    """

    patience: float = patience()

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        spacing = typical_spacing(mesh)
        length = _DEFAULT_SPACINGS * spacing if scale is None else scale
        found = foreign(
            "meshlab_directions",
            "pymeshlab",
            mesh,
            self.patience,
            progress,
            method="Scale Dependent Quadric Fitting",
            scale=length,
        )
        return completed(
            mesh,
            found["min"],
            found["max"],
            along=found["dir1"],
            scale=length,
            reach=length / spacing,
        )
