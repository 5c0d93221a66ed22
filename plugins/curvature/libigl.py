"""Quadric fitted to rings of neighbours, by libigl."""

from dataclasses import dataclass

import numpy as np

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh
from lutcore.parameters import param
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience

# Rings of a triangulation of equilateral triangles are sqrt(2/sqrt(3)) spacings apart.
_RING = 1.0746


@estimator_registry.register("libigl")
@dataclass(frozen=True)
class Libigl(EstimatorParameters):
    """Quadric fitted to the vertices of some rings, by libigl.

    Averages over its rings, so noise of a few per cent of an edge is borne, but the quadric goes
    through the vertex itself, whose own noise counts most; the bias grows with the square of the
    rings. At borders the fit looks to one side only, and few neighbours make it wild. A scale is
    met by the nearest number of rings. Where libigl reports a bad vertex nothing is estimated.
    The error is the spread within the rings.

    References
    ----------
    D. Panozzo, E. Puppo, L. Rocca, Efficient multi-scale curvature and crease estimation,
    GraVisMa 2010, the paper that libigl names.
    """

    radius: int = param(5, 2, 60, "rings", "Rings of neighbours, where no scale is given.")
    patience: float = patience()

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures; see `lutcore.curvature.Estimator`."""
        ring = _RING * typical_spacing(mesh)
        rings = self.radius if scale is None else min(60, max(2, round(scale / ring)))
        found = foreign("libigl", "libigl", mesh, self.patience, progress, rings=rings)
        k1, k2 = found["PV1"].copy(), found["PV2"]
        k1[found["bad"]] = np.nan
        return completed(mesh, k1, k2, along=found["PD1"], scale=rings * ring, reach=_RING * rings)
