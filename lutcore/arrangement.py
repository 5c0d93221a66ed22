"""Vertices in an order that keeps neighbours close in memory.

Loops over neighbours in random order wait for memory: they take some three times as long.
"""

import numpy as np
from numpy.typing import NDArray

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.mesh import TriangleMesh
from lutcore.weld import Welded

# Neighbours closer than this in the order share a core's second-level cache.
_CLOSE = 15_000
_LOOKED_AT = 10_000
_BITS = 20


def arranged(welded: Welded) -> Welded:
    """Return a mesh with its vertices and faces along a space-filling curve, if it needs that.

    Parameters
    ----------
    welded : Welded
        Any mesh made ready.

    Returns
    -------
    Welded
        The same where neighbours are close already; else arranged, with the way back.
    """
    mesh = welded.mesh
    if mesh is None or _close(mesh.faces):
        return welded
    extent = float(np.ptp(mesh.vertices, axis=0).max())  # positive: some face has an area
    # The code and the vertex in one number: sorting numbers is far faster than sorting by them.
    behind = len(mesh.vertices).bit_length()
    bits = min(_BITS, (64 - behind) // 3)
    keys = _keys(mesh.vertices, 2.0**bits / extent, 2**bits - 1, behind)
    keys.sort()
    order = (keys & np.uint64(2**behind - 1)).astype(np.int32)
    number = np.empty_like(order)
    number[order] = np.arange(len(order), dtype=np.int32)
    faces = number[mesh.faces]
    least = np.minimum(np.minimum(faces[:, 0], faces[:, 1]), faces[:, 2])
    places = least.astype(np.uint64) << np.uint64(32)
    places |= np.arange(len(faces), dtype=np.uint64)
    places.sort()
    faces = faces[(places & np.uint64(0xFFFFFFFF)).astype(np.int64)]
    index = np.where(welded.index < 0, np.int32(-1), number[welded.index]).astype(np.int32)
    return Welded(TriangleMesh.trusted(mesh.vertices[order], faces), index, True)


def _close(faces: IndexArray) -> bool:
    """Tell whether most faces have their vertices, and their next face, close by."""
    some = faces[: -1 : 1 + len(faces) // _LOOKED_AT].astype(np.int64)
    after = faces[1 :: 1 + len(faces) // _LOOKED_AT].astype(np.int64)[: len(some)]
    if len(some) == 0:
        return True
    within = np.ptp(some, axis=1)
    apart = np.abs(after[:, 0] - some[:, 0])
    return bool(max(np.median(within), np.median(apart)) <= _CLOSE)


@compiled()
def _keys(points: FloatArray, fineness: float, largest: int, behind: int) -> NDArray[np.uint64]:
    """Return the Morton code of each point, the bits of its coordinates interleaved.

    The lowest `behind` bits hold the point's number.
    """
    low = np.array([points[:, axis].min() for axis in range(3)])
    keys = np.empty(len(points), np.uint64)
    for i in range(len(points)):
        key = np.uint64(0)
        for axis in range(3):
            cell = np.uint64(min((points[i, axis] - low[axis]) * fineness, largest))
            # Spread 21 bits to every third: the usual masks of bit interleaving.
            cell = (cell | (cell << np.uint64(32))) & np.uint64(0x1F00000000FFFF)
            cell = (cell | (cell << np.uint64(16))) & np.uint64(0x1F0000FF0000FF)
            cell = (cell | (cell << np.uint64(8))) & np.uint64(0x100F00F00F00F00F)
            cell = (cell | (cell << np.uint64(4))) & np.uint64(0x10C30C30C30C30C3)
            cell = (cell | (cell << np.uint64(2))) & np.uint64(0x1249249249249249)
            key |= cell << np.uint64(axis)
        keys[i] = (key << np.uint64(behind)) | np.uint64(i)
    return keys
