"""What is odd about a mesh, in numbers and in plain words; nothing is changed."""

from dataclasses import dataclass

import numpy as np

from lutcore.connectivity import Connectivity, connectivity
from lutcore.mesh import TriangleMesh

# A scanned object between a tooth and a statue: outside of it the unit is hardly a millimetre.
_SMALLEST_MM, _LARGEST_MM = 1.0, 5000.0
# Steps of float32 coarser than this share of the typical edge show in normals and curvature.
_COARSEST_STEP = 0.01


@dataclass(frozen=True, kw_only=True)
class MeshHealth(Connectivity):
    """What is odd about a mesh, with its connectivity after merging coincident vertices.

    Parameters
    ----------
    vertices, faces : int
        Size of the mesh.
    unreferenced_vertices : int
        Vertices without a face.
    coincident_vertices : int
        Vertices at the position of an earlier one; those count that have a face with an area.
    zero_area_faces : int
        Faces without a normal.
    diagonal : float
        Of the box around the surface, mesh units.
    distance : float
        Of that box's centre from the origin, mesh units.
    float32_step : float
        Distance between neighbouring float32 numbers at the largest coordinate, mesh units.
    """

    vertices: int
    faces: int
    unreferenced_vertices: int
    coincident_vertices: int
    zero_area_faces: int
    diagonal: float
    distance: float
    float32_step: float

    @property
    def watertight(self) -> bool:
        """Whether the surface is closed, manifold and consistently oriented."""
        return self.islands > 0 and not (
            self.boundary_edges
            or self.nonmanifold_edges
            or self.nonmanifold_vertices
            or self.flipped_edges
        )

    def remarks(self, mm_per_unit: float = 1.0) -> list[str]:
        """Return what is odd in plain words.

        Parameters
        ----------
        mm_per_unit : float
            Size of a mesh unit, as far as known.

        Returns
        -------
        list of str
            One line for each oddity, none for a sound mesh in millimetres.
        """
        listed = ", ".join(f"{count:,}" for count in self.island_faces)
        more = ", ..." if self.islands > len(self.island_faces) else ""
        counted = (
            (self.islands > 1, f"separate parts: {self.islands:,} (faces: {listed}{more})"),
            (
                self.boundary_edges,
                f"boundary edges: {self.boundary_edges:,}, holes and outlines made of them: "
                f"{self.boundary_loops:,} (curvature is less certain there)",
            ),
            (self.nonmanifold_edges, f"edges of more than two faces: {self.nonmanifold_edges:,}"),
            (
                self.nonmanifold_vertices,
                f"points where the surface touches itself: {self.nonmanifold_vertices:,}",
            ),
            (
                self.unreferenced_vertices,
                f"vertices without a face: {self.unreferenced_vertices:,} (they get no curvature)",
            ),
            (
                self.coincident_vertices,
                f"vertices in the place of another: {self.coincident_vertices:,} (merged for "
                "computing)",
            ),
            (self.duplicate_faces, f"repeated faces: {self.duplicate_faces:,}"),
            (self.zero_area_faces, f"faces without area: {self.zero_area_faces:,}"),
            (
                self.flipped_edges,
                f"edges between faces oriented against each other: {self.flipped_edges:,} (convex "
                "and concave change places across them)",
            ),
            (
                self.inside_out_islands,
                f"closed parts that are inside out: {self.inside_out_islands:,} (convex reads as "
                "concave)",
            ),
        )
        return [line for count, line in counted if count] + self._size_remarks(mm_per_unit)

    def plausible(self, mm_per_unit: float) -> bool:
        """Tell whether a scanned object may be that large.

        Parameters
        ----------
        mm_per_unit : float
            Size of a mesh unit.

        Returns
        -------
        bool
            Whether its diagonal is that of something between a tooth and a statue.
        """
        return _SMALLEST_MM <= self.diagonal * mm_per_unit <= _LARGEST_MM

    def _size_remarks(self, mm_per_unit: float) -> list[str]:
        lines = []
        diagonal = self.diagonal * mm_per_unit
        if not self.plausible(mm_per_unit):
            guess = "metres or inches" if diagonal < _SMALLEST_MM else "micrometres"
            lines.append(
                f"its diagonal is {diagonal:.3g} mm: if its unit is, say, {guess}, give the "
                "millimetres per unit"
            )
        if self.float32_step > _COARSEST_STEP * self.typical_edge > 0.0:
            lines.append(
                f"it lies {self.distance:.3g} from the origin, where float32 steps are "
                f"{self.float32_step:.2g} and its edges {self.typical_edge:.2g}: if the file "
                "stores float32, detail is lost; move it to the origin before saving"
            )
        return lines


def inspect(mesh: TriangleMesh) -> MeshHealth:
    """Look for everything odd about a mesh.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh; triangle soup counts as the surface that its coincident vertices make.

    Returns
    -------
    MeshHealth
        The counts.
    """
    from lutcore.weld import weld

    referenced = np.zeros(len(mesh.vertices), dtype=bool)
    referenced[mesh.faces.reshape(-1)] = True
    used = mesh.vertices[referenced]
    low, high = used.min(axis=0), used.max(axis=0)
    welded = weld(mesh)
    joined = Connectivity() if welded.mesh is None else connectivity(welded.mesh)
    merged, kept = (
        (0, 0) if welded.mesh is None else (len(welded.mesh.vertices), len(welded.mesh.faces))
    )
    return MeshHealth(
        vertices=len(mesh.vertices),
        faces=len(mesh.faces),
        unreferenced_vertices=int(np.count_nonzero(~referenced)),
        coincident_vertices=int(np.count_nonzero(referenced & (welded.index >= 0))) - merged,
        zero_area_faces=len(mesh.faces) - kept,
        diagonal=float(np.linalg.norm(high - low)),
        distance=float(np.linalg.norm(0.5 * (low + high))),
        float32_step=float(np.spacing(np.float32(np.abs(used).max()))),
        **vars(joined),
    )
