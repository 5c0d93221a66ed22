"""Encoding of linear light for display: the only place where values stop being linear."""

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled


def srgb_decode(encoded: FloatArray) -> FloatArray:
    """Return linear light from sRGB-encoded values.

    Parameters
    ----------
    encoded : ndarray
        Encoded values, 0 to 1, any shape.

    Returns
    -------
    ndarray
        Linear values, 0 to 1.

    References
    ----------
    IEC 61966-2-1:1999, sRGB.
    """
    low = encoded / 12.92
    return np.where(encoded <= 0.04045, low, ((encoded + 0.055) / 1.055) ** 2.4)


@compiled()
def _encode(linear: float) -> float:
    if linear <= 0.0031308:
        return 12.92 * max(linear, 0.0)
    return 1.055 * min(linear, 1.0) ** (1.0 / 2.4) - 0.055


@compiled()
def _encode_all(linear: FloatArray) -> FloatArray:
    encoded = np.empty_like(linear)
    for i in range(len(linear)):
        encoded[i] = _encode(linear[i])
    return encoded


def srgb_encode(linear: FloatArray) -> FloatArray:
    """Return sRGB-encoded values of linear light.

    Parameters
    ----------
    linear : ndarray
        Linear values, any shape; clipped to 0 and 1.

    Returns
    -------
    ndarray
        Encoded values, 0 to 1.

    References
    ----------
    IEC 61966-2-1:1999, sRGB.
    """
    return _encode_all(linear.ravel()).reshape(linear.shape)


@compiled(parallel=True)
def srgb_bytes(linear: FloatArray, exposure: float) -> NDArray[np.uint8]:
    """Return what a display is sent for linear RGB values.

    Parameters
    ----------
    linear : ndarray, shape=(n, 3)
        Linear values; exposure 1 shows 1 as white. Clipped, never wrapped.
    exposure : float
        Factor on the values, 0 or more.

    Returns
    -------
    ndarray of uint8, shape=(n, 3)
        sRGB bytes, rounded to nearest.

    References
    ----------
    IEC 61966-2-1:1999, sRGB.
    """
    count = linear.shape[0]
    encoded = np.empty((count, 3), dtype=np.uint8)
    for i in prange(count):
        for channel in range(3):
            encoded[i, channel] = np.uint8(255.0 * _encode(exposure * linear[i, channel]) + 0.5)
    return encoded


def auto_exposure(linear: FloatArray, white: float = 0.85, share: float = 99.0) -> float:
    """Return the exposure that brings a high percentile of the brightest channel near white.

    Parameters
    ----------
    linear : ndarray, shape=(n, 3)
        Linear values.
    white : float
        Linear value, 0 to 1, that the percentile is brought to.
    share : float
        The percentile, among values above zero.

    Returns
    -------
    float
        The exposure; 1 where all is black.
    """
    brightest = linear.max(axis=1)
    lit = brightest[brightest > 0.0]
    return float(white / np.percentile(lit, share)) if lit.size else 1.0
