"""The random walk's bodies as surfaces that can be shaded, and means over its cells."""

import numpy as np
from numpy.typing import NDArray

from lutcore.analytic import _exact
from lutcore.curvature import PrincipalCurvatures
from lutcore.lights import DirectionalLight
from lutcore.mesh import TriangleMesh
from lutcore.walk.bodies import Body
from lutcore.walk.exitance import cells
from tests.walk_truth import Case

FloatArray = NDArray[np.float64]


def surface(body: Body, points: FloatArray) -> tuple[TriangleMesh, PrincipalCurvatures]:
    """Return points of a body with their exact normals and curvatures; one face makes a mesh."""
    square = body.inverse**2

    def derivatives(p: FloatArray) -> tuple[FloatArray, FloatArray]:
        return 2.0 * p * square, np.broadcast_to(2.0 * np.diag(square), (len(p), 3, 3))

    found = _exact(points, np.array([[0, 1, 2]], np.int32), derivatives)
    return found.mesh, found.truth


class Shaded:
    """One case as a surface, and what models are measured by on it.

    Lengths are in mm of the case's material.
    """

    def __init__(self, case: Case) -> None:
        light, rows, columns = case.cells
        length = case.optics.mean_free_path
        places, self._areas = cells(case.body, light, rows, columns)
        size = Body(tuple(length * axis for axis in case.body.axes))  # type: ignore[arg-type]
        self.surface = surface(size, length * places.reshape(-1, 3))
        self.lights = [DirectionalLight(light)]
        self.areas = self._areas.sum(axis=1)

    def means(self, exitance: FloatArray) -> FloatArray:
        """Return means over the cells of a channel's exitance at the vertices."""
        return np.asarray((exitance.reshape(self._areas.shape) * self._areas).sum(axis=1)) / (
            self.areas
        )

    def l2(self, found: FloatArray, truth: FloatArray, error: FloatArray) -> float:
        """Return the relative L2 error over the surface, per cent.

        The walk's own scatter, whose expected square is known, is taken out.
        """
        square = self.areas @ ((found - truth) ** 2 - error**2) / (self.areas @ truth**2)
        return 100.0 * float(np.sqrt(max(square, 0.0)))
