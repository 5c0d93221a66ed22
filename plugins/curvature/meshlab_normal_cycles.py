"""Curvature measures of a star's edges, by MeshLab."""

from dataclasses import dataclass

import numpy as np

from lutcore.curvature import PrincipalCurvatures
from lutcore.estimation import EstimatorParameters, estimator_registry
from lutcore.geometry import vertex_areas, vertex_corners
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress
from plugins.curvature._completed import completed
from plugins.curvature._foreign import foreign, patience


@estimator_registry.register("meshlab-normal-cycles")
@dataclass(frozen=True)
class MeshlabNormalCycles(EstimatorParameters):
    """Angles between faces along a vertex's edges, by MeshLab's "Normal Cycles".

    MeshLab gives the measure, angle times length, not its density. Each edge is counted at
    both its ends and holds (k1 + k2) for a third of its two faces, so the measure of a vertex is
    divided by two thirds of the area of its star. The measure along an axis is that of the
    curvature across it: directions are exchanged. Random triangles bring tens of per cent;
    angles come from their sines, so a fold by more than a right angle counts as its supplement;
    on a cylinder whose edges run along its axis MeshLab takes the measure for degenerate and
    tells 0. The scale is ignored. The error is the spread among neighbours.

    References
    ----------
    D. Cohen-Steiner, J.-M. Morvan, Restricted Delaunay triangulations and normal cycle, SoCG
    2003, the paper that MeshLab's source names.
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
            method="Normal Cycles",
            scale=0.0,
        )
        area = 2.0 * vertex_areas(mesh, vertex_corners(mesh))
        low, high = np.sort([found["min"] / area, found["max"] / area], axis=0)
        # The first axis has the measure of the larger size; the curvature along it is the other.
        along_first = np.where(np.abs(low) < np.abs(high), low, high)
        return completed(mesh, along_first, low + high - along_first, along=found["dir1"])
