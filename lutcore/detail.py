"""A surface as light sees it that spreads below it: without the bumps that it blurs.

Each channel has its own normals and curvature, filtered by its own diffusion profile, all from one
recurrence. The filters are those of `lutcore.response`. What has no channels gets its normals from
the same recurrence.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import prange

from lutcore.arrangement import arranged
from lutcore.arrays import FloatArray, SingleArray, finite
from lutcore.baking import bake, glowing, resolved
from lutcore.borrowing import borrow
from lutcore.compiled import compiled
from lutcore.cosmoothing import Surface, fit_shape_operators, smoothed_normals, surface
from lutcore.diffusion import DiffusionProfile, Optics, diffusion_profile, optics
from lutcore.errors import ParameterError
from lutcore.estimation import sized_to_one
from lutcore.lowpass import filtered, series_at, series_of
from lutcore.materials import Material
from lutcore.mesh import TriangleMesh
from lutcore.progress import Progress, part, silent, tell
from lutcore.response import response
from lutcore.scale import scale_between
from lutcore.tensors import in_space
from lutcore.weld import weld

# Light that spreads farther than this share of the mesh, root mean square along an axis, is taken
# to spread so far: no local model holds there, and the work grows with it.
_WIDEST = 0.1
# How far a filter may be off. Normals and positions go through the same one, so that what is off
# is hardly more than the filter's length.
_TOLERANCE = 3e-3
# A star that smoothing has closed to less than this share of its extent tells nothing more.
_CLOSED = 0.05


@dataclass(frozen=True, eq=False)
class Detail:
    """What the light of each channel sees of a surface.

    Parameters
    ----------
    normals : ndarray, shape=(3, n, 3)
        Outward unit normals by channel; zero where a vertex has no face.
    shape : ndarray, shape=(3, n, 6)
        Convex part S+ of the shape operator by channel, 1/mm, as `ShadingInputs.shape`.
    variance : ndarray, shape=(3, n)
        That of the normals within what light sees, 1 - |mean|^2, by channel.
    bare : ndarray, shape=(n, 3)
        Outward unit normals with all detail, means over the faces around each vertex by area, for
        models that blur it themselves: those that are not local.
    widths : ndarray, shape=(3,)
        Root mean square distance along an axis that light spreads, mesh units: detail finer than
        this fades.
    scale : float
        One scale for what has no channels, mesh units; see `lutcore.scale.shading_scale`.
    smooth : ndarray, shape=(n, 3)
        Outward unit normals at that scale, to the last bit those that `auto` gives with its
        curvature; zero where a vertex has no face.
    """

    normals: FloatArray
    shape: FloatArray
    variance: FloatArray
    bare: FloatArray
    widths: FloatArray
    scale: float
    smooth: FloatArray

    @cached_property
    def faced(self) -> bool:
        """Whether any vertex has a face."""
        return bool(self.smooth.any())


def detail_seen(
    mesh: TriangleMesh,
    material: Material | str,
    mm_per_unit: float = 1.0,
    *,
    profile: DiffusionProfile | str = "jensen2001",
    progress: Progress = silent,
) -> Detail:
    """Return a mesh as the light of a material sees it, to be given to `shade`.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface, n vertices.
    material : Material or str
        A material, or the name of a built-in one.
    mm_per_unit : float
        Millimetres in one mesh unit, above 0.
    profile : DiffusionProfile or str
        How light spreads under a flat surface: a diffusion profile, or the name of one.
    progress : callable
        Told where the work stands; see `lutcore.progress`.

    Returns
    -------
    Detail
        Normals and curvature by channel, for that material, profile and size alone.

    Raises
    ------
    ParameterError
        If a name is unknown or a value out of range.
    CancelledError
        If `progress` asked to stop.
    """
    size = float(finite("mm_per_unit", mm_per_unit, ()))
    if size <= 0.0:
        raise ParameterError(f"mm_per_unit = {mm_per_unit!r} must be above 0")
    substance, spreading = resolved(material), diffusion_profile(profile)
    tell(progress, 0.0, "joining vertices")
    welded = arranged(weld(mesh))
    lengths = substance.mean_free_path / size
    constants = [glowing(channel) for channel in optics(substance)]
    widths = lengths * [np.sqrt(0.5 * spreading.mean_square(channel)) for channel in constants]
    count = len(mesh.vertices)
    glow = bake(substance, profile=spreading).glow / size
    if welded.mesh is None:
        none, flat = np.zeros((3, count, 3)), np.zeros((3, count, 6))
        return Detail(none, flat, none[..., 0], none[0], widths, glow, none[0])
    extent = welded.mesh.diagonal
    shares = np.minimum(1.0, _WIDEST * extent / widths)
    sized, unit = sized_to_one(welded.mesh)
    on = surface(sized, part(progress, 0.0, 0.3))
    filters = [
        series_of(passing, on.operator.bound, _TOLERANCE)
        for channel, length in zip(constants, shares * lengths / unit, strict=True)
        for passing in _passing(spreading, channel, length)
    ]
    scale = scale_between(glow, extent, on.spacing * unit)
    filters.append(series_at(scale / unit, on.operator.bound))
    change = filtered(on.operator, on.fields, filters, part(progress, 0.3, 0.9))
    # S+ of a channel goes where its smoothed fields were, which are as large and done with then:
    # memory that is touched first costs most here.
    convex = change[:6].reshape(-1).view(np.float64).reshape(3, -1, 6)
    normals, variance = np.empty((3, count, 3)), np.empty((3, count))
    room = _Room.of(len(on.points))
    for channel in range(3):
        tell(progress, 0.9 + channel / 30.0, "fitting shape operators")
        facing = room.normals if welded.moved else normals[channel]
        _geometry(on, change[2 * channel : 2 * channel + 2], facing, room)
        if welded.moved:
            normals[channel] = welded.spread(facing, 0.0)
        _variance(on.fields, change, 2 * channel, room.error)
        variance[channel] = welded.spread(room.error, 0.0)
        _convex_part(facing, room.tensors, 1.0 / (unit * size), convex[channel])
    shape = convex
    if welded.moved:
        shape = np.stack([welded.spread(one, 0.0) for one in convex])
    bare = np.ascontiguousarray(welded.spread(on.fields[:, 3:], 0.0))
    smooth = welded.spread(smoothed_normals(on.fields, change, len(filters) - 1), 0.0)
    return Detail(normals, shape, variance, bare, shares * widths, scale, smooth)


def _passing(
    profile: DiffusionProfile, channel: Optics, length: float
) -> list[Callable[[FloatArray], FloatArray]]:
    """Return the responses of normals and curvature to eigenvalues q^2, for l_u of a length."""
    known = response(profile, channel)

    def of(values: FloatArray) -> Callable[[FloatArray], FloatArray]:
        return lambda square: np.interp(length * np.sqrt(square), known.wavenumber, values)

    return [of(known.normals), of(known.curvature)]


@dataclass(frozen=True)
class _Room:
    """Arrays that all channels are worked out in, one after the other."""

    normals: FloatArray
    fitted: SingleArray
    stretch: SingleArray
    tensors: FloatArray
    error: FloatArray

    @classmethod
    def of(cls, count: int) -> "_Room":
        return cls(
            np.empty((count, 3)),
            np.empty((count, 1, 3), np.float32),
            np.empty((count, 1), np.float32),
            np.empty((count, 3)),
            np.empty(count),
        )


def _geometry(on: Surface, change: SingleArray, normals: FloatArray, room: _Room) -> None:
    """Write the normals after the first change, and the shape operators after the second."""
    links = (on.operator.start, on.operator.neighbour)
    given = (*on.operator.links, on.fields, change, 0, on.spacing, 2)
    fit_shape_operators(*given, normals, room.fitted, room.stretch)
    room.tensors[:] = room.fitted[:, 0]
    # Half a star, or one that has closed, tells less than its neighbours.
    weak = np.flatnonzero(on.operator.rim | (room.stretch[:, 0] < _CLOSED)).astype(np.int32)
    told = np.ones(len(weak), np.bool_)
    room.error[:] = 1.0
    borrow(*links, normals, weak, told, room.tensors, room.error, np.ones(len(weak)))


@compiled(parallel=True)
def _variance(fields: FloatArray, change: SingleArray, base: int, out: FloatArray) -> None:
    """Write what the squares of the lengths of the normals' means lack of 1."""
    for i in prange(len(out)):
        square = 0.0
        for axis in range(3, 6):
            mean = fields[i, axis] + change[base, i, axis]
            square += mean * mean
        out[i] = max(1.0 - square, 0.0)


@compiled(parallel=True)
def _convex_part(
    normals: FloatArray, tensors: FloatArray, per_mm: float, shape: FloatArray
) -> None:
    """Write S+ from tensors in the `tangent_frame` of the normals."""
    for i in prange(len(normals)):
        xx, xy, yy = tensors[i, 0], tensors[i, 1], tensors[i, 2]
        half = 0.5 * (xx - yy)
        middle, radius = 0.5 * (xx + yy), np.sqrt(half * half + xy * xy)
        high, low = max(middle + radius, 0.0), max(middle - radius, 0.0)
        # S+ = low 1 + (high - low)/(2 radius) (S - (middle - radius) 1)
        turned = 0.5 * (high - low) / radius if radius > 0.0 else 0.0
        even = low - turned * (middle - radius)
        convex = (
            per_mm * (even + turned * xx),
            per_mm * (turned * xy),
            per_mm * (even + turned * yy),
        )
        sxx, sxy, sxz, syy, syz, szz = in_space(normals[i], convex)
        shape[i, 0], shape[i, 1], shape[i, 2] = sxx, syy, szz
        shape[i, 3], shape[i, 4], shape[i, 5] = sxy, syz, sxz
