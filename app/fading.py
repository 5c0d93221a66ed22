"""Colours that turn grey where a curvature is not told from zero."""

import numpy as np
from numpy.typing import NDArray

from app.scene import ColorScale
from lutcore.arrays import FloatArray
from lutcore.curvature import PrincipalCurvatures

_GREY = 0.62
# |k| in units of its error: at one all is grey, at two the colour is back.
_GONE, _BACK = 1.0, 2.0


def faded(
    values: FloatArray, scale: ColorScale, curvatures: PrincipalCurvatures
) -> NDArray[np.uint8]:
    """Return the colours of values, grey where neither |k1| nor |k2| exceeds its error.

    Parameters
    ----------
    values : ndarray, shape=(n,)
        What the colours tell.
    scale : ColorScale
        How.
    curvatures : PrincipalCurvatures
        Of the same vertices.

    Returns
    -------
    ndarray of uint8, shape=(n, 3)
        sRGB-encoded; the grey goes over into the full colour up to twice the error.
    """
    last = len(scale.colors) - 1
    # As VTK's lookup table: equal bins, their ends among them.
    share = (values - scale.low) / (scale.high - scale.low)
    color = scale.colors[np.clip(share * (last + 1), 0, last).astype(np.int64)]
    weight = certainty(curvatures)[:, None]
    rgb: NDArray[np.uint8] = np.rint(255.0 * (_GREY + weight * (color - _GREY))).astype(np.uint8)
    return rgb


def certainty(curvatures: PrincipalCurvatures) -> FloatArray:
    """Return how far a curvature is told from zero.

    Parameters
    ----------
    curvatures : PrincipalCurvatures
        Of n vertices.

    Returns
    -------
    ndarray, shape=(n,)
        0 up to an error that is as large as the larger |k|, 1 from half of it on; between them
        smooth.
    """
    largest = np.maximum(np.abs(curvatures.k1), np.abs(curvatures.k2))
    error = curvatures.error
    told = np.divide(largest, error, out=np.full(len(error), np.inf), where=error > 0.0)
    share = np.clip((told - _GONE) / (_BACK - _GONE), 0.0, 1.0)
    smooth: FloatArray = share**2 * (3.0 - 2.0 * share)
    return smooth
