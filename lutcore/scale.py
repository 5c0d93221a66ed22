"""The scale at which the noise and the bias of curvature are least together."""

import numpy as np

from lutcore.arrays import BoolArray, FloatArray, IndexArray
from lutcore.compiled import compiled
from lutcore.cosmoothing import Smoothed, Surface, smooth
from lutcore.geometry import typical_spacing
from lutcore.laplacian import Laplacian
from lutcore.mesh import TriangleMesh
from lutcore.noise import extrapolated_noise, vertex_noise
from lutcore.progress import Progress, silent
from lutcore.selection import extrapolated
from lutcore.weld import weld

# Rungs of the ladder, in spacings: from hardly more than the star to the longest that is fast.
_RUNGS = 2.0 ** (0.5 * np.arange(1.0, 9.0))
# A scale is left for another only if that is expected to be this much better. The one kept
# without evidence averages some hundred vertices.
_EVIDENCE, _USUAL = 1.5, 2.0**2.5
# Spacings below which shading shows the noise of a laser scan.
_SHADING = 3.0
# Vertices that decide on large meshes, in patches wide against the longest scale.
_PATCH, _PATCHES, _SEEDS = 12_000, 3, 97
_LEAST_STAR = 3
_COUNTED = 0.99
# No scale that shading chooses by itself is longer than this share of the mesh: where light
# reaches farther than that, no local model holds, and the warning says so.
_LONGEST = 0.05


def shading_scale(mesh: TriangleMesh, glow: float) -> float:
    """Return the scale of curvature and normals that shading needs.

    Light does not see detail finer than the glow is wide, and a scan holds none finer than a few
    of its spacings: below that normals bring back the scanner's noise.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.
    glow : float
        l_u psi(0) of the channel that it carries farthest, mesh units.

    Returns
    -------
    float
        The larger of the two lengths, mesh units, the glow counting up to a twentieth of the
        mesh's diagonal; just `glow` if no face has an area.
    """
    welded = weld(mesh).mesh
    if welded is None:
        return glow
    return max(min(glow, _LONGEST * welded.diagonal), _SHADING * typical_spacing(welded))


def best_scale(on: Surface, progress: Progress = silent) -> float:
    """Return the scale that makes noise^2 + bias^2 of k least, over nearly all vertices.

    The change of k from one scale to the next holds both: the noise of the finer, of whatever
    kind, and the bias of the coarser. Large meshes are judged by three patches.

    Parameters
    ----------
    on : Surface
        The mesh.
    progress : callable
        Told where the work stands.

    Returns
    -------
    float
        One of a ladder of scales that grow by sqrt(2), mesh units.
    """
    part, inner = _sample(on)
    scales = on.spacing * _RUNGS
    smoothed = smooth(part, scales.tolist(), base=2, progress=progress)
    errors = np.sqrt(_costs(part, smoothed, inner))
    good = np.flatnonzero(errors <= _EVIDENCE * errors.min())
    rungs = _RUNGS[1:-1]
    nearest = good[np.argmin(np.abs(np.log(rungs[good] / _USUAL)))]
    return float(on.spacing * rungs[nearest])


def _costs(part: Surface, smoothed: Smoothed, inner: BoolArray) -> FloatArray:
    """Return noise^2 + bias^2 of the extrapolated k at every scale but the first and last."""
    sigma = vertex_noise(
        part.operator.start,
        part.operator.neighbour,
        part.fields[:, :3],
        smoothed.normals,
        smoothed.tensors[:, 3].copy(),
        inner,
    )
    rungs = len(smoothed.scales) - 2
    costs = np.empty(rungs - 1)
    finer = extrapolated(smoothed, 1)
    for rung in range(1, rungs):
        coarser = extrapolated(smoothed, rung + 1)
        apart = (coarser - finer)[inner]
        square = 0.5 * (apart[:, 0] ** 2 + apart[:, 2] ** 2) + apart[:, 1] ** 2
        noise = extrapolated_noise(sigma, part.spacing, smoothed.scales[rung + 1])
        # Nearly all vertices count, so that sharp parts pull the scale down; the last hundredth
        # are edges that no scale fits.
        most = np.sort(square)[: max(1, int(_COUNTED * len(square)))]
        costs[rung - 1] = float(most.mean()) + noise**2
        finer = coarser
    return costs


def _sample(on: Surface) -> tuple[Surface, BoolArray]:
    """Return patches of a large mesh, or all of a small one, and which vertices to judge by."""
    count = len(on.fields)
    if count <= _PATCH * _PATCHES:
        return on, np.ones(count, np.bool_)
    # Seeds in an order that spreads them: multiples of a number prime to their count.
    seeds = (np.arange(_SEEDS) * 36 % _SEEDS * count // _SEEDS).astype(np.int32)
    operator = on.operator
    order, inner = _grow(operator.start, operator.neighbour, seeds, _PATCH, _PATCHES)
    number = np.full(count, -1, np.int32)
    number[order] = np.arange(len(order), dtype=np.int32)
    owner = np.repeat(np.arange(len(order)), np.diff(operator.start)[order])
    first = np.concatenate(([0], np.cumsum(np.diff(operator.start)[order])))
    slots = np.arange(len(owner)) - first[owner] + operator.start[order][owner]
    inside = number[operator.neighbour[slots]] >= 0
    start = np.concatenate(([0], np.cumsum(inside)))[first].astype(np.int32)
    slots = slots[inside]
    links = Laplacian(
        start, number[operator.neighbour[slots]], operator.rate[slots], operator.bound
    )
    # A patch that is a whole island, cut where another began, may leave stars that tell nothing.
    return Surface(on.fields[order], links, on.spacing), inner & (np.diff(start) >= _LEAST_STAR)


@compiled()
def _grow(
    start: IndexArray, neighbour: IndexArray, seeds: IndexArray, size: int, patches: int
) -> tuple[IndexArray, BoolArray]:
    """Return the vertices of patches grown ring by ring, and which are far from the rim."""
    seen = np.zeros(len(start) - 1, np.bool_)
    order = np.empty(size * patches, np.int32)
    inner = np.zeros(size * patches, np.bool_)
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
        # A disc of 12,000 vertices is 62 spacings wide: its inner third ends 26 from its rim.
        inner[first : first + max(1, (filled - first) // 3)] = True
    return order[:filled], inner[:filled]
