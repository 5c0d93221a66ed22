"""Open islands of a few vertices: specks of a scan, whose curvature nothing can vouch for."""

import numpy as np

from lutcore.arrays import FloatArray, IndexArray
from lutcore.compiled import compiled

# An open island of fewer vertices is a speck: most of them lie on its rim.
_FEW = 48


@compiled()
def specks(start: IndexArray, neighbour: IndexArray, rim: IndexArray) -> IndexArray:
    """Return the vertices of all specks.

    Parameters
    ----------
    start, neighbour : ndarray of int32
        Neighbours of each vertex.
    rim : ndarray of int32
        The vertices on or near a rim; every open island has some.

    Returns
    -------
    ndarray of int32
        Each once.
    """
    done, large = np.zeros(len(start) - 1, np.bool_), np.zeros(len(start) - 1, np.bool_)
    found = np.empty(len(start) - 1, np.int32)
    count = 0
    for seed in rim:
        if done[seed]:
            continue
        # Grown in place behind those found, until it ends, is too large or meets what is.
        last = count + 1
        found[count] = seed
        done[seed] = True
        at, few = count, True
        while at < last and few:
            for slot in range(start[found[at]], start[found[at] + 1]):
                other = neighbour[slot]
                few = few and not large[other]
                if few and not done[other]:
                    done[other] = True
                    found[last] = other
                    last += 1
                    few = last - count < _FEW
            at += 1
        if few:
            count = last
        else:
            for at in range(count, last):
                large[found[at]] = True
    return found[:count]


@compiled()
def doubt(speck: IndexArray, typical: float, tensors: FloatArray, square: FloatArray) -> None:
    """Take the curvature of specks for no more than they can vouch for, in place.

    A value read off so few vertices is no more certain than it is large. Between it and the rest of
    the mesh, whose curvature is of some typical size, the best guess weighs both by their squared
    uncertainties.

    Parameters
    ----------
    speck : ndarray of int32
        Their vertices.
    typical : float
        Typical square of the curvature elsewhere, 1/mesh unit squared.
    tensors : ndarray, shape=(n, 3)
        Entries xx, xy, yy; rewritten.
    square : ndarray, shape=(n,)
        Squared error bars; rewritten.
    """
    for i in speck:
        xx, xy, yy = tensors[i, 0], tensors[i, 1], tensors[i, 2]
        uncertain = square[i] + 0.5 * (xx * xx + yy * yy) + xy * xy
        share = typical / (typical + uncertain)
        for entry in range(3):
            tensors[i, entry] *= share
        square[i] = share * uncertain
