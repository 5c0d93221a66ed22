"""How much of a surface's detail spreading light lets through, wavelength by wavelength.

To first order in the height of a bump cos(q x), light that enters changes by the tilt of the normal
alone: distance and area change at second order. What leaves is that light, blurred by the profile,
so that a local model is right where it is lit if its normals went through

    N(q) = R^(q)/R_d,    R^(q) = 2 pi int R J0(q r) r dr,

the profile itself. At the terminator of a slope b only the lit half of the surface gives light,
int_(x > 0) b x R dA. A wave of the slope, b cos(q x), gives T(q) times as much as b itself,

    T(q) = int_(x > 0) sin(q x)/q R dA / int_(x > 0) x R dA,

by which curvature is to be filtered. Even waves of N.w count by half of N(q) there, as in p(a, b)
at a = 0, and straight slopes pass both: nothing is smoothed twice.
"""

from typing import NamedTuple

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.diffusion import DiffusionProfile, Optics
from lutcore.keeping import kept

# The trapezoidal rule in log r is within 8e-4 of N for the dipole and within 3e-5 of T.
_STEP = 0.01
_NEAREST = -14.0
# Knots in log q, l_u q from 1e-4 to 1e3; 20 to an e-fold are within 3e-4 in between.
_FIRST, _LAST, _KNOT = -9.2, 6.9, 5


class Response(NamedTuple):
    """The two filters of a channel.

    Parameters
    ----------
    wavenumber : ndarray, shape=(k,)
        q, radians per l_u, growing from 0.
    normals : ndarray, shape=(k,)
        N(q), 1 at 0.
    curvature : ndarray, shape=(k,)
        T(q), 1 at 0.
    """

    wavenumber: FloatArray
    normals: FloatArray
    curvature: FloatArray


@kept
def response(profile: DiffusionProfile, optics: Optics) -> Response:
    """Return what a profile lets through; the same object for the same arguments.

    Parameters
    ----------
    profile : DiffusionProfile
        How light spreads.
    optics : Optics
        Constants of the channel, with a glow that ends (see `lutcore.baking.glowing`).

    Returns
    -------
    Response
        N and T at knots, to be interpolated linearly.
    """
    from scipy.special import j0, struve

    log_r = np.arange(_NEAREST, np.log(profile.reach(optics)), _STEP)
    r = np.exp(log_r)
    power = r * r * profile.radial(r, optics)
    count = int((_LAST - _FIRST) / (_KNOT * _STEP)) + 1
    # Both axes are logarithmic with one step: q r takes few values.
    steps = _KNOT * np.arange(count)
    qr = np.exp(_FIRST + _NEAREST + _STEP * np.arange(steps[-1] + len(r)))
    at = steps[:, None] + np.arange(len(r))
    q = np.exp(_FIRST + _STEP * steps)
    # No matrix products: their sums may depend on the number of threads.
    normals = (j0(qr)[at] * power).sum(axis=1) / power.sum()
    # The half plane's sines, over angle: int sin(z cos a) da over -pi/2 to pi/2 = pi H0(z).
    lit = np.pi * (struve(0, qr)[at] * power).sum(axis=1)
    curvature = lit / (2.0 * q * (r * power).sum())
    ends = [0.0], [1.0], [1.0]
    return Response(
        *(np.concatenate(pair) for pair in zip(ends, (q, normals, curvature), strict=True))
    )
