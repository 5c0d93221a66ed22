"""Pictures with an alpha channel: from what is drawn, and to what they look like on something."""

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]
_CHECK = 12
# Dark, so that light words can be read before both.
_GREYS = 38, 62


def straight(drawn: Image) -> Image:
    """Return a picture whose colours do not depend on how much of a pixel they cover.

    What is drawn over nothing holds, at an outline, the mean colour of the samples, those that hit
    nothing counted as black: the colour times alpha. Files have the colour alone.

    Parameters
    ----------
    drawn : ndarray of uint8, shape=(height, width, 4)
        Colours multiplied by alpha.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 4)
        Colours as PNG has them; black where alpha is 0.
    """
    image = drawn.copy()
    alpha = drawn[..., 3]
    part = (alpha > 0) & (alpha < 255)
    share = alpha[part][:, None].astype(float)
    colors = np.rint(drawn[part][:, :3] * 255.0 / share)
    image[part, :3] = np.minimum(colors, 255.0).astype(np.uint8)
    image[alpha == 0] = 0
    return image


def over(image: Image, below: Image | int) -> Image:
    """Lay a picture on another.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3 or 4)
        On top; returned as it is where it has no alpha.
    below : ndarray of uint8, shape=(height, width, 3), or int
        What it is laid on; a number is a grey.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3)
        Mixed as encoded, as viewers and browsers do.
    """
    if image.shape[2] == 3:
        return image
    share = image[..., 3:] / 255.0
    mixed = share * image[..., :3] + (1.0 - share) * below
    return np.rint(mixed).astype(np.uint8)


def checks(height: int, width: int, left: int = 0, bottom: int = 0, side: int = _CHECK) -> Image:
    """Return the grey checks that stand for nothing.

    Parameters
    ----------
    height, width : int
        Pixels.
    left, bottom : int
        Where it lies in a larger one that it shall continue, pixels from the lower left corner.
    side : int
        Of a check, pixels.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3)
        The first row at the top.
    """
    rows = (bottom + np.arange(height)[::-1]) // side
    columns = (left + np.arange(width)) // side
    odd = (rows[:, None] + columns) % 2
    greys = np.array(_GREYS, np.uint8)[odd]
    return np.repeat(greys[..., None], 3, axis=2)


def with_alpha(image: Image) -> Image:
    """Return a picture with an alpha channel, opaque where it had none.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3 or 4)
        Any picture.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 4)
        The same.
    """
    if image.shape[2] == 4:
        return image
    return np.concatenate([image, np.full_like(image[..., :1], 255)], axis=2)


def without_need(image: Image) -> Image:
    """Leave an alpha channel out that says nothing: programs add and drop such ones.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3 or 4)
        Any picture.

    Returns
    -------
    ndarray of uint8, shape=(height, width, 3 or 4)
        With an alpha channel only where something can be seen through.
    """
    if image.shape[2] == 4 and (image[..., 3] == 255).all():
        return np.ascontiguousarray(image[..., :3])
    return image
