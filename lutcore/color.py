"""Encoding of linear light for display: the only place where values stop being linear."""

from functools import lru_cache

import numpy as np
from numba import prange
from numpy.typing import NDArray

from lutcore.arrays import FloatArray
from lutcore.compiled import compiled

# No byte is passed over within one part: sRGB rises by 0.8 bytes in it where it is steepest.
_PARTS = 4096
# Linear value that automatic exposure brings a percentile to, and which.
_WHITE, _SHARE = 0.85, 99.0
# Decoding is off by some 1e-15 of a value.
_APART = 1e-12
_HALVINGS = 16  # of twice that share of a value: doubles are 1.1e-16 of it apart, or more


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


def product_bytes(light: FloatArray, factor: FloatArray, exposure: float) -> NDArray[np.uint8]:
    """Return `srgb_bytes` of a product, several times as fast and the same to the last bit.

    Parameters
    ----------
    light : ndarray, shape=(n, 3)
        Linear values.
    factor : ndarray, shape=(n, 1) or (n, 3)
        What they are multiplied by, for all channels or for each.
    exposure : float
        Factor on the product, 0 or more.

    Returns
    -------
    ndarray of uint8, shape=(n, 3)
        sRGB bytes, rounded to nearest.
    """
    return _product_bytes(light, factor, float(exposure), *_steps())


@lru_cache(maxsize=1)
def _steps() -> tuple[FloatArray, NDArray[np.uint8]]:
    """Return the least value of each byte, and the byte at the start of each of equal parts."""
    least = np.full(257, np.inf)
    least[0] = 0.0
    steps = srgb_decode(np.arange(0.5, 255.0, dtype=np.float64) / 255.0)
    low, high = steps * (1.0 - _APART), steps * (1.0 + _APART)
    # Halved until no double lies between: the very values at which `srgb_bytes` steps.
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        reached = srgb_bytes(middle.reshape(-1, 3), 1.0).reshape(-1) >= np.arange(1, 256)
        low, high = np.where(reached, low, middle), np.where(reached, middle, high)
    least[1:256] = high
    starts = np.searchsorted(least, np.arange(_PARTS + 1) / _PARTS, side="right") - 1
    return least, starts.astype(np.uint8)


@compiled(parallel=True)
def _product_bytes(
    light: FloatArray,
    factor: FloatArray,
    exposure: float,
    least: FloatArray,
    starts: NDArray[np.uint8],
) -> NDArray[np.uint8]:
    last = factor.shape[1] - 1
    encoded = np.empty(light.shape, dtype=np.uint8)
    for i in prange(len(light)):
        for channel in range(3):
            value = exposure * (light[i, channel] * factor[i, min(channel, last)])
            value = min(max(value, 0.0), 1.0)
            byte = int(starts[int(value * _PARTS)])
            while value >= least[byte + 1]:
                byte += 1
            encoded[i, channel] = byte
    return encoded


def auto_exposure(linear: FloatArray, white: float = _WHITE, share: float = _SHARE) -> float:
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
    return _exposure(linear.max(axis=1), white, share)


def product_exposure(light: FloatArray, factor: FloatArray) -> float:
    """Return `auto_exposure` of a product, several times as fast and the same to the last bit.

    Parameters
    ----------
    light : ndarray, shape=(n, 3)
        Linear values, all finite.
    factor : ndarray, shape=(n, 1) or (n, 3)
        What they are multiplied by, for all channels or for each.

    Returns
    -------
    float
        The exposure; 1 where all is black.
    """
    brightest = np.empty(len(light))
    _brightest(light, factor, brightest)
    return _exposure(brightest, _WHITE, _SHARE)


def _exposure(brightest: FloatArray, white: float, share: float) -> float:
    lit = brightest[brightest > 0.0]
    return float(white / np.percentile(lit, share)) if lit.size else 1.0


@compiled(parallel=True)
def _brightest(light: FloatArray, factor: FloatArray, out: FloatArray) -> None:
    last = factor.shape[1] - 1
    for i in prange(len(light)):
        most = light[i, 0] * factor[i, 0]
        for channel in range(1, 3):
            most = max(most, light[i, channel] * factor[i, min(channel, last)])
        out[i] = most
