"""Which connected parts of a mesh are the subject, and which are debris around it."""

import numpy as np

from lutcore.arrays import BoolArray
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
    if count == 1:  # of one piece and nothing beside: most meshes, and large ones
        return np.ones(len(labels), np.bool_)
    sizes = np.bincount(labels[mesh.faces[:, 0]], minlength=count)
    large: BoolArray = (sizes > 0) & (sizes >= _DEBRIS * sizes.max())
    return large[labels]
