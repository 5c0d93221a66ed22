"""What leaves a sphere, or a paraboloid at its apex, by quadrature of any diffusion profile.

Both are surfaces of revolution about the normal, on which the normal is turned by gamma: light
enters along rings of one gamma, whose distance to the point is the same all around.
"""

import numpy as np
from numba import prange

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled
from lutcore.diffusion import DiffusionProfile, Optics
from lutcore.fresnel import compiled_transmittance

# Gauss-Legendre nodes of a panel and of a lit arc.
_NODES, _ARC_NODES = 10, 16
_SMALLEST, _CLOSEST = 0.05, 1e-30


def on_sphere(
    cosines: FloatArray, s: float, profile: DiffusionProfile, optics: Optics
) -> FloatArray:
    """Return the exitance of a sphere per R_d and unit normal irradiance, F_t inside.

    Parameters
    ----------
    cosines : ndarray, shape=(n,)
        N.w, -1 to 1.
    s : float
        l_u/radius, above 0.
    profile : DiffusionProfile
        Its radial profile is taken at the chord, 2 sin(gamma/2)/s.
    optics : Optics
        Constants of the channel.

    Returns
    -------
    ndarray, shape=(n,)
        Its integral over the sphere is at most that of the flat surface's: rings between two
        chords have the area of rings in the plane between the same radii.
    """
    gamma, width = _rings(cosines, _doubling(min(_SMALLEST * s, 0.5), np.pi))
    chord = 2.0 / s * np.sin(0.5 * gamma)
    area = np.sin(gamma) / s**2
    return _gathered(cosines, gamma, width * area * profile.radial(chord, optics), optics, profile)


def on_paraboloid(
    cosines: FloatArray, s: float, profile: DiffusionProfile, optics: Optics
) -> FloatArray:
    """Return the exitance at the apex of z = -s r^2/2 per R_d and unit normal irradiance.

    Parameters
    ----------
    cosines : ndarray, shape=(n,)
        N.w, -1 to 1.
    s : float
        l_u x curvature, above 0.
    profile : DiffusionProfile
        Its radial profile is taken at the distance in space, r sqrt(1 + s^2 r^2/4).
    optics : Optics
        Constants of the channel.

    Returns
    -------
    ndarray, shape=(n,)
        The exact Monge patch of an umbilic, with its true normal, area and F_t inside.
    """
    ends = np.arctan(s * _doubling(_SMALLEST, profile.reach(optics)))
    gamma, width = _rings(cosines, ends)
    r = np.tan(gamma) / s
    distance = r * np.sqrt(1.0 + 0.25 * (s * r) ** 2)
    area = np.sin(gamma) / np.cos(gamma) ** 4 / s**2  # r dr/cos(gamma)
    flux = width * area * profile.radial(distance, optics)
    return _gathered(cosines, gamma, flux, optics, profile)


def _doubling(first: float, last: float) -> FloatArray:
    # The profile varies on the scale of l_u at its centre, and of its distance further out.
    count = 2 + int(np.log2(last / first))
    return np.concatenate(([0.0], np.geomspace(first, last, count)))


def _rings(cosines: FloatArray, panels: FloatArray) -> tuple[FloatArray, FloatArray]:
    # The lit arc changes form where gamma crosses |90 deg - theta| and its supplement.
    edge = np.abs(np.arcsin(cosines))[:, None]
    every = np.broadcast_to(panels, (len(cosines), len(panels)))
    ends = np.hstack((every, edge, np.pi - edge))
    ends = np.sort(np.minimum(ends, panels[-1]), axis=1)
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    half = 0.5 * np.diff(ends, axis=1)[:, :, None]
    gamma = 0.5 * (ends[:, 1:] + ends[:, :-1])[:, :, None] + half * node
    # Panels without width begin at 0, where a profile may be infinite.
    gamma = np.maximum(gamma, _CLOSEST)
    return gamma.reshape(len(cosines), -1), (half * weight).reshape(len(cosines), -1)


def _gathered(
    cosines: FloatArray,
    gamma: FloatArray,
    flux: FloatArray,
    optics: Optics,
    profile: DiffusionProfile,
) -> FloatArray:
    node, weight = np.polynomial.legendre.leggauss(_ARC_NODES)
    around = _around(cosines, gamma, optics.eta, 0.5 * (node + 1.0), 0.5 * weight)
    gathered: FloatArray = np.sum(flux * around, axis=1) / profile.total(optics)
    return gathered


@compiled(parallel=True)
def _around(
    cosines: FloatArray, gamma: FloatArray, eta: float, node: FloatArray, weight: FloatArray
) -> FloatArray:
    """Integrate c F_t(c) over the lit azimuths of each ring; shape (n, m)."""
    out = np.zeros(gamma.shape)
    for i in prange(len(cosines)):
        sine = np.sqrt(max(1.0 - cosines[i] * cosines[i], 0.0))
        for j in range(gamma.shape[1]):
            along, across = cosines[i] * np.cos(gamma[i, j]), sine * np.sin(gamma[i, j])
            if along <= -across:
                continue
            last = np.pi if along >= across else np.arccos(-along / across)
            for k in range(len(node)):
                c = along + across * np.cos(last * node[k])
                if c > 0.0:
                    c = min(c, 1.0)
                    out[i, j] += 2.0 * last * weight[k] * c * compiled_transmittance(c, eta)
    return out
