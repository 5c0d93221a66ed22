"""Curvature of an algebraic point set surface, by MeshLab."""

from dataclasses import dataclass

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience

# MeshLab's own default averages over little more than the star.
_DEFAULT_SPACINGS = 4.0


@estimator_registry.register("meshlab-apss")
@dataclass(frozen=True)
class MeshlabApss(EstimatorParameters):
    """Curvature of the surface that spheres fitted to neighbours leave, by MeshLab's APSS.

    Uses positions and vertex normals; faces say nothing but the normals. The scale is the
    distance at which weights end, by default four spacings; MeshLab measures it in each vertex's
    own spacing.
    Sheets that lie closer than that are taken for one. MeshLab's "mean" is twice the mean, so K1
    and K2 are read; it tells no directions. The error is the spread within the scale.

    References
    ----------
    G. Guennebaud, M. Gross, Algebraic point set surfaces, SIGGRAPH 2007;
    G. Guennebaud, M. Germann, M. Gross, Dynamic sampling and rendering of algebraic point set
    surfaces, Eurographics 2008: the papers that MeshLab names.
    """

    patience: float = patience()

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        spacing = typical_spacing(mesh)
        length = _DEFAULT_SPACINGS * spacing if scale is None else scale
        found = foreign(
            "meshlab_apss",
            "pymeshlab",
            mesh,
            self.patience,
            progress,
            filter_scale=length / spacing,
        )
        return completed(mesh, found["K1"], found["K2"], scale=length, reach=length / spacing)
