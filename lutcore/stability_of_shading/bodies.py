"""Places of known curvature under light of a known height, as inputs of shading models."""

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures
from lutcore.diffusion import DiffusionProfile
from lutcore.lights import DirectionalLight
from lutcore.materials import Material
from lutcore.mesh import TriangleMesh
from lutcore.shading import ShadingInputs, shading_inputs

LENGTH = 1.0
"""l_u of the substances made here, mm: their lengths in mm are lengths in l_u."""


def substance(betas: ArrayLike, eta: float) -> Material:
    """Return a material by the betas of its channels.

    Parameters
    ----------
    betas : array_like, shape=(3,)
        beta = sqrt(3 (1 - alpha')) = l_u/l_d, 0 to below sqrt(3).
    eta : float
        Refractive index.

    Returns
    -------
    Material
        With l_u = `LENGTH` in all channels.
    """
    absorption = np.square(np.asarray(betas, dtype=np.float64)) / 3.0 / LENGTH
    a, b, c = absorption.tolist()
    scattering = (1.0 / LENGTH - a, 1.0 / LENGTH - b, 1.0 / LENGTH - c)
    return Material("substance", scattering, (a, b, c), eta)


def places(
    cosines: ArrayLike,
    k1: ArrayLike,
    k2: ArrayLike,
    material: Material,
    profile: DiffusionProfile,
) -> ShadingInputs:
    """Return places that differ in curvature and in the height of one light of unit irradiance.

    Parameters
    ----------
    cosines : array_like, shape=(n,)
        N.w, at least three.
    k1, k2 : array_like, shape=() or (n,)
        Curvature along the light and across it, 1/mm, convex positive.
    material : Material
        The substance.
    profile : DiffusionProfile
        How light spreads in it.

    Returns
    -------
    ShadingInputs
        For local models: there is no surface between the places.
    """
    c = np.asarray(cosines, dtype=np.float64)
    sine, zero = np.sqrt(np.maximum(1.0 - c * c, 0.0)), np.zeros(len(c))
    normals = np.stack([sine, zero, c], axis=1)
    along = np.stack([c, zero, -sine], axis=1)
    across = np.stack([zero, zero + 1.0, zero], axis=1)
    first, second = (np.broadcast_to(np.asarray(k, dtype=np.float64), c.shape) for k in (k1, k2))
    bends = PrincipalCurvatures(first, second, along, across, normals, zero, 0.0)
    # One face makes it a mesh: local models look at vertices alone.
    mesh = TriangleMesh(normals, [[0, 1, 2]])
    light = DirectionalLight((0.0, 0.0, 1.0))
    return shading_inputs(mesh, bends, material, [light], profile=profile)


def sphere_nodes(count: int) -> tuple[FloatArray, FloatArray]:
    """Return a quadrature over a sphere for what depends on N.w alone.

    Parameters
    ----------
    count : int
        Nodes on each half.

    Returns
    -------
    cosines : ndarray, shape=(2 count,)
        N.w, ascending: equal steps are equal areas, and what leaves bends at the terminator.
    shares : ndarray, shape=(2 count,)
        Of the area.
    """
    x, weights = np.polynomial.legendre.leggauss(count)
    cosines = np.concatenate((0.5 * (x - 1.0), 0.5 * (x + 1.0)))
    return cosines, 0.25 * np.concatenate((weights, weights))
