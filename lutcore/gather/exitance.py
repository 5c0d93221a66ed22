"""Radiant exitance gathered from clusters of light, or from every patch of it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, finite
from lutcore.gather.kernel import Kernel, Radial, kernel, radial
from lutcore.gather.octree import Octree, octree
from lutcore.gather.patches import Patches, patches
from lutcore.gather.traversal import gather_at
from lutcore.progress import Progress, tell
from lutcore.progress import part as stage
from lutcore.shading import ShadingInputs

_CHUNK = 4096
# The bound on a cluster's error at a tolerance of 1. Found, with a margin: large clusters near by
# are bounded so badly that the error grows as the bound to the power of two thirds.
_LOOSE = 2e5
_TINY = 1e-3


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """Light that enters a mesh in clusters, to be gathered anywhere.

    Parameters
    ----------
    tree : Octree
        The clusters.
    chosen : Kernel
        The profile, and how large a cluster may be at each distance.
    mm_per_unit : float
        Millimetres in one mesh unit.
    """

    tree: Octree
    chosen: Kernel
    mm_per_unit: float

    def at(self, points: FloatArray, progress: Progress) -> FloatArray:
        """Gather at some points.

        Parameters
        ----------
        points : ndarray, shape=(q, 3)
            Where, mesh units.
        progress : callable
            Told where the work stands; see `lutcore.progress`.

        Returns
        -------
        ndarray, shape=(q, 3)
            Radiant exitance, linear RGB, before the exit Fresnel factor.

        Raises
        ------
        CancelledError
            If the progress asked to stop.
        """
        targets = points * self.mm_per_unit
        out = np.empty((len(targets), 3))
        for begin in range(0, len(targets), _CHUNK):
            tell(progress, begin / len(targets), "gathering light")
            some = targets[begin : begin + _CHUNK]
            out[begin : begin + _CHUNK] = gather_at(*self.tree, *self.chosen, some)
        return out


def gathered(inputs: ShadingInputs, tolerance: float) -> FloatArray:
    """Gather at every vertex, far light by clusters.

    A cluster stands for its parts, by its moments up to the second, where it is off by less than
    `tolerance` of what it gives or of its share of the mean exitance. All are positive, so that
    the same holds for the sum. The bound on what a cluster is off by supposes that all its parts
    err alike and as much as any; it is taken at a share that makes the error found, root mean
    square, some two thirds of the tolerance at most (`tests/bench/gather.py`).

    Time grows as n log n. Memory is about 1 kB for each vertex.

    Parameters
    ----------
    inputs : ShadingInputs
        Geometry, lights, material, profile, visibility and progress.
    tolerance : float
        Relative error wanted, above 0.

    Returns
    -------
    ndarray, shape=(n, 3)
        Radiant exitance, linear RGB, before the exit Fresnel factor.

    Raises
    ------
    CancelledError
        If the progress asked to stop.

    References
    ----------
    H. W. Jensen and J. Buhler, A rapid hierarchical rendering technique for translucent materials,
    SIGGRAPH 2002: the octree. Their clusters are judged by their solid angle.
    """
    ready = hierarchy(inputs, tolerance, stage(inputs.progress, 0.0, 0.1))
    return ready.at(inputs.points, stage(inputs.progress, 0.1, 1.0))


def hierarchy(inputs: ShadingInputs, tolerance: float, progress: Progress) -> Hierarchy:
    """Prepare what `gathered` does, to be done at some points only.

    Parameters
    ----------
    inputs : ShadingInputs
        Geometry, lights, material, profile and visibility.
    tolerance : float
        As for `gathered`.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Hierarchy
        At any of the mesh's points it gives what `gathered` does there.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    tell(progress, 0.0, "sampling the light that enters")
    of = patches(inputs)
    tell(progress, 0.5, "building the octree")
    tree = octree(of)
    known = _known(inputs)
    chosen = kernel(known, _LOOSE * tolerance**1.5, _negligible(known, of))
    return Hierarchy(tree, chosen, inputs.mm_per_unit)


def exact(inputs: ShadingInputs, points: ArrayLike, bound: float = 0.1) -> FloatArray:
    """Gather at some points from every patch, each cut until it is small enough.

    Parameters
    ----------
    inputs : ShadingInputs
        As for `gathered`.
    points : array_like, shape=(q, 3)
        Where, mesh units.
    bound : float
        Bound on the error of each part, above 0, relative to what it gives or to a thousandth of
        its share of the mean exitance. Errors found are below a thousandth of the bound.

    Returns
    -------
    ndarray, shape=(q, 3)
        Radiant exitance, linear RGB, before the exit Fresnel factor.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    tell(inputs.progress, 0.0, "sampling the light that enters")
    targets = finite("points", points, (len(np.asarray(points)), 3))
    of, known = patches(inputs), _known(inputs)
    chosen = kernel(known, bound, _TINY * _negligible(known, of))
    ready = Hierarchy(_row(of), chosen, inputs.mm_per_unit)
    return ready.at(targets, stage(inputs.progress, 0.1, 1.0))


def _known(inputs: ShadingInputs) -> Radial:
    extent = np.ptp(inputs.points, axis=0) * inputs.mm_per_unit
    return radial(inputs.profile, inputs.material, float(np.linalg.norm(extent)))


def _negligible(known: Radial, of: Patches) -> FloatArray:
    """Return the R that, everywhere, would give all the light that enters the mean exitance.

    The mean is that of the flat limit R_d H, weighted by the light H: as the eye weights it.
    """
    crosses = np.cross(of.corners[:, 1] - of.corners[:, 0], of.corners[:, 2] - of.corners[:, 0])
    areas = 0.5 * np.sqrt(np.square(crosses).sum(axis=1))
    mean = of.light.mean(axis=1)
    power, squares = areas @ mean, areas @ np.square(mean)
    # R_d by the trapezoidal rule: int R dA = pi int R dv.
    total = np.pi * np.trapezoid(known.values, known.v, axis=0)
    floor: FloatArray = np.divide(total * squares, power**2, out=np.zeros(3), where=power > 0.0)
    return floor


def _row(of: Patches) -> Octree:
    """Return the patches as a tree of leaves alone, none of which may stand for its patch."""
    count = len(of.corners)
    ball, index = np.zeros((count, 4)), np.arange(count + 1, dtype=np.int32)
    ball[:, 3] = np.inf
    return Octree(ball, np.zeros((count, 3, 10)), index[1:], index, of.corners, of.light)
