"""Homogeneous translucent materials."""

import dataclasses
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lutcore.arrays import FloatArray, finite
from lutcore.errors import ParameterError

_ETA_RANGE = (1.0, 3.0)


@dataclass(frozen=True, init=False)
class Material:
    """A translucent material, by channel (linear red, green, blue).

    Parameters
    ----------
    name : str
        Its name.
    scattering : array_like, shape=(3,)
        Reduced scattering coefficient sigma_s', 1/mm, above 0.
    absorption : array_like, shape=(3,)
        Absorption coefficient sigma_a, 1/mm, 0 or more.
    eta : array_like, shape=() or (3,)
        Refractive index relative to the air outside, 1 to 3; one number stands for all channels.

    Attributes
    ----------
    scattering, absorption, eta : tuple of 3 floats
        Plain numbers, so that equal materials are equal keys of the table cache.

    Raises
    ------
    ParameterError
        If a value is out of range.
    """

    name: str
    scattering: tuple[float, float, float]
    absorption: tuple[float, float, float]
    eta: tuple[float, float, float]

    def __init__(
        self, name: str, scattering: ArrayLike, absorption: ArrayLike, eta: ArrayLike
    ) -> None:
        scatters = finite("scattering", scattering, (3,))
        absorbs = finite("absorption", absorption, (3,))
        indices = np.broadcast_to(finite("eta", eta, (), (3,)), 3)
        if (scatters <= 0.0).any():
            raise ParameterError(f"scattering = {scattering!r} must be above 0 per mm")
        if (absorbs < 0.0).any():
            raise ParameterError(f"absorption = {absorption!r} must be 0 or more per mm")
        if (indices < _ETA_RANGE[0]).any() or (indices > _ETA_RANGE[1]).any():
            raise ParameterError.out_of_range("eta", eta, *_ETA_RANGE)
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "scattering", tuple(scatters.tolist()))
        object.__setattr__(self, "absorption", tuple(absorbs.tolist()))
        object.__setattr__(self, "eta", tuple(indices.tolist()))

    @property
    def mean_free_path(self) -> FloatArray:
        """Mean free path l_u = 1/(sigma_s' + sigma_a) by channel, mm (Jensen et al. 2001)."""
        extinction: FloatArray = np.array(self.scattering) + np.array(self.absorption)
        return 1.0 / extinction

    @property
    def albedo(self) -> FloatArray:
        """Reduced albedo alpha' = sigma_s' l_u by channel (Jensen et al. 2001)."""
        return np.array(self.scattering) * self.mean_free_path

    @property
    def beta(self) -> FloatArray:
        """The paper's beta = sqrt(3 (1 - alpha')) by channel: l_u/l_d, 0 without absorption."""
        return np.sqrt(3.0 * np.array(self.absorption) * self.mean_free_path)

    def scaled(self, scattering: ArrayLike = 1.0, absorption: ArrayLike = 1.0) -> "Material":
        """Return the material with its coefficients multiplied.

        Parameters
        ----------
        scattering, absorption : array_like, shape=() or (3,)
            Factors, for all channels or for each. To replace a coefficient instead, use
            `dataclasses.replace`.

        Returns
        -------
        Material
            Of the same name and refractive index.

        Raises
        ------
        ParameterError
            If a factor is not finite or the product out of range.
        """
        return dataclasses.replace(
            self,
            scattering=_product(self.scattering, finite("scattering", scattering, (), (3,))),
            absorption=_product(self.absorption, finite("absorption", absorption, (), (3,))),
        )


def _product(
    coefficients: tuple[float, float, float], factor: FloatArray
) -> tuple[float, float, float]:
    red, green, blue = (factor * coefficients).tolist()
    return red, green, blue


# Jensen, Marschner, Levoy and Hanrahan, "A Practical Model for Subsurface Light Transport",
# SIGGRAPH 2001, figure 5: sigma_s' and sigma_a, 1/mm, RGB; eta is 1.3 but for marble's 1.5.
_JENSEN_2001 = (
    Material("apple", (2.29, 2.39, 1.97), (0.0030, 0.0034, 0.046), 1.3),
    Material("chicken1", (0.15, 0.21, 0.38), (0.015, 0.077, 0.19), 1.3),
    Material("chicken2", (0.19, 0.25, 0.32), (0.018, 0.088, 0.20), 1.3),
    Material("cream", (7.38, 5.47, 3.15), (0.0002, 0.0028, 0.0163), 1.3),
    Material("ketchup", (0.18, 0.07, 0.03), (0.061, 0.97, 1.45), 1.3),
    Material("marble", (2.19, 2.62, 3.00), (0.0021, 0.0041, 0.0071), 1.5),
    Material("potato", (0.68, 0.70, 0.55), (0.0024, 0.0090, 0.12), 1.3),
    Material("skimmilk", (0.70, 1.22, 1.90), (0.0014, 0.0025, 0.0142), 1.3),
    Material("skin1", (0.74, 0.88, 1.01), (0.032, 0.17, 0.48), 1.3),
    Material("skin2", (1.09, 1.59, 1.79), (0.013, 0.070, 0.145), 1.3),
    Material("spectralon", (11.6, 20.4, 14.9), (0.0, 0.0, 0.0), 1.3),
    Material("wholemilk", (2.55, 3.21, 3.77), (0.0011, 0.0024, 0.014), 1.3),
)
_BY_NAME = {entry.name: entry for entry in _JENSEN_2001}


def materials() -> list[str]:
    """Return the names of the built-in materials.

    Returns
    -------
    list of str
        Sorted; those measured by Jensen et al. 2001.
    """
    return sorted(_BY_NAME)


def material(name: str) -> Material:
    """Return a built-in material.

    Parameters
    ----------
    name : str
        One of `materials`.

    Returns
    -------
    Material
        Its coefficients in 1/mm.

    Raises
    ------
    ParameterError
        If there is none of that name.

    References
    ----------
    .. [1] H. W. Jensen, S. R. Marschner, M. Levoy and P. Hanrahan, "A Practical Model for
       Subsurface Light Transport", SIGGRAPH 2001, figure 5.
    """
    if not isinstance(name, str) or name not in _BY_NAME:
        raise ParameterError.unknown("material", name, _BY_NAME)
    return _BY_NAME[name]
