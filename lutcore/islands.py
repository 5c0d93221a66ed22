"""Which connected parts of a mesh are the subject, and which are debris around it."""

import numpy as np

from lutcore.arrays import BoolArray, IndexArray
from lutcore.compiled import compiled
from lutcore.mesh import TriangleMesh
from lutcore.topology import components

# An island this much smaller than the largest is debris of the scan, not part of the subject.
_DEBRIS = 0.01


def main_islands(mesh: TriangleMesh) -> BoolArray:
    """Return which vertices belong to the subject rather than to debris around it.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh; an unmerged triangle soup has no large island, so all of it counts.

    Returns
    -------
    ndarray of bool, shape=(n,)
        True for referenced vertices of every island that is not far smaller than the largest.
    """
    count, labels = components(mesh.faces, len(mesh.vertices))
    return _within(mesh.faces, labels, count)


@compiled()
def _within(faces: IndexArray, labels: IndexArray, count: int) -> BoolArray:
    """Return which things have a label that enough faces have."""
    sizes = np.zeros(count, np.int64)
    for face in range(len(faces)):
        sizes[labels[faces[face, 0]]] += 1
    least = max(_DEBRIS * sizes.max(), 1.0)
    within = np.empty(len(labels), np.bool_)
    for thing in range(len(labels)):
        within[thing] = sizes[labels[thing]] >= least
    return within
