"""The scales at which a mesh's curvature is worth asking for."""

import numpy as np

from lutcore.arrays import FloatArray
from lutcore.cosmoothing import Surface, smooth
from lutcore.geometry import typical_spacing
from lutcore.mesh import TriangleMesh
from lutcore.patches import patches
from lutcore.progress import Progress, silent
from lutcore.selection import scales_chosen
from lutcore.weld import weld

# From hardly more than the star to the longest that is worth its time, in spacings.
_RUNGS = 2.0 ** (0.5 * np.arange(9.0))
# Meshes of more vertices try the rungs on patches first.
_WHOLE = 30_000
# Vertices of the patches whose choice may fall outside the rungs that are kept.
_LEFT_OUT = (2.0, 93.0)
# A choice this close to a rung, in rungs, is that rung: the nearest.
_NEAR = 0.5
# No scale that `auto` tries is longer than this share of the mesh.
_WIDEST = 0.25
# Spacings below which no scale is resolved, and up to which noise has to be listened to.
_FINEST, _HEARD = 0.5, 2.0
# Spacings below which shading shows the noise of a laser scan.
_SHADING = 3.0
# No scale that shading chooses by itself is longer than this share of the mesh: where light
# reaches farther than that, no local model holds, and the warning says so.
_LONGEST = 0.05
# Of a mesh of few faces the spacing alone may ask for more than there is.
_WHOLE_MESH = 0.5


def shading_scale(mesh: TriangleMesh, glow: float) -> float:
    """Return one scale of curvature and normals for all that is shaded.

    It serves what has no channels: pictures of curvature, the light that leaves towards the eye,
    predictions. What each channel is shaded with is told by `lutcore.detail`. Light does not see
    detail finer than the glow is wide, and a scan holds none finer than a few of its spacings:
    below that normals bring back the scanner's noise.

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
        mesh's diagonal, and both up to a half; just `glow` if no face has an area.
    """
    welded = weld(mesh).mesh
    if welded is None:
        return glow
    return scale_between(glow, welded.diagonal, typical_spacing(welded))


def scale_between(glow: float, extent: float, spacing: float) -> float:
    """Return `shading_scale` of a mesh of which all that it depends on is known.

    Parameters
    ----------
    glow : float
        As for `shading_scale`.
    extent, spacing : float
        Diagonal and typical spacing of the mesh, mesh units.

    Returns
    -------
    float
        The scale, mesh units.
    """
    return min(max(min(glow, _LONGEST * extent), _SHADING * spacing), _WHOLE_MESH * extent)


def rungs(
    on: Surface,
    extent: float,
    precision: float,
    steadiness: float,
    progress: Progress = silent,
) -> FloatArray:
    """Return the scales among which each vertex of a mesh should choose.

    Parameters
    ----------
    on : Surface
        The mesh.
    extent : float
        Its diagonal, mesh units.
    precision, steadiness : float
        As in `select`.
    progress : callable
        Told where the work stands.

    Returns
    -------
    ndarray
        Scales that grow by sqrt(2), mesh units. On a large mesh those that patches of it chose,
        and one more at either end; on a small one all.
    """
    count = max(3, int(np.searchsorted(_RUNGS, _WIDEST * extent / on.spacing)))
    every: FloatArray = on.spacing * _RUNGS[:count]
    if len(on.fields) <= _WHOLE:
        return every
    part, inner = patches(on)
    if not inner.any():  # nothing but specks
        return every
    smoothed = smooth(part, every.tolist(), count // 2, progress)
    used = scales_chosen(part, smoothed, precision, steadiness)
    low, high = np.percentile(used[inner], _LEFT_OUT)
    # A scale is judged by the change to the next, so that one has to be there too.
    place = 2.0 * np.log2(np.maximum([low, high], every[0]) / every[0])
    first = int(place[0] + _NEAR) - 1
    last = max(3, min(count, int(np.ceil(place[1] - _NEAR)) + 2))
    return every[max(0, min(first, last - 3)) : last]


def rungs_for(lengths: FloatArray, spacing: float) -> FloatArray:
    """Return the scales that answer at given lengths.

    Parameters
    ----------
    lengths : ndarray
        Lengths wanted, mesh units; from `resolved`.
    spacing : float
        The mesh's.

    Returns
    -------
    ndarray
        Scales that grow by sqrt(2) or less, one below and one above all lengths, and on to two
        spacings: from less than that nothing tells noise from shape.
    """
    low, high = float(np.min(lengths)), float(np.max(lengths))
    steps = int(np.ceil(2.0 * np.log2(high / low) - 1e-9))
    scales = [low / 2.0**0.5, *np.geomspace(low, high, steps + 1), high * 2.0**0.5]
    while scales[-1] < _HEARD * spacing:
        scales.append(scales[-1] * 2.0**0.5)
    return np.array(scales)


def resolved(lengths: FloatArray | float, spacing: float) -> FloatArray:
    """Return lengths that a mesh can resolve.

    Parameters
    ----------
    lengths : float or ndarray
        Lengths wanted, mesh units.
    spacing : float
        The mesh's.

    Returns
    -------
    ndarray
        The same, but half a spacing where they are less: the star alone averages over that.
    """
    return np.maximum(lengths, _FINEST * spacing)
