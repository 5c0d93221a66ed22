"""The base colour textures of a glTF document."""

from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from app.loading.gltf_arrays import Arrays
from app.loading.gltf_buffers import Buffers
from app.loading.gltf_places import attribute, moved, wrap_of
from app.loading.surface import RawPicture, RawTexture
from lutcore.arrays import AnyArray, FloatArray

# What a broken texture shows as: it costs the texture, never the mesh.
_BROKEN = (BadContentError, KeyError, TypeError, ValueError, AttributeError, IndexError)


class Textures:
    """Gathers the textures of the parts of a scene, one after another.

    Parameters
    ----------
    document : dict
        The file's JSON.
    arrays : Arrays
        Its accessors.
    buffers : Buffers
        Where its pictures are.
    warnings : list of str
        Grows by what cannot be used.
    """

    def __init__(
        self, document: dict[str, Any], arrays: Arrays, buffers: Buffers, warnings: list[str]
    ) -> None:
        self._document, self._arrays, self._buffers = document, arrays, buffers
        self._warnings = warnings
        self._contents: dict[int, bytes] = {}
        self._pictures: dict[RawPicture, int] = {}
        self._places: list[FloatArray] = []
        self._which: list[AnyArray] = []

    def add(self, primitive: dict[str, Any], faces: AnyArray, count: int) -> None:
        """Add a part.

        Parameters
        ----------
        primitive : dict
            The part.
        faces : ndarray of int, shape=(m, 3)
            Its triangles over its own vertices.
        count : int
            Number of its vertices.
        """
        uv, which = np.full((faces.size, 2), np.nan), -1
        try:
            material = self._material(primitive)
            told = material.get("baseColorTexture")
            if told is None:
                which, uv = self._number(self._plain(material)), np.zeros((faces.size, 2))
            else:
                picture = self._picture(told, _tint(material))
                places = self._coordinates(primitive["attributes"][attribute(told)], count)
                uv = moved(places, told)[faces.reshape(-1)]
                which = self._number(picture)
        except _BROKEN as error:
            problem = error.problem if isinstance(error, BadContentError) else repr(error)
            self._warnings.append(f"a part's texture cannot be used: {problem:.200}")
        self._places.append(uv)
        self._which.append(np.full(len(faces), which))

    def joined(self) -> RawTexture | None:
        """Return the textures of all parts.

        Returns
        -------
        RawTexture or None
            None if there are none. Colours without a picture are not worth one.
        """
        if not self._contents:
            return None
        return RawTexture(
            np.concatenate(self._places), np.concatenate(self._which), list(self._pictures)
        )

    def _material(self, primitive: dict[str, Any]) -> dict[str, Any]:
        """Return what is said of a part's colour."""
        if "material" not in primitive:
            return {}
        found = self._document["materials"][primitive["material"]]
        color: dict[str, Any] = found.get("pbrMetallicRoughness", {})
        return color

    def _number(self, picture: RawPicture) -> int:
        return self._pictures.setdefault(picture, len(self._pictures))

    def _plain(self, material: dict[str, Any]) -> RawPicture:
        return RawPicture("a colour", None, _tint(material))

    def _picture(self, told: dict[str, Any], tint: tuple[float, float, float]) -> RawPicture:
        texture = self._document["textures"][told["index"]]
        source = texture["source"]
        if source not in self._contents:
            self._contents[source] = self._content(source)
        wrap = wrap_of(self._document, texture)
        return RawPicture(f"image {source}", self._contents[source], tint, wrap)

    def _content(self, source: int) -> bytes:
        image = self._document["images"][source]
        if "bufferView" not in image:
            return self._buffers.named(image["uri"], f"image {source}")
        view = self._document["bufferViews"][image["bufferView"]]
        data = self._buffers.get(view["buffer"])
        start, length = view.get("byteOffset", 0), view["byteLength"]
        if start < 0 or length < 0 or start + length > len(data):
            raise BadContentError(f"image {source} reaches beyond the data")
        return bytes(data[start : start + length])

    def _coordinates(self, index: int, count: int) -> FloatArray:
        if self._arrays.count(index) != count:
            raise BadContentError("its coordinates do not fit the vertices")
        stored = self._arrays.get(index)
        if stored.shape[1] != 2:
            raise BadContentError("its coordinates are not pairs")
        return stored


def _tint(material: dict[str, Any]) -> tuple[float, float, float]:
    """Return baseColorFactor without its opacity."""
    factor = np.array(material.get("baseColorFactor", (1.0,) * 4), dtype=np.float64)
    if factor.shape != (4,) or not ((factor >= 0.0) & (factor <= 1.0)).all():
        raise BadContentError("its baseColorFactor is not four numbers from 0 to 1")
    red, green, blue, _ = factor.tolist()
    return red, green, blue
