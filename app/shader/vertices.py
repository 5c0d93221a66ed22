"""What the vertex shader gets of each vertex."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from app.shader.packing import Packing
from lutcore.arrays import FloatArray, SingleArray

if TYPE_CHECKING:
    from lutcore.lut import PsiTable


def second(table: "PsiTable", shapes: Sequence[FloatArray]) -> FloatArray:
    """Return E2 of `plugins.shading.curvature_lut` at each vertex.

    Parameters
    ----------
    table : PsiTable
        Of the material.
    shapes : sequence of ndarray, shape=(n, 6)
        S+ for each channel, or one for all.

    Returns
    -------
    ndarray, shape=(n, 3)
        By channel.
    """
    # Of 2 (k1^2 + k2^2) + (k1 + k2)^2, mm^2.
    area = table.mean_square * table.mean_free_path**2 / 16.0
    found = []
    for shape in shapes:
        plain, mixed = (np.einsum("ij,ij->i", one, one) for one in (shape[:, :3], shape[:, 3:]))
        found.append(2.0 * (plain + 2.0 * mixed) + shape[:, :3].sum(axis=1) ** 2)
    return area * np.stack(found, axis=1)


def forms(normals: FloatArray, shape: FloatArray) -> FloatArray:
    """Return S+ in a frame of the tangent plane that follows from the normal alone.

    Parameters
    ----------
    normals : ndarray, shape=(n, 3)
        Unit normals.
    shape : ndarray, shape=(n, 6)
        See `lutcore.shading.ShadingInputs`.

    Returns
    -------
    ndarray, shape=(n, 3)
        Entries tt, uu, tu for the tangents t, u of Duff et al., Building an Orthonormal Basis,
        Revisited, JCGT 2017, of the normal in single precision, as the shader has it.
    """
    x, y, z = normals.astype(np.float32).astype(np.float64).T
    # A z so small may be 0 in the shader: so it is in both.
    z = np.where(np.abs(z) < 1e-30, 0.0, z)
    sign = np.where(z >= 0.0, 1.0, -1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    t = np.stack([1.0 + sign * x * x * a, sign * b, -sign * x])
    u = np.stack([b, sign + y * y * a, -y])
    xx, yy, zz, xy, yz, xz = shape.T
    bent = [
        np.stack([xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z])
        for x, y, z in (t, u)
    ]
    of_t, of_u = bent
    return np.stack([(t * of_t).sum(0), (u * of_u).sum(0), (u * of_t).sum(0)], axis=1)


def rows(parts: Packing, vectors: Sequence[FloatArray]) -> dict[str, SingleArray]:
    """Return vectors as the shader gets them.

    Parameters
    ----------
    parts : Packing
        Where they lie.
    vectors : sequence of ndarray, shape=(n, 3)
        In its order.

    Returns
    -------
    dict of str to ndarray of float32, shape=(n, 4)
        By the names of the vectors of four.
    """
    packed = np.zeros((len(parts.names), len(vectors[0]), 4), np.float32)
    for index, vector in enumerate(vectors):
        for part in range(3):
            at = 3 * index + part
            packed[at // 4, :, at % 4] = vector[:, part]
    return dict(zip(parts.names, packed, strict=True))
