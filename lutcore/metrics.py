"""How different two pictures' colours are to the eye."""

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray


def ciede2000(one: NDArray[np.uint8], other: NDArray[np.uint8]) -> FloatArray:
    """Return the CIEDE2000 colour difference of sRGB bytes, element by element.

    Parameters
    ----------
    one, other : ndarray of uint8, shape=(..., 3)
        sRGB-encoded colours.

    Returns
    -------
    ndarray, shape=(...)
        About 1 is just noticeable side by side.

    References
    ----------
    CIE 142:2001; Sharma, Wu and Dalal 2005. Computed by colour-science.
    """
    return ciede2000_lab(lab(one / 255.0), lab(other / 255.0))


def lab(encoded: FloatArray) -> FloatArray:
    """Return CIE L*a*b* under D65 of sRGB-encoded values.

    Parameters
    ----------
    encoded : ndarray, shape=(..., 3)
        sRGB-encoded, 0 to 1; not rounded to bytes, whose steps in the dark are a CIEDE2000 of 1.

    Returns
    -------
    ndarray, shape=(..., 3)
        The colours.
    """
    import colour

    return np.asarray(colour.XYZ_to_Lab(colour.sRGB_to_XYZ(encoded)), dtype=np.float64)


def ciede2000_lab(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return the CIEDE2000 colour difference of CIE L*a*b* colours, element by element.

    Parameters
    ----------
    one, other : ndarray, shape=(..., 3)
        Colours under one white.

    Returns
    -------
    ndarray, shape=(...)
        The differences.
    """
    import colour

    return np.asarray(colour.delta_E(one, other, method="CIE 2000"), dtype=np.float64)
