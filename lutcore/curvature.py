"""What a curvature estimator returns, and the call that runs one.

Sign and unit, here and everywhere: convex is positive with outward normals, k1 >= k2, in 1/mesh
unit, one value for each vertex of the input in the input's order. Where nothing can be estimated
(a vertex without faces) the value is 0 and its error infinite.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from lutcore.arrays import BoolArray, FloatArray
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress


@dataclass(frozen=True)
class PrincipalCurvatures:
    """Principal curvatures of a mesh, vertex by vertex, and all that follows from them.

    Parameters
    ----------
    k1, k2 : ndarray, shape=(n,)
        Principal curvatures, k1 >= k2, convex positive, 1/mesh unit.
    d1, d2 : ndarray, shape=(n, 3)
        Their unit directions; tangent, at right angles to each other and to `normals`.
    normals : ndarray, shape=(n, 3)
        Outward unit normals at the scale of the estimate. Zero where a vertex has no face.
    error : ndarray, shape=(n,)
        One sigma of k1 and k2 together: the root of their mean variance, 1/mesh unit; infinite
        where nothing was estimated.
    scale : float or ndarray, shape=(n,)
        Length over which the surface was averaged, mesh units; 0 for one-ring methods.
    directed : bool
        Whether `d1` and `d2` are estimates. If not, they are some frame of the tangent plane:
        the method tells the values only.
    lean : float or ndarray, shape=(n,)
        How much of the variance is k1's: (s1^2 - s2^2)/(s1^2 + s2^2), -1 to 1; 0 where it is not
        known.
    """

    k1: FloatArray
    k2: FloatArray
    d1: FloatArray
    d2: FloatArray
    normals: FloatArray
    error: FloatArray
    scale: float | FloatArray
    directed: bool = True
    lean: float | FloatArray = 0.0

    @cached_property
    def error1(self) -> FloatArray:
        """One sigma of k1, 1/mesh unit."""
        return self.error * np.sqrt(1.0 + self.lean)

    @cached_property
    def error2(self) -> FloatArray:
        """One sigma of k2, 1/mesh unit."""
        return self.error * np.sqrt(1.0 - self.lean)

    @cached_property
    def mean(self) -> FloatArray:
        """Mean curvature (k1 + k2)/2, 1/mesh unit."""
        return 0.5 * (self.k1 + self.k2)

    @cached_property
    def gauss(self) -> FloatArray:
        """Gauss curvature k1 k2, 1/mesh unit squared."""
        return self.k1 * self.k2

    @cached_property
    def curvedness(self) -> FloatArray:
        """Curvedness sqrt((k1^2 + k2^2)/2), 1/mesh unit (Koenderink and van Doorn 1992)."""
        return np.sqrt(0.5 * (self.k1**2 + self.k2**2))

    @cached_property
    def shape_index(self) -> FloatArray:
        """Shape index (2/pi) atan((k1 + k2)/(k1 - k2)): cap 1, ridge 1/2, saddle 0, cup -1.

        Koenderink and van Doorn 1992 with the sign that convex is positive; 0 where flat.
        """
        return (2.0 / np.pi) * np.arctan2(self.k1 + self.k2, self.k1 - self.k2)

    @cached_property
    def estimated(self) -> BoolArray:
        """True where a value was estimated; shape (n,)."""
        return np.isfinite(self.error)


class Estimator(Protocol):
    """What a curvature plug-in does.

    The driver `principal_curvatures` hands it a mesh that is centred at the origin and whose
    coincident vertices are merged, and maps the answer back; an estimator need not repeat that.
    """

    def estimate(
        self, mesh: TriangleMesh, scale: float | None, progress: Progress
    ) -> PrincipalCurvatures:
        """Estimate the principal curvatures of a mesh.

        Parameters
        ----------
        mesh : TriangleMesh
            Centred, without coincident vertices.
        scale : float or None
            Length to average over in mesh units; None leaves it to the estimator.
        progress : callable
            Told where the work stands; see `lutcore.progress`.

        Returns
        -------
        PrincipalCurvatures
            One value for each vertex of `mesh`.
        """
        ...
