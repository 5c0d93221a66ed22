"""How far a curvature estimate can be trusted, told from the mesh and the estimate alone."""

from dataclasses import dataclass

import numpy as np

from lutcore.arrays import BoolArray, FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.geometry import vertex_areas, vertex_corners
from lutcore.islands import main_islands
from lutcore.mesh import TriangleMesh
from lutcore.topology import edges
from lutcore.weld import weld


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What an estimate says of itself.

    Parameters
    ----------
    interior, border, debris : ndarray of bool, shape=(n,)
        Vertices with an estimate: away from every border, within their own scale of a border, and
        of islands far smaller than the largest. Each vertex is in one of them at most.
    below_error : float
        Share of the vertices with an estimate where neither |k1| nor |k2| exceeds its error.
    total_curvature : float
        Integral of k1 k2 over the interior vertices, steradian.
    angle_defect : float
        What Gauss and Bonnet say it is: the angle defects of the same vertices, summed.
    absolute_curvature : float
        Integral of |k1 k2| over the same vertices.
    """

    interior: BoolArray
    border: BoolArray
    debris: BoolArray
    below_error: float
    total_curvature: float
    angle_defect: float
    absolute_curvature: float

    @property
    def gauss_bonnet_residual(self) -> float:
        """|integral of k1 k2 - angle defects|, relative to the integral of |k1 k2|; 0 if flat."""
        apart = abs(self.total_curvature - self.angle_defect)
        return apart / self.absolute_curvature if self.absolute_curvature > 0.0 else 0.0

    @property
    def groups(self) -> dict[str, BoolArray]:
        """The groups that have vertices, by name."""
        named = {"interior": self.interior, "border": self.border, "debris": self.debris}
        return {name: mask for name, mask in named.items() if mask.any()}


def vertex_scales(curvatures: PrincipalCurvatures) -> FloatArray:
    """Return the length that each vertex's curvature was averaged over.

    Parameters
    ----------
    curvatures : PrincipalCurvatures
        An estimate.

    Returns
    -------
    ndarray, shape=(n,)
        Mesh units; 0 for one-ring methods. Read-only where one length holds for all.
    """
    scales = np.asarray(curvatures.scale, dtype=np.float64)
    return np.broadcast_to(scales, curvatures.k1.shape)


def diagnose(mesh: TriangleMesh, curvatures: PrincipalCurvatures) -> Diagnosis:
    """Judge an estimate by the mesh it was made on.

    Parameters
    ----------
    mesh : TriangleMesh
        The mesh, n vertices.
    curvatures : PrincipalCurvatures
        Its estimate.

    Returns
    -------
    Diagnosis
        Groups of vertices, and what does not depend on a truth that nobody has.

    References
    ----------
    M. do Carmo, Differential Geometry of Curves and Surfaces, section 4-5 (Gauss-Bonnet).
    """
    estimated = curvatures.estimated
    welded = weld(mesh)
    if welded.mesh is None:
        nothing = np.zeros(len(mesh.vertices), dtype=bool)
        return Diagnosis(nothing, nothing, nothing, 0.0, 0.0, 0.0, 0.0)
    surface = welded.mesh
    main = main_islands(surface)
    used = welded.index >= 0
    reach = np.empty(len(surface.vertices))
    reach[welded.index[used]] = vertex_scales(curvatures)[used]
    close = _within(surface, _rim(surface), reach)
    subject, near = welded.spread(main, False), welded.spread(close, False)
    largest = np.maximum(np.abs(curvatures.k1), np.abs(curvatures.k2))
    inside = main & ~close
    areas = np.zeros(len(surface.vertices))
    areas[inside] = vertex_areas(surface, vertex_corners(surface))[inside]
    gauss = np.empty(len(surface.vertices))
    gauss[welded.index[used]] = curvatures.gauss[used]
    return Diagnosis(
        interior=estimated & subject & ~near,
        border=estimated & subject & near,
        debris=estimated & ~subject,
        below_error=float(np.mean((largest < curvatures.error)[estimated])),
        total_curvature=float(np.sum(gauss * areas)),
        angle_defect=float(np.sum(_angle_defects(surface)[inside])),
        absolute_curvature=float(np.sum(np.abs(gauss) * areas)),
    )


def _rim(mesh: TriangleMesh) -> BoolArray:
    """Mark vertices at edges of one face."""
    table = edges(mesh.faces, len(mesh.vertices))
    rim = np.zeros(len(mesh.vertices), dtype=bool)
    rim[table.ends[table.boundary].ravel()] = True
    return rim


def _within(mesh: TriangleMesh, rim: BoolArray, reach: FloatArray) -> BoolArray:
    """Mark vertices no farther from the rim than their reach."""
    farthest = float(reach.max())
    if farthest == 0.0 or not rim.any():
        return rim
    from scipy.spatial import cKDTree

    # The query leaves out what lies at its bound.
    distance, _ = cKDTree(mesh.vertices[rim]).query(
        mesh.vertices, distance_upper_bound=1.001 * farthest, workers=-1
    )
    near: BoolArray = distance <= reach
    return near


def _angle_defects(mesh: TriangleMesh) -> FloatArray:
    """2 pi less the angles of the faces at each vertex."""
    corners = mesh.vertices[mesh.faces]
    defects = np.full(len(mesh.vertices), 2.0 * np.pi)
    for corner in range(3):
        u = corners[:, (corner + 1) % 3] - corners[:, corner]
        v = corners[:, (corner + 2) % 3] - corners[:, corner]
        sine = np.sqrt(np.square(np.cross(u, v)).sum(axis=1))
        angle = np.arctan2(sine, np.einsum("ij,ij->i", u, v))
        defects -= np.bincount(mesh.faces[:, corner], angle, len(defects))
    return defects
