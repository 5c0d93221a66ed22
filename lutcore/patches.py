"""Patches of a large mesh on which choices for the whole can be tried."""

import numpy as np

from lutcore.arrays import BoolArray, IndexArray
from lutcore.compiled import compiled
from lutcore.cosmoothing import Surface
from lutcore.laplacian import Laplacian

# Wide against the longest scale that is tried on them, and little work against the whole mesh.
_LEAST_PATCH, _LARGEST_PATCH, _PATCHES, _SEEDS = 3_000, 8_000, 3, 97
_LEAST_STAR = 3


def patches(on: Surface) -> tuple[Surface, BoolArray]:
    """Return three discs of a mesh, far apart in its order, as one mesh.

    Parameters
    ----------
    on : Surface
        A mesh of more vertices than the discs have together, 9,000.

    Returns
    -------
    Surface
        The discs.
    ndarray of bool
        Which of their vertices are far from where they were cut.
    """
    count = len(on.fields)
    # Seeds in an order that spreads them: multiples of a number prime to their count.
    seeds = (np.arange(_SEEDS) * 36 % _SEEDS * count // _SEEDS).astype(np.int32)
    operator = on.operator
    size = min(max(count // 25, _LEAST_PATCH), _LARGEST_PATCH)
    order, inner, parts = _grow(operator.start, operator.neighbour, seeds, size, _PATCHES)
    number = np.full(count, -1, np.int32)
    number[order] = np.arange(len(order), dtype=np.int32)
    owner = np.repeat(np.arange(len(order)), np.diff(operator.start)[order])
    first = np.concatenate(([0], np.cumsum(np.diff(operator.start)[order])))
    slots = np.arange(len(owner)) - first[owner] + operator.start[order][owner]
    # Where two discs met, they are cut apart.
    disc = np.repeat(np.arange(len(parts) - 1), np.diff(parts))
    other = number[operator.neighbour[slots]]
    inside = (other >= 0) & (disc[other] == disc[owner])
    start = np.concatenate(([0], np.cumsum(inside)))[first].astype(np.int32)
    links = Laplacian(
        start,
        other[inside],
        operator.rate[slots[inside]],
        operator.bound,
        operator.rim[order] | (np.diff(start) < np.diff(operator.start)[order]),
        parts,
    )
    # A patch that is a whole island, cut where another began, may leave stars that tell nothing.
    fields = on.points[order], on.fields[order], on.areas[order]
    return Surface(*fields, links, on.spacing), inner & (np.diff(start) >= _LEAST_STAR)


@compiled()
def _grow(
    start: IndexArray, neighbour: IndexArray, seeds: IndexArray, size: int, patches: int
) -> tuple[IndexArray, BoolArray, IndexArray]:
    """Return the vertices of patches grown ring by ring, which are far from the rim, and parts."""
    seen = np.zeros(len(start) - 1, np.bool_)
    order = np.empty(size * patches, np.int32)
    inner = np.zeros(size * patches, np.bool_)
    parts = [np.int32(0)]
    filled = 0
    for seed in seeds:
        if seen[seed] or filled == len(order):
            continue
        first, limit = filled, min(filled + size, len(order))
        order[filled] = seed
        seen[seed] = True
        filled += 1
        at = first
        while at < filled:
            for slot in range(start[order[at]], start[order[at] + 1]):
                other = neighbour[slot]
                if not seen[other] and filled < limit:
                    seen[other] = True
                    order[filled] = other
                    filled += 1
            at += 1
        # A disc of 3,000 vertices has a radius of 31 spacings; its inner quarter ends 15 inside.
        inner[first : first + max(1, (filled - first) // 4)] = True
        parts.append(np.int32(filled))
    return order[:filled], inner[:filled], np.array(parts)
