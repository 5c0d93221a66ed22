"""The picture that a file wraps around its surface: decoded, checked, and as it is drawn."""

import io
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from app.loading.atlas import joined
from app.loading.checks import checked
from app.loading.errors import BadContentError
from app.loading.surface import RawPicture, RawSurface, RawTexture
from app.loading.texture_wrap import REPEAT, Wrap, within
from lutcore.arrays import AnyArray, FloatArray
from lutcore.errors import MeshError
from lutcore.mesh import TriangleMesh

Pixels = NDArray[np.uint8]
_MOST_PIXELS = 1 << 26  # 8192 x 8192
_PLAIN = 4  # pixels of what has a colour and no picture
_MOST_SIDE = 8192  # what every graphics card can hold
# Repeats beyond which single precision no longer tells pixels apart.
_FAR = 1e4
_NOT_USED = "the texture is not used"


@dataclass(frozen=True, eq=False)
class Texture:
    """A picture of albedo, and where on it the corners of each triangle lie.

    Parameters
    ----------
    image : ndarray of uint8, shape=(height, width, 3)
        sRGB, the first row at the top.
    uv : ndarray of float32, shape=(m, 3, 2)
        Of each triangle's corners: (0, 0) is the picture's lower left, (1, 1) its upper right.
    faces : ndarray of int, shape=(m, 3)
        The mesh's triangles.
    wrap : tuple of 2 str
        How the picture goes on beyond, across and up; see `app.loading.texture_wrap`.
    """

    image: Pixels
    uv: NDArray[np.float32]
    faces: AnyArray
    wrap: tuple[Wrap, Wrap] = (REPEAT, REPEAT)

    @cached_property
    def seams(self) -> "Seams":
        """The vertices as they are drawn: one that lies on a seam is there several times."""
        corners = np.ascontiguousarray(self.uv.reshape(-1, 2)).view(np.int64).reshape(-1)
        order = np.lexsort((corners, self.faces.reshape(-1)))
        vertex, place = self.faces.reshape(-1)[order], corners[order]
        fresh = np.ones(len(order), dtype=bool)
        fresh[1:] = (vertex[1:] != vertex[:-1]) | (place[1:] != place[:-1])
        number = np.empty(len(order), dtype=np.int64)
        number[order] = np.cumsum(fresh) - 1
        return Seams(
            vertex[fresh], self.uv.reshape(-1, 2)[order[fresh]], number.reshape(self.faces.shape)
        )

    @cached_property
    def at_vertices(self) -> FloatArray:
        """Linear albedo at the mesh's vertices, for what is computed there; white if unused.

        A vertex on a seam has the mean of its places.
        """
        from lutcore.color import srgb_decode

        seams = self.seams
        height, width = self.image.shape[:2]
        u, v = seams.uv.astype(np.float64).T
        column = within(np.floor(u * width).astype(np.int64), width, self.wrap[0])
        row = within(np.floor((1.0 - v) * height).astype(np.int64), height, self.wrap[1])
        linear = srgb_decode(self.image[row, column] / 255.0)
        count = int(self.faces.max()) + 1
        times = np.bincount(seams.vertices, minlength=count)
        sums = [np.bincount(seams.vertices, linear[:, c], minlength=count) for c in range(3)]
        found = np.stack(sums, axis=1) / np.maximum(times, 1)[:, None]
        return np.where(times[:, None] == 0, 1.0, found)

    def albedo(self, count: int) -> FloatArray:
        """Return the linear albedo at each vertex.

        Parameters
        ----------
        count : int
            Vertices of the mesh, those included that no triangle uses.

        Returns
        -------
        ndarray, shape=(count, 3)
            0 to 1.
        """
        found = np.ones((count, 3))
        found[: len(self.at_vertices)] = self.at_vertices
        return found


@dataclass(frozen=True, eq=False)
class Seams:
    """A mesh split where its texture is cut; for drawing only.

    Parameters
    ----------
    vertices : ndarray of int, shape=(s,)
        Which of the mesh's vertices each is.
    uv : ndarray of float32, shape=(s, 2)
        Where on the texture.
    faces : ndarray of int, shape=(m, 3)
        The mesh's triangles over these.
    """

    vertices: AnyArray
    uv: NDArray[np.float32]
    faces: AnyArray


