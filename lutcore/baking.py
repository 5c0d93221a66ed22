"""Tables made from a material and a diffusion profile."""

from dataclasses import replace
from typing import Any

import numpy as np

from lutcore.diffusion import DiffusionProfile, Optics, diffusion_profile, optics
from lutcore.errors import ParameterError
from lutcore.keeping import kept
from lutcore.lut import PsiTable
from lutcore.materials import Material
from lutcore.materials import material as built_in
from lutcore.parameters import param
from lutcore.plane import PlaneTable, tabulate

BETA_FLOOR = 0.0037
"""Least beta = l_u/l_d that a glow is computed for.

Without absorption psi(0) and <r^2> are infinite: light would wander for ever. No real body is
without: spectralon, whose absorption Jensen et al. 2001 print as 0, is sold as reflecting 99 %, and
a dipole of eta 1.3 that reflects 99 % has beta .0037. The lowest beta of their other materials is
.0090 (cream, red), so that the floor alters none of them. R_d itself stays exact.
"""

USUAL = 64
"""Samples that bring the psi of a dipole within 1e-6 of the integral."""
_SAMPLES = (8, 8192)


def samples_parameter() -> Any:
    """Declare how many samples the table of a model has.

    Returns
    -------
    dataclasses.Field
        For the plug-in's frozen dataclass; see `lutcore.shading.ShadingInputs.baked`.
    """
    doc = "Samples of psi in the table, for a dipole; a profile that needs more gets more in ratio."
    return param(USUAL, 8, 1024, "", doc)


def bake(
    material: Material | str,
    samples: int | None = None,
    profile: DiffusionProfile | str = "jensen2001",
    **parameters: Any,
) -> PsiTable:
    """Return the psi table of a material; the same object for the same arguments.

    Parameters
    ----------
    material : Material or str
        A material, or the name of a built-in one.
    samples : int, optional
        Knots, 8 to 8192; if not given, as many as bring psi within 1e-6 of the integral: 64 for
        the dipole, which is within 1e-7 with 128.
    profile : DiffusionProfile or str
        A diffusion profile, or the name of one.
    **parameters : object
        The parameters of a profile that is named.

    Returns
    -------
    PsiTable
        Where a channel's beta is below `BETA_FLOOR`, R_d is exact, the glow that of the floor,
        and `floored` is true.

    Raises
    ------
    ParameterError
        If a name is unknown or a value out of range.
    """
    chosen = diffusion_profile(profile, **parameters)
    count = chosen.knots if samples is None else whole("samples", samples, *_SAMPLES)
    return _bake(resolved(material), count, chosen)


def bake_plane(
    material: Material | str,
    size: int = 512,
    limit: float = 1.0,
    profile: DiffusionProfile | str = "jensen2001",
    **parameters: Any,
) -> PlaneTable:
    """Return the paper's own two-dimensional table over (a, b), section 3, for use as a texture.

    Parameters
    ----------
    material : Material or str
        A material, or the name of a built-in one.
    size : int
        Samples along a and along b, 8 to 8192.
    limit : float
        Largest b, .01 to 10; 1 is a radius of curvature of l_u.
    profile : DiffusionProfile or str
        A diffusion profile, or the name of one.
    **parameters : object
        The parameters of a profile that is named.

    Returns
    -------
    PlaneTable
        alpha'/(4 pi) J(a, b), the paper's p without <F_t>. Bilinear in between: within 1e-3 R_d
        at 512 x 512.

    Raises
    ------
    ParameterError
        If a name is unknown or a value out of range.
    """
    count = whole("size", size, *_SAMPLES)
    if not 0.01 <= limit <= 10.0:
        raise ParameterError.out_of_range("limit", limit, 0.01, 10.0, "l_u")
    # Far below the error of the bilinear samples.
    chosen = diffusion_profile(profile, **parameters)
    return tabulate(bake(material, 4 * chosen.knots, chosen), count, float(limit))


def resolved(material: Material | str) -> Material:
    """Return the material itself, looked up if it is a name.

    Parameters
    ----------
    material : Material or str
        A material, or the name of a built-in one.

    Returns
    -------
    Material
        The material.

    Raises
    ------
    ParameterError
        If there is none of that name.
    """
    return material if isinstance(material, Material) else built_in(material)


def glowing(exact: Optics) -> Optics:
    """Return the constants that the glow of a channel is computed for.

    Parameters
    ----------
    exact : Optics
        Constants of the channel.

    Returns
    -------
    Optics
        The same, or those of the least absorption that has a glow; see `BETA_FLOOR`.
    """
    if exact.beta >= BETA_FLOOR:
        return exact
    return replace(exact, albedo=1.0 - BETA_FLOOR**2 / 3.0)


def whole(name: str, value: int, low: int, high: int) -> int:
    """Return a whole number that was checked against its range.

    Parameters
    ----------
    name : str
        The parameter's name, for the message.
    value : int
        The value given.
    low, high : int
        The inclusive range.

    Returns
    -------
    int
        The value.

    Raises
    ------
    ParameterError
        If it is not whole or out of range.
    """
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise ParameterError(f"{name} = {value!r} is not a whole number")
    if not low <= value <= high:
        raise ParameterError.out_of_range(name, value, low, high)
    return int(value)


@kept
def _bake(material: Material, samples: int, profile: DiffusionProfile) -> PsiTable:
    psi, slope = np.empty((3, samples)), np.empty((3, samples))
    reach, total, mean_square = np.empty(3), np.empty(3), np.empty(3)
    floored = material.beta < BETA_FLOOR
    for channel, exact in enumerate(optics(material)):
        total[channel] = profile.total(exact)
        shaped = glowing(exact)
        reach[channel] = np.arcsinh(profile.reach(shaped))
        mean_square[channel] = profile.mean_square(shaped)
        t = np.linspace(0.0, reach[channel], samples)
        u = np.sinh(t)
        L0, L1 = profile.tails(u, shaped)
        of_shape = profile.total(shaped)
        psi[channel] = (L1 - u * L0) / of_shape
        slope[channel] = -np.cosh(t) * L0 / of_shape  # psi' = -L0, dpsi/dt = psi' cosh t
    eta = np.array(material.eta)
    return PsiTable(psi, slope, reach, total, material.mean_free_path, mean_square, eta, floored)
