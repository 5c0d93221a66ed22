"""Radiant exitance gathered from clusters of light, or from every patch of it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, finite
from lutcore.gather.kernel import Kernel, Radial, kernel, radial
from lutcore.gather.morton import codes, runs
from lutcore.gather.octree import Octree, octree
from lutcore.gather.patches import Patches, patches, power_of
from lutcore.gather.traversal import gates, gather_at
from lutcore.progress import Progress, tell
from lutcore.progress import part as stage
from lutcore.shading import ShadingInputs

# Points of a block walk the clusters together, at most so many; where points are sparser than
# patches, the fewer the larger their block would be.
_BLOCK = 24
_DENSE = 8
_CHUNK = 256
# What one cluster may be off by, over the mean exitance, at a tolerance of 1. Found, with a margin:
# errors grow as the bound to the power of three quarters.
_SHARE, _POWER = 16.0, 4.0 / 3.0
# The same for a part of a patch in brute force, at a bound of 1.
_TINY = 1e-5


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """Light that enters a mesh in clusters, to be gathered anywhere.

    Parameters
    ----------
    tree : Octree
        The clusters.
    gate : ndarray, shape=(k, 8)
        From which distance on each may stand for its parts; see `lutcore.gather.traversal.gates`.
    chosen : Kernel
        The profile.
    mm_per_unit : float
        Millimetres in one mesh unit.
    """

    tree: Octree
    gate: FloatArray
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
        density = len(points) / max(len(self.tree.corners), 1)
        most = min(max(int(_BLOCK * _DENSE * density), 1), _BLOCK)
        return self.by_blocks(points, most, progress)

    def by_blocks(self, points: FloatArray, most: int, progress: Progress) -> FloatArray:
        """Gather at some points, which share a walk with their neighbours.

        Parameters
        ----------
        points : ndarray, shape=(q, 3)
            Where, mesh units.
        most : int
            Points of a block at most, 1 or more.
        progress : callable
            Told where the work stands; see `lutcore.progress`.

        Returns
        -------
        ndarray, shape=(q, 3)
            See `at`.

        Raises
        ------
        CancelledError
            If the progress asked to stop.
        """
        targets = points * self.mm_per_unit
        code = codes(targets)
        order = np.argsort(code, kind="stable")
        targets, start = targets[order], runs(code[order], most)
        out = np.empty((len(targets), 3))
        for begin in range(0, len(start) - 1, _CHUNK):
            tell(progress, float(start[begin]) / len(targets), "gathering light")
            some = start[begin : begin + _CHUNK + 1]
            found = gather_at(self.gate, *self.tree[1:], *_summed(self.chosen), targets, some)
            out[order[some[0] : some[-1]]] = found
        return out


def gathered(inputs: ShadingInputs, tolerance: float) -> FloatArray:
    """Gather at every vertex, far light by clusters.

    A cluster stands for its parts, by its moments up to the second, where it is off by less than a
    small share of the mean exitance: for the same error in all that is the least work. Vertices
    near each other walk the clusters together, and far clusters give them one expansion about
    their middle. The bound on what a cluster is off by supposes that all its parts err alike and as
    much as any; it is taken at a share that makes the error found, root mean square, some half
    of the tolerance at most (`tests/bench/gather.py`).

    Time grows as n log n.

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
        At any of the mesh's points it gives what `gathered` does there, within the tolerance: which
        clusters it takes depends on the other points.

    Raises
    ------
    CancelledError
        If the progress asked to stop.
    """
    tell(progress, 0.0, "sampling the light that enters")
    of = patches(inputs, tolerance)
    tell(progress, 0.5, "building the octree")
    tree = octree(of)
    known = _known(inputs)
    chosen = kernel(known, _SHARE * tolerance**_POWER * _mean(known, of))
    return _ready(tree, chosen, inputs.mm_per_unit)


def exact(inputs: ShadingInputs, points: ArrayLike, bound: float = 0.1) -> FloatArray:
    """Gather at some points from every patch, each cut until it is small enough.

    Parameters
    ----------
    inputs : ShadingInputs
        As for `gathered`.
    points : array_like, shape=(q, 3)
        Where, mesh units.
    bound : float
        Bound on the error of each part, above 0, relative to 1e-5 of the mean exitance. Errors
        found are below a thousandth of the bound.

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
    chosen = kernel(known, bound * _TINY * _mean(known, of))
    ready = _ready(_row(of), chosen, inputs.mm_per_unit)
    # One by one, so that a point's value does not depend on which others are asked for.
    return ready.by_blocks(targets, 1, stage(inputs.progress, 0.1, 1.0))


def _known(inputs: ShadingInputs) -> Radial:
    extent = np.ptp(inputs.points, axis=0) * inputs.mm_per_unit
    return radial(inputs.profile, inputs.material, float(np.linalg.norm(extent)))


def _ready(tree: Octree, chosen: Kernel, mm_per_unit: float) -> Hierarchy:
    gate = gates(tree.ball, tree.terms, chosen.bend, chosen.distance)
    return Hierarchy(tree, gate, chosen, mm_per_unit)


def _summed(chosen: Kernel) -> tuple[FloatArray, FloatArray, FloatArray, float, int]:
    return chosen.rows, chosen.per_step, chosen.bend, chosen.inner, chosen.first


def _mean(known: Radial, of: Patches) -> FloatArray:
    """Return the mean exitance of each channel.

    The mean is that of the flat limit R_d H, weighted by the light H: as the eye weights it.
    """
    power, squares = power_of(of.corners, of.light)
    # R_d by the trapezoidal rule: int R dA = pi int R dv.
    total = np.pi * np.trapezoid(known.values, known.v, axis=0)
    mean: FloatArray = np.divide(total * squares, power, out=np.zeros(3), where=power > 0.0)
    return mean


def _row(of: Patches) -> Octree:
    """Return the patches as a tree of leaves alone, none of which may stand for its patch."""
    count = len(of.corners)
    ball, index = np.zeros((count, 4)), np.arange(count + 1, dtype=np.int32)
    ball[:, 3] = np.inf
    terms = np.zeros((count, 10, 4), np.float32)
    return Octree(ball, terms, index[1:], index, of.corners, of.light)