def textured(surface: RawSurface, mesh: TriangleMesh) -> Texture | None:
    """Return the texture of a mesh; one that is broken costs the texture, never the mesh.

    Parameters
    ----------
    surface : RawSurface
        As read. Its list of warnings grows by what is wrong.
    mesh : TriangleMesh
        Made of it by `app.loading.checks.checked`.

    Returns
    -------
    Texture or None
        None if the file has none, or none that can be used.
    """
    raw = surface.texture
    if raw is None:
        return None
    images = [_decoded(picture, surface.warnings) for picture in raw.images]
    if all(image is None for image in images):
        return None
    found = _triangles(surface, mesh)
    if found is None:
        surface.warnings.append(f"its places do not follow the faces: {_NOT_USED}")
        return None
    uv, which = _places(raw, surface, found)
    made = joined(images, uv, which, [picture.wrap for picture in raw.images])
    if made is None:
        surface.warnings.append(
            f"several textures of which one goes on beyond its edge within a face: {_NOT_USED}; "
            "join them to one"
        )
        return None
    image, uv, wrap = made
    return Texture(image, np.ascontiguousarray(uv, dtype=np.float32), mesh.faces, wrap)


def _triangles(surface: RawSurface, mesh: TriangleMesh) -> AnyArray | None:
    """Return the corner of the file that each corner of each triangle is."""
    if (
        len(surface.corners) == mesh.faces.size
        and (surface.corners == mesh.faces.reshape(-1)).all()
    ):
        return np.arange(mesh.faces.size).reshape(-1, 3)
    count = len(surface.corners)
    split = RawSurface(surface.vertices[surface.corners], np.arange(count), surface.counts)
    try:
        corners = checked(split)[0].faces
    except (BadContentError, MeshError):
        return None
    return corners if np.array_equal(surface.corners[corners], mesh.faces) else None


def _places(raw: RawTexture, surface: RawSurface, corners: AnyArray) -> tuple[FloatArray, AnyArray]:
    uv = raw.corners[corners]
    which = raw.which[np.repeat(np.arange(len(surface.counts)), surface.counts)[corners[:, 0]]]
    # A comparison with NaN is false.
    placed = np.asarray((np.abs(uv) < _FAR).all(axis=(1, 2)))
    return np.where(placed[:, None, None], uv, 0.0), np.where(placed, which, -1)


def _decoded(picture: RawPicture, warnings: list[str]) -> Pixels | None:
    name = picture.name
    if picture.content is None:
        return _tinted(np.full((_PLAIN, _PLAIN, 3), 255, dtype=np.uint8), picture.tint)
    from PIL import Image

    try:
        with Image.open(io.BytesIO(picture.content)) as image:
            width, height = image.size
            if width * height > _MOST_PIXELS:
                warnings.append(f"{name} has {width} x {height} pixels, too many: {_NOT_USED}")
                return None
            rgb = image.convert("RGB")
            if max(rgb.size) > _MOST_SIDE:
                rgb.thumbnail((_MOST_SIDE, _MOST_SIDE))
                warnings.append(f"{name} is drawn with {rgb.width} x {rgb.height} pixels")
            return _tinted(np.array(rgb), picture.tint)
    # Decoders of damaged pictures raise whatever comes up in them.
    except Exception as error:
        warnings.append(f"{name} cannot be read as a picture ({error!s:.80}): {_NOT_USED}")
        return None


def _tinted(image: Pixels, tint: tuple[float, float, float]) -> Pixels:
    """Multiply linear colours, all 256 of each channel at once."""
    if tint == (1.0, 1.0, 1.0):
        return image
    from lutcore.color import srgb_decode, srgb_encode

    linear = srgb_decode(np.arange(256.0)[:, None] / 255.0) * np.array(tint)
    shown = np.rint(255.0 * srgb_encode(linear)).astype(np.uint8)
    return np.stack([shown[image[..., c], c] for c in range(3)], axis=-1)
