"""What a smooth dielectric surface does to a ray: Fresnel's reflection and Snell's refraction."""

import numpy as np

from lutcore.compiled import compiled


@compiled()
def inner_reflectance(cosine: float, eta: float) -> float:
    """Return the share of unpolarised light that the surface sends back inside.

    Parameters
    ----------
    cosine : float
        Cosine of the angle to the normal inside the medium, 0 to 1.
    eta : float
        Refractive index relative to the outside, 1 or more.

    Returns
    -------
    float
        Reflectance, 1 beyond the critical angle.
    """
    sine = eta * eta * (1.0 - cosine * cosine)
    if sine >= 1.0:
        # At index one grazing light, too, leaves.
        return 1.0 if eta > 1.0 else 0.0
    outside = np.sqrt(1.0 - sine)
    crossing = (eta * cosine - outside) / (eta * cosine + outside)
    parallel = (cosine - eta * outside) / (cosine + eta * outside)
    reflected: float = 0.5 * (crossing * crossing + parallel * parallel)
    return reflected


@compiled()
def refracted(
    wx: float, wy: float, wz: float, nx: float, ny: float, nz: float, eta: float
) -> tuple[float, float, float]:
    """Return the direction in which light from w travels inside.

    Parameters
    ----------
    wx, wy, wz : float
        Unit vector TO the light.
    nx, ny, nz : float
        Outward unit normal.
    eta : float
        Refractive index relative to the outside, 1 or more.

    Returns
    -------
    tuple of float
        Unit vector of travel.
    """
    cosine = wx * nx + wy * ny + wz * nz
    inside = np.sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta))
    along = cosine / eta - inside
    return along * nx - wx / eta, along * ny - wy / eta, along * nz - wz / eta
