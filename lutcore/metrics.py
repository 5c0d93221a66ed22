"""How different two pictures' colours are to the eye."""

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray
from lutcore.color import srgb_decode

# IEC 61966-2-1:1999, of its primaries under D65, x = .3127 and y = .3290.
_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_WHITE = np.array([0.3127, 0.3290, 1.0 - 0.3127 - 0.3290]) / 0.3290
_POWER = 25.0**7


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
    CIE 142:2001; see `ciede2000_lab`.
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

    References
    ----------
    CIE 15:2004, section 8.2.1.
    """
    share = srgb_decode(encoded) @ _TO_XYZ.T / _WHITE
    x, y, z = np.moveaxis(
        np.where(share > (6 / 29) ** 3, np.cbrt(share), share * (29 / 6) ** 2 / 3 + 4 / 29), -1, 0
    )
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


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

    References
    ----------
    Sharma, Wu and Dalal, The CIEDE2000 Color-Difference Formula, 2005; numbers are its equations'.
    """
    (l1, a1, b1), (l2, a2, b2) = (np.moveaxis(np.asarray(lab), -1, 0) for lab in (one, other))
    grey = 1.5 - 0.5 * _crowded(0.5 * (np.hypot(a1, b1) + np.hypot(a2, b2)))  # 1 + G, 4
    a1, a2 = grey * a1, grey * a2  # 5
    c1, c2 = np.hypot(a1, b1), np.hypot(a2, b2)  # 6
    h1, h2 = (np.degrees(np.arctan2(b, a)) % 360.0 for a, b in ((a1, b1), (a2, b2)))  # 7
    turn = h2 - h1
    turn = turn - 360.0 * np.sign(turn) * (np.abs(turn) > 180.0)
    dh = 2.0 * np.sqrt(c1 * c2) * np.sin(np.radians(0.5 * turn))  # 10, 11: 0 where one is grey
    # 14: half way from one hue to the other, or that of the one that has any.
    hue = np.where(c1 * c2 == 0.0, h1 + h2, (h1 + 0.5 * turn) % 360.0)
    light, chroma = 0.5 * (l1 + l2), 0.5 * (c1 + c2)  # 12, 13
    weight = 1.0 + sum(
        factor * np.cos(np.radians(times * hue - start))
        for factor, times, start in (
            (-0.17, 1.0, 30.0), (0.24, 2.0, 0.0), (0.32, 3.0, -6.0), (-0.20, 4.0, 63.0),
        )
    )  # 15  # fmt: skip
    away = (light - 50.0) ** 2
    dl = (l2 - l1) / (1.0 + 0.015 * away / np.sqrt(20.0 + away))  # 8, 18
    dc = (c2 - c1) / (1.0 + 0.045 * chroma)  # 9, 19
    dh = dh / (1.0 + 0.015 * chroma * weight)  # 20
    blue = 60.0 * np.exp(-(((hue - 275.0) / 25.0) ** 2))  # 2 x 16
    rotated = -2.0 * _crowded(chroma) * np.sin(np.radians(blue))  # 17, 21
    return np.asarray(np.sqrt(dl**2 + dc**2 + dh**2 + rotated * dc * dh))  # 22


def _crowded(chroma: FloatArray) -> FloatArray:
    power = chroma**7
    return np.asarray(np.sqrt(power / (power + _POWER)))
