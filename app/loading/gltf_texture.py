"""The base colour textures of a glTF document."""

from typing import Any

import numpy as np

from app.loading.errors import BadContentError
from app.loading.gltf_arrays import Arrays
from app.loading.gltf_buffers import Buffers
from app.loading.surface import RawTexture
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
        self._images: dict[int, int] = {}
        self._contents: list[tuple[str, bytes]] = []
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
            found = self._texture(primitive)
            if found is not None:
                which, name = found
                places = self._coordinates(primitive["attributes"][name], count)
                uv = places[faces.reshape(-1)]
        except _BROKEN as error:
            problem = error.problem if isinstance(error, BadContentError) else repr(error)
            self._warnings.append(f"a part's texture cannot be used: {problem:.200}")
            which = -1
        self._places.append(uv)
        self._which.append(np.full(len(faces), which))

    def joined(self) -> RawTexture | None:
        """Return the textures of all parts.

        Returns
        -------
        RawTexture or None
            None if there are none.
        """
        if not self._contents:
            return None
        return RawTexture(np.concatenate(self._places), np.concatenate(self._which), self._contents)

    def _texture(self, primitive: dict[str, Any]) -> tuple[int, str] | None:
        """Return the number of a part's picture, and the attribute with the places on it."""
        if "material" not in primitive:
            return None
        material = self._document["materials"][primitive["material"]]
        told = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
        if told is None:
            return None
        if "KHR_texture_transform" in told.get("extensions", {}):
            raise BadContentError("it is moved by KHR_texture_transform")
        source = self._document["textures"][told["index"]]["source"]
        if source not in self._images:
            self._contents.append((f"image {source}", self._picture(source)))
            self._images[source] = len(self._contents) - 1
        return self._images[source], f"TEXCOORD_{int(told.get('texCoord', 0))}"

    def _picture(self, source: int) -> bytes:
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
        # The format counts from the upper left.
        return np.stack([stored[:, 0], 1.0 - stored[:, 1].astype(np.float64)], axis=1)
