"""Where on its picture a glTF part's texture coordinates lie."""

from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from app.loading.texture_wrap import CLAMP, MIRROR, REPEAT, Wrap
from lutcore.arrays import FloatArray

_TRANSFORM = "KHR_texture_transform"
# WebGL's numbers, as glTF has them.
_WRAPS = {10497: REPEAT, 33071: CLAMP, 33648: MIRROR}


def attribute(told: dict[str, Any]) -> str:
    """Return the name of the coordinates that a part uses.

    Parameters
    ----------
    told : dict
        The material's textureInfo.

    Returns
    -------
    str
        ``TEXCOORD_n``.
    """
    return f"TEXCOORD_{int(_transform(told).get('texCoord', told.get('texCoord', 0)))}"


def moved(places: FloatArray, told: dict[str, Any]) -> FloatArray:
    """Return coordinates as KHR_texture_transform moves them, and as OBJ counts them.

    Parameters
    ----------
    places : ndarray, shape=(n, 2)
        As stored: (0, 0) is the picture's upper left.
    told : dict
        The material's textureInfo.

    Returns
    -------
    ndarray, shape=(n, 2)
        Scaled, turned counter-clockwise and shifted; (0, 0) is the lower left.

    Raises
    ------
    BadContentError
        If the extension says no numbers.
    """
    how = _transform(told)
    try:
        scale = np.array(how.get("scale", (1.0, 1.0)), dtype=np.float64)
        offset = np.array(how.get("offset", (0.0, 0.0)), dtype=np.float64)
        angle = float(how.get("rotation", 0.0))
    except (TypeError, ValueError):
        raise BadContentError(f"{_TRANSFORM} says no numbers") from None
    whole = scale.shape == offset.shape == (2,)
    if not (whole and np.isfinite([*scale, *offset, angle]).all()):
        raise BadContentError(f"{_TRANSFORM} says no numbers")
    c, s = np.cos(angle), np.sin(angle)
    # v points down, so that this turns counter-clockwise as seen.
    u, v = (places.astype(np.float64) * scale).T
    u, v = c * u + s * v + offset[0], c * v - s * u + offset[1]
    return np.stack([u, 1.0 - v], axis=1)


def wrap_of(document: dict[str, Any], texture: dict[str, Any]) -> tuple[Wrap, Wrap]:
    """Return how a texture goes on beyond its picture.

    Parameters
    ----------
    document : dict
        The file's JSON.
    texture : dict
        One of its textures.

    Returns
    -------
    tuple of 2 str
        Across and up.

    Raises
    ------
    BadContentError
        If its sampler says what there is not.
    """
    if "sampler" not in texture:
        return REPEAT, REPEAT
    sampler = document["samplers"][texture["sampler"]]
    found = []
    for name in ("wrapS", "wrapT"):
        number = sampler.get(name, 10497)
        if number not in _WRAPS:
            raise BadContentError(f"its sampler's {name} is {number!r}")
        found.append(_WRAPS[number])
    return found[0], found[1]


def _transform(told: dict[str, Any]) -> dict[str, Any]:
    how = told.get("extensions", {}).get(_TRANSFORM, {})
    if not isinstance(how, dict):
        raise BadContentError(f"{_TRANSFORM} is no object")
    return how
